"""Scenarios: the steps of a controller, and what is refused."""

import pytest

from simconsole.profiles.scenario import ScenarioProfile
from tests.profiles.refused import refusal

HEAD = "schema: 1\ntitle: t\nduration_s: 1\nsession: {schema: 1}\n"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("remote: [{start_s: 0, kind: speed}]", "remote[0].end_s: value missing: "),
        ("remote: [{start_s: 0, end_s: 1, kind: wish}]", 'remote[0].kind: value "wish": one of '),
        ("remote: [{start_s: 0, end_s: 1, kind: speed, period_ms: 0}]", "remote[0].period_ms: value 0: "),
        ("remote: [{start_s: 0, end_s: 1, kind: speed, direction: 2}]", "remote[0].direction: value 2: one of "),
        ("ecu: [{start_s: 0, end_s: 1, kind: speed, brake: 1.1}]", "ecu[0].brake: value 1.1: "),
        ("events: [{at_s: 0, event: lunch}]", 'events[0].event: value "lunch": one of '),
        ("events: [{at_s: -1, event: reset}]", "events[0].at_s: value -1: "),
        ("checks: [{min: 0}]", "checks[0].column: value missing: "),
        ("golden_hz: 3", "golden_hz: value 3: one of "),
        ("script: {points: []}", "script.points: "),
        ("script: {points: [{time_s: 0, throttle: 1.5}]}", "script.points[0].throttle: value 1.5: "),
        ("goldenhz: 2", "goldenhz: value 2: unknown key, did you mean golden_hz?"),
    ],
)
def test_what_cannot_be_meant_is_refused(text: str, told: str) -> None:
    assert told in refusal(f"{HEAD}{text}\n", ScenarioProfile)


@pytest.mark.parametrize("duration_s", ["0", "86401", ".nan"])
def test_a_scenario_lasts_some_time_and_at_most_a_day(duration_s: str) -> None:
    assert "duration_s" in refusal(HEAD.replace("duration_s: 1", f"duration_s: {duration_s}"), ScenarioProfile)
