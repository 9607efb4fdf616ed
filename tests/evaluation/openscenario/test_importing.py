"""Files of scenariogeneration, whole and badly edited: imported, or refused with the element's name."""

import random
import re
from typing import Final

import pytest

from simconsole.evaluation.openscenario.importing import imported
from simconsole.values.errors import ProfileError
from tests.evaluation.in_memory import drive_scenario
from tests.evaluation.openscenario.files import NAMED, NOT_UNDERSTOOD, UNDERSTOOD, all_files, mutated, written
from tests.samples import Sample


def refusal(content: bytes, partly: bool) -> str | None:
    """Return why a file is refused, None if it is imported; any other exception is one."""
    try:
        imported(content, "made.xosc", partly=partly)
    except ProfileError as error:
        return str(error)
    return None


IDLE: Final = ("nothing happens", *(name for name in UNDERSTOOD if name.startswith("a controller")))
"""Files in which Lead does nothing."""


@pytest.mark.parametrize("name", UNDERSTOOD)
def test_what_is_understood_is_imported_whole(name: str) -> None:
    found = imported(UNDERSTOOD[name](), "made.xosc")
    assert not [one for one in found.left if one.changes]
    assert found.profile.duration_s == 12.0
    assert [actor.name for actor in found.profile.actors] == ["Lead"]
    assert len(found.profile.actors[0].acts) == {"several events": 3}.get(name, int(name not in IDLE))
    assert found.profile.actors[0].kind == {"van": "van", "truck": "van", "pedestrian": "pedestrian"}.get(name, "car")


@pytest.mark.parametrize("name", NOT_UNDERSTOOD)
def test_what_is_not_understood_is_refused_by_its_name_and_line(name: str) -> None:
    element, make = NOT_UNDERSTOOD[name]
    with pytest.raises(ProfileError, match=rf"^made\.xosc: line \d+: <{element}>: ") as error:
        imported(make(), "made.xosc")
    assert "\n" not in str(error.value)
    found = imported(make(), "made.xosc", partly=True)
    assert element in [one.element for one in found.left if one.changes]


def test_mutations_are_imported_or_refused_with_the_element(sample: Sample) -> None:
    rng, files, refused = random.Random(sample.seed), all_files(), 0
    for number in range(sample.of(300, 3000)):
        content = mutated(files[number % len(files)], rng)
        for partly in (False, True):
            told = refusal(content, partly)
            refused += told is not None
            assert told is None or NAMED.match(told), told
            assert told is None or "\n" not in told
    assert refused > 20


def test_the_numbers_arrive() -> None:
    found = imported(UNDERSTOOD["speed by rate"](), "made.xosc")
    lead = found.profile.actors[0]
    assert (lead.x_m, lead.y_m, lead.speed_kmh) == pytest.approx((41.4, 0.0, 28.8))  # the box's middle is 1.4 m ahead
    assert (lead.length_m, lead.width_m, lead.height_m) == (4.5, 1.8, 1.5)
    act = lead.acts[0]
    assert (act.at_s, act.speed_kmh, act.accel_mps2) == (4.0, 0.0, 6.0)
    assert found.profile.remote[0].speed_mps == 10.0
    path = imported(UNDERSTOOD["trajectory"](), "made.xosc").profile.actors[0].acts[0].trajectory
    assert [vertex.time_s for vertex in path] == [0.0, 2.0, 4.0]
    assert path[1].x_m == pytest.approx(61.4)
    near = imported(UNDERSTOOD["a place"](), "made.xosc").profile.actors[0].acts[0]
    assert near.of == "Lead"
    assert near.near is not None
    assert near.near.radius_m == 4.0
    later = imported(UNDERSTOOD["a condition and a time"](), "made.xosc").profile.actors[0].acts[0]
    assert (later.above_mps, later.not_before_s) == (5.0, 3.0)


def test_a_parameter_stands_for_its_value() -> None:
    content = UNDERSTOOD["speed by time"]().replace(
        b'AbsoluteTargetSpeed value="0.0"', b'AbsoluteTargetSpeed value="$speed"'
    )
    assert content != UNDERSTOOD["speed by time"]()
    assert imported(content, "made.xosc").profile.actors[0].acts[0].speed_kmh == pytest.approx(21.6)


def test_it_drives_and_the_lead_brakes() -> None:
    found = imported(UNDERSTOOD["speed by rate"](), "made.xosc")
    recorder, columns = drive_scenario(found.profile)
    gap = recorder.vectors[:, columns.index("ahead.lead_gap_m")]
    speed = recorder.vectors[:, columns.index("ahead.lead_speed_mps")]
    assert speed[int(3.9 * 250)] == pytest.approx(8.0)
    assert speed[int(6.0 * 250)] == pytest.approx(0.0, abs=1e-9)
    assert gap[1000] > 20.0
    assert recorder.vectors[1500, columns.index("vehicle.vx_mps")] > 3.0


def test_the_consoles_vehicle_is_named_or_asked_for() -> None:
    content = written().replace(b"Ego", b"Mine")
    with pytest.raises(ProfileError, match="<Entities>: 0 entities called ego or hero"):
        imported(content, "made.xosc")
    assert [actor.name for actor in imported(content, "made.xosc", ego="Mine").profile.actors] == ["Lead"]


def without_a_place(content: bytes, *, beside: bytes = b"") -> bytes:
    """Return a file whose Lead is put nowhere, with another element that is not understood."""
    place = re.compile(
        rb'(<Private entityRef="Lead">\s*)<PrivateAction>\s*<TeleportAction>.*?</PrivateAction>', re.DOTALL
    )
    changed, times = place.subn(rb"\1", content)
    assert times == 1
    return changed.replace(b"<StopTrigger/>\n            </Act>", beside + b"<StopTrigger/>\n            </Act>")


def third(content: bytes, acts_by: bytes) -> bytes:
    """Return a file with one more car, to whom everything that Lead did happens by what `acts_by` does."""
    entity = re.search(rb'<ScenarioObject name="Lead">.*?</ScenarioObject>', content, re.DOTALL)
    begins = re.search(rb'<Private entityRef="Lead">.*?</Private>', content, re.DOTALL)
    assert entity
    assert begins
    for found in (entity, begins):
        content = content.replace(found[0], found[0] + found[0].replace(b'"Lead"', b'"Third"'))
    actors = b'<Actors selectTriggeringEntities="false">'
    head, tail = content.split(actors)
    tail = tail.replace(b'entityRef="Lead"', b'entityRef="Third"', 1)
    return head + actors + tail.replace(b'entityRef="Ego"', b'entityRef="' + acts_by + b'"')


def test_who_has_no_place_is_listed_and_left_out_with_what_names_it() -> None:
    whole = third(UNDERSTOOD["own speed"](), b"Lead")
    assert [(one.name, len(one.acts)) for one in imported(whole, "made.xosc").profile.actors] == [
        ("Lead", 0),
        ("Third", 1),
    ]
    content = without_a_place(whole, beside=b"<Elsewhere/>")
    with pytest.raises(ProfileError, match=r"<Elsewhere>: .*; line \d+: <ScenarioObject>: 'Lead': no place in <Init>"):
        imported(content, "made.xosc")
    found = imported(content, "made.xosc", partly=True)
    assert [(one.name, one.acts) for one in found.profile.actors] == [("Third", ())]
    told = [str(one) for one in found.left if one.element == "ScenarioObject"]
    assert len(told) == 1
    assert told[0].endswith(
        "'Lead': no place in <Init> that is understood: left out, and 1 act of others that names it"
    )
    assert drive_scenario(found.profile)[0].ticks == 12 * 250


def test_a_vehicle_without_a_place_is_listed_too() -> None:
    content = without_a_place(
        written().replace(b'"Ego"', b'"X"').replace(b'"Lead"', b'"Ego"').replace(b'"X"', b'"Lead"')
    )
    found = imported(content.replace(b"<RoadNetwork", b"<Elsewhere/><RoadNetwork"), "made.xosc", partly=True)
    assert [one.element for one in found.left if one.changes] == ["Elsewhere", "ScenarioObject"]


def test_a_parameter_that_is_not_declared_and_a_file_of_values_are_refused() -> None:
    with pytest.raises(ProfileError, match=r"^made.xosc: --parameter: value mass: one of speed$"):
        imported(written(), "made.xosc", parameters={"mass": "1"})
    values = b"<OpenSCENARIO><FileHeader/><ParameterValueDistribution/></OpenSCENARIO>"
    with pytest.raises(
        ProfileError, match=r"^values.xosc: line 1: <ParameterValueDistribution>: values for another file"
    ):
        imported(values, "values.xosc")
