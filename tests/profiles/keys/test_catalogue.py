"""The list of all keys."""

import msgspec

from simconsole.profiles.keys.catalogue import REQUIRED, Key, catalogue
from simconsole.profiles.keys.kinds import KINDS
from simconsole.profiles.session import SessionProfile
from tests.paths import ROOT


def key_at(path: str, where: tuple[str, ...] = ()) -> Key:
    """Return the one key at a path."""
    (found,) = [key for key in catalogue() if key.path == path and (not where or key.where == where)]
    return found


def test_a_key_knows_what_may_stand_there() -> None:
    key = key_at("session.mode.answer_timeout_s")
    assert (key.type, key.unit, key.bounds, key.default) == ("number", "s", "above 0 and 60 or less", "2.0")
    assert key_at("vehicle.steering.ratio").default == REQUIRED


def test_a_key_that_some_kinds_of_a_section_have_says_which() -> None:
    assert key_at("session.scenario.faults[].raw").where == ("stuck",)
    assert key_at("session.scenario.faults[].at_s").where == ()
    assert key_at("session.scenario.faults[].kind").bounds.startswith("one of unplug, freeze, ")
    assert {key.where for key in catalogue() if key.path == "session.scenario.faults[].seed"} == {
        ("noise",),
        ("burst",),
    }


def test_a_world_without_a_kind_is_a_course() -> None:
    assert key_at("world.kind").default == '"course"'


def test_every_default_of_a_session_is_that_of_its_struct() -> None:
    mode = msgspec.to_builtins(SessionProfile(schema=1).mode)
    assert {name: key_at(f"session.mode.{name}").default for name in mode} == {
        name: msgspec.json.encode(value).decode() for name, value in mode.items()
    }


def test_every_page_is_there() -> None:
    assert {key.page for key in catalogue() if not (ROOT / key.page).is_file()} == set()
    assert key_at("scenario.session.outputs.bridge.port").page == "docs/rosbridge.md"
    assert key_at("session.outputs.bridge.link.seed").page == "docs/tracking.md"


def test_no_kind_of_file_is_without_keys() -> None:
    assert {key.kind for key in catalogue()} == set(KINDS)
