"""Manoeuvres by their names, and what is refused."""

import itertools

import pytest

from simconsole.profiles.files.loader import parse
from simconsole.profiles.manoeuvre import CoastDown, DoubleLaneChange, SineWithDwell
from simconsole.profiles.scenario import ScenarioProfile
from tests.profiles.refused import refusal

HEAD = "schema: 1\ntitle: t\nduration_s: 1\nsession: {schema: 1}\nmanoeuvre: "


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("{kind: coast_down, to_kmh: 30}", CoastDown(to_kmh=30.0)),
        ("{kind: double_lane_change, course: iso_3888_1}", DoubleLaneChange(course="iso_3888_1")),
        ("{kind: sine_with_dwell}", SineWithDwell()),
    ],
)
def test_the_kind_decides_what_is_driven(text: str, meant: CoastDown | DoubleLaneChange | SineWithDwell) -> None:
    assert parse(HEAD + text, ScenarioProfile, "f.yaml").manoeuvre == meant


def test_the_sines_of_the_rule_go_from_one_and_a_half_to_six_and_a_half_times_a() -> None:
    factors = SineWithDwell().factors
    assert (factors[0], factors[-1]) == (1.5, 6.5)
    assert {later - earlier for earlier, later in itertools.pairwise(factors)} == {0.5}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{kind: slalom}", "slalom"),
        ("{kind: coast_down, from_kmh: 4}", "manoeuvre.from_kmh: value 4: "),
        ("{kind: straight_braking, brake: 0}", "manoeuvre.brake: value 0: "),
        ("{kind: step_steer, hold_s: 0.5}", "manoeuvre.hold_s: value 0.5: "),
        ("{kind: sine_with_dwell, factors: []}", "manoeuvre.factors: "),
        ("{kind: double_lane_change, course: iso_3888}", 'manoeuvre.course: value "iso_3888": one of '),
        ("{kind: observed, until_s: 0}", "manoeuvre.until_s: value 0: "),
        ("{kind: steady_state_circle, speed: 80}", "manoeuvre.speed: value 80: unknown key, did you mean speed_kmh"),
    ],
)
def test_what_cannot_be_meant_is_refused(text: str, told: str) -> None:
    assert told in refusal(HEAD + text, ScenarioProfile)
