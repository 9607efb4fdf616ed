"""Who drives a scenario: a script, a trace, a simulated person, or a live autopilot in lockstep."""

from pathlib import Path

import pytest

from simconsole.evaluation.checks.scenario_check import check_scenario
from simconsole.session.resolution import load_scenario
from simconsole.values.errors import ProfileError

PERSON = """\
schema: 1
title: a person drives straight on
duration_s: 12
session:
  schema: 1
  scenario: {vehicle: hatchback}
  devices:
    driver: virtual
    person: {cruise_kmh: 30}
checks:
  - {column: vehicle.vx_mps, at_s: 12, min: 4, max: 10}
modes: [manual]
"""
LIVE = """\
schema: 1
title: the autopilot drives in lockstep and is asked to hand over
duration_s: 10
session:
  schema: 1
  environment: {world: urban}
  scenario: {vehicle: hatchback}
  features: {autopilot: urban, control: {person_required: false}}
  outputs: {bridge: {port: 0}}
  devices: {driver: none}
  mode: {pacing: lockstep}
events:
  - {event: request_autonomous, at_s: 1}
  - {event: request_takeover, at_distance_m: 15}
metrics:
  - {metric: autonomous.lateral_max_m, max: 0.05}
modes: [parked, autonomous, takeover_requested]
"""


@pytest.mark.parametrize("text", [PERSON, LIVE], ids=["person", "live"])
def test_it_drives_and_does_the_same_again(text: str, tmp_path: Path) -> None:
    path = tmp_path / "s.yaml"
    path.write_text(text)
    accepted = check_scenario(str(path), update_golden=True)
    assert accepted.passed, accepted.problems
    again = check_scenario(str(path))
    assert again.passed, again.problems
    assert again.digest == accepted.digest


def test_a_trace_drives(tmp_path: Path) -> None:
    """What a person did is recorded as a script, here beside the scenario, and drives it."""
    (tmp_path / "acts.yaml").write_text(
        "points:\n  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}\n"
        "  - {time_s: 0.5, gear: 1, throttle: 0}\n  - {time_s: 1.0, throttle: 0.4}\n"
    )
    (tmp_path / "s.yaml").write_text(
        "schema: 1\ntitle: s\nduration_s: 4\nsession:\n  schema: 1\n  scenario: {vehicle: hatchback}\n"
        "  features: {control: {manual_automatic: true}}\n  devices: {driver: 'script:acts.yaml'}\n"
        "checks:\n  - {column: vehicle.vx_mps, at_s: 4, min: 1}\n"
    )
    scenario, _ = load_scenario(str(tmp_path / "s.yaml"))
    assert scenario.session.devices.driver == f"script:{tmp_path / 'acts.yaml'}"
    verdict = check_scenario(str(tmp_path / "s.yaml"), update_golden=True)
    assert verdict.passed, verdict.problems


def test_two_drivers_are_refused(tmp_path: Path) -> None:
    script = "script: {points: [{time_s: 0, throttle: 0}]}\n"
    (tmp_path / "s.yaml").write_text(PERSON + script)
    with pytest.raises(ProfileError, match=r"session\.devices\.driver: value virtual: none, beside a script"):
        check_scenario(str(tmp_path / "s.yaml"))
    (tmp_path / "s.yaml").write_text(LIVE + "remote: [{start_s: 0, end_s: 1, kind: speed}]\n")
    with pytest.raises(ProfileError, match="remote: without a session in lockstep"):
        check_scenario(str(tmp_path / "s.yaml"))


def test_several_platforms_are_refused(tmp_path: Path) -> None:
    """One of three robots was driven before, and nobody said so."""
    path = tmp_path / "s.yaml"
    path.write_text(PERSON.replace("vehicle: hatchback}", "vehicle: hatchback, platforms: [{name: a}, {name: b}]}"))
    with pytest.raises(ProfileError, match=r"session\.scenario\.platforms: value given: a scenario drives one vehicle"):
        check_scenario(str(path))
