"""A value that does not fit: one line with file, key, value and what is allowed."""

from collections.abc import Iterator
from enum import Enum
from typing import Annotated, Any, Literal

import msgspec
import msgspec.inspect
import pytest

from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.sweep import SweepProfile
from simconsole.profiles.validation import convert, worded
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.profiles.view import LanguageProfile
from simconsole.profiles.world import WorldProfile
from simconsole.values.errors import ProfileError
from simconsole.world.tools.ros_maps import RosMap


class Side(Enum):
    LEFT = "left"
    RIGHT = "right"


class Axis(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    dead_zone: Annotated[float, msgspec.Meta(ge=0, le=0.5)] = 0.0
    side: Side = Side.LEFT
    role: Literal["wheel", "brake"] = "wheel"
    index: Annotated[int, msgspec.Meta(ge=0)]

    def __post_init__(self) -> None:
        if self.index == 13:
            raise ValueError("13 is not an index")


class Cockpit(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    name: str
    axes: dict[str, Axis] = {}
    order: tuple[Axis, ...] = ()
    pair: tuple[int, float] = (0, 0.0)
    spare: Axis | None = None
    ratio: Annotated[float, msgspec.Meta(gt=0)] = 1.0


Code = Annotated[str, worded(r"^[a-z]{3}$", "three letters")]


class Coded(Cockpit, frozen=True, kw_only=True, forbid_unknown_fields=True):
    code: Code | None = None
    by_code: dict[Code, int] = {}
    codes: Code | tuple[Code, ...] = ()


PROFILES = (
    CockpitProfile,
    LanguageProfile,
    RosMap,
    ScenarioProfile,
    SessionProfile,
    SweepProfile,
    VehicleProfile,
    WorldProfile,
)
GOOD = {"name": "rig", "axes": {"wheel": {"index": 0, "dead_zone": 0}}, "spare": {"index": 2}}


def test_good_values_become_the_struct() -> None:
    cockpit = convert(GOOD, Cockpit, "f.yaml")
    assert cockpit.axes["wheel"].dead_zone == 0.0
    assert cockpit.spare == Axis(index=2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"axes": {"wheel": {"index": 0}, "brake": {"index": 1, "dead_zone": 2}}},
         "axes.brake.dead_zone: value 2: a number from 0 to 0.5"),
        ({"axes": {"wheel": {"index": -1}}}, "axes.wheel.index: value -1: a whole number, 0 or more"),
        ({"axes": {"wheel": {"index": True}}}, "axes.wheel.index: value true: a whole number, 0 or more"),
        ({"axes": {"wheel": {"index": 1.5}}}, "axes.wheel.index: value 1.5: a whole number, 0 or more"),
        ({"axes": {"wheel": {}}}, "axes.wheel.index: value missing: a whole number, 0 or more"),
        ({"axes": {"wheel": {"index": 13}}}, 'axes.wheel: value {"index":13}: 13 is not an index'),
        ({"axes": {"wheel": {"index": 1, "side": "up"}}}, 'axes.wheel.side: value "up": one of left, right'),
        ({"axes": {"wheel": {"index": 1, "role": "horn"}}}, 'axes.wheel.role: value "horn": one of brake, wheel'),
        ({"order": [{"index": 1}, {"index": 1, "dead_zone": "0.1"}]},
         'order[1].dead_zone: value "0.1": a number from 0 to 0.5'),
        ({"pair": [1, "x"]}, 'pair[1]: value "x": a number'),
        ({"spare": {"index": 1, "dead_zone": -0.1}}, "spare.dead_zone: value -0.1: a number from 0 to 0.5"),
        ({"spare": 3}, "spare: value 3: expected mapping | null, got int"),
        ({"ratio": 0}, "ratio: value 0: a number, above 0"),
        ({"name": None}, "name: value null: expected str, got null"),
        ({"code": "a b"}, 'code: value "a b": three letters or null'),
        ({"codes": ["abc", "abcd"]}, 'codes[1]: value "abcd": three letters'),
        ({"by_code": {"abc": 1, "b c": 2}}, 'by_code: key "b c": three letters'),
        ({"codes": "x"}, 'codes: value "x": three letters'),
        ({"axes": {"wheel": {"index": 1, "dead_zon": 0.1}}},
         "axes.wheel.dead_zon: value 0.1: unknown key, did you mean dead_zone?"),
        ({"colour": "red"},
         'colour: value "red": unknown key, one of name, axes, order, pair, spare, ratio, code, by_code, codes'),
        ({"colour\nname: x": 1},
         "colour name: x: value 1: unknown key, one of name, axes, order, pair, spare, ratio, code, by_code, codes"),
    ],
)  # fmt: skip
def test_message_names_key_value_and_what_is_allowed(change: dict[str, object], message: str) -> None:
    with pytest.raises(ProfileError) as caught:
        convert({**GOOD, **change}, Coded, "f.yaml")
    assert str(caught.value) == f"f.yaml: {message}"


@pytest.mark.parametrize("values", [None, 3, [1], "text"])
def test_document_that_is_no_mapping(values: object) -> None:
    with pytest.raises(ProfileError, match=r"^f\.yaml: file: value .*: expected mapping, got \w+$"):
        convert(values, Cockpit, "f.yaml")


def test_long_value_is_cut() -> None:
    with pytest.raises(ProfileError) as caught:
        convert({**GOOD, "ratio": "9" * 1000}, Cockpit, "f.yaml")
    assert len(str(caught.value)) < 120


def test_the_guilty_key_of_a_mapping_is_found_where_something_else_is_wrong_too() -> None:
    """Every entry alone fails here, for `name` is missing: the one that fails in the same words is meant."""
    with pytest.raises(ProfileError) as caught:
        convert({"axes": {"wheel": {"index": 0}, "brake": {"button": 0}}}, Cockpit, "rig.yaml")
    assert str(caught.value).startswith("rig.yaml: axes.brake.button: value 0: unknown key, one of ")


def test_a_cockpit_without_a_wheel_that_says_where_it_comes_from_is_one_line() -> None:
    good = {"status": "chosen", "source": "us"}
    values = {"schema": 1, "title": "rig", "provenance": {"buttons": good, "autonomous": {"button": 0}}}
    with pytest.raises(ProfileError, match=r"^rig\.yaml: provenance\.autonomous\.button: value 0: unknown key"):
        convert(values, CockpitProfile, "rig.yaml")


def patterns(kind: Any, said: bool, seen: set[type]) -> Iterator[str]:
    """The patterns of a type and of all that it holds that no words stand for."""
    if isinstance(kind, msgspec.inspect.StructType):
        if kind.cls in seen:
            return
        seen.add(kind.cls)
    if getattr(kind, "pattern", None) is not None and not said:
        yield kind.pattern
    inside = [getattr(kind, name, None) for name in ("type", "key_type", "value_type", "item_type")]
    inside += [*getattr(kind, "types", ()), *getattr(kind, "item_types", ())]
    inside += [field.type for field in getattr(kind, "fields", ())]
    for one in inside:
        if one is not None:
            yield from patterns(one, bool(getattr(kind, "extra", None)), seen)


@pytest.mark.parametrize("profile", PROFILES)
def test_no_message_shows_a_pattern(profile: Any) -> None:
    assert list(patterns(msgspec.inspect.type_info(profile), said=False, seen=set())) == []


def test_a_pattern_without_words_would_be_found() -> None:
    kind = msgspec.inspect.type_info(tuple[Annotated[str, msgspec.Meta(pattern="^a$")], ...])
    assert list(patterns(kind, said=False, seen=set())) == ["^a$"]
