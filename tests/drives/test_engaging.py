"""The autopilot takes over from wherever the car stands, or says why not; at the end of an open course it stops."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from simconsole.profiles.course_plan import CoursePlan, Curve, Straight
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.labels import reason_label
from simconsole.values.signals import Mode, Reason
from simconsole.world.course import Course
from simconsole.world.planning import solve
from simconsole.world.tools.generate import to_text

LINK = "{delay_ms: 40, localisation: {position_noise_m: 0.02, yaw_noise_deg: 0.2}}"
NAMES = ("x_m", "y_m", "yaw_rad", "vx_mps", "distance_m")
PERSON = """points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 2.0, press: [autonomous]}
"""
COLUMNS = (
    *(f"vehicle.{name}" for name in ("x_m", "y_m", "distance_m", "vx_mps")),
    *("arbitration.mode", "arbitration.refusal", "ros.accel_mps2"),
)
OPEN = CoursePlan(
    schema=1,
    title="open",
    lane_width_m=3.5,
    speed_limit_kmh=50.0,
    elements=(Straight(length_m=60.0), Curve(radius_m=20.0, angle_deg=70.0, ramp_m=6.0), Straight(length_m=15.0)),
)


def parked(folder: Path, start: str, vehicle: str = "hatchback", duration_s: float = 25.0, faults: str = "[]") -> Path:
    """Drive from `start` (YAML) with an autopilot that is asked for while the car stands; return the bundle."""
    world = solve(OPEN, "open")
    (folder / "course.yaml").write_text(to_text(world, "open"))
    (folder / "session.yaml").write_text(
        "schema: 1\nenvironment: {world: course.yaml}\n"
        f"scenario: {{vehicle: {vehicle}, duration_s: {duration_s}, start: {start}, faults: {faults}}}\n"
        "features: {autopilot: course.yaml}\n"
        f"outputs: {{hud: null, scene: null, report: false, bridge: {{port: 0, link: {LINK}}}}}\n"
        f"devices: {{driver: 'script:{folder / 'person.yaml'}'}}\nmode: {{pacing: lockstep, answer_timeout_s: 60}}\n"
    )
    (folder / "person.yaml").write_text(PERSON)
    drive(resolve(load_session(str(folder / "session.yaml"))), folder / "bundle")
    return folder / "bundle"


def modes(bundle: Path) -> set[Mode]:
    return {Mode(int(mode)) for mode in open_bundle(bundle).log.table(COLUMNS).column("arbitration.mode")}


@pytest.mark.parametrize(
    ("vehicle", "aside_m", "turned_deg"),
    [
        ("hatchback", 1.0, 20.0),
        ("hatchback", 1.0, -20.0),
        ("hatchback", -0.7, -24.0),
        ("light_van", 1.0, 20.0),
        ("commonroad_bmw320i", -1.0, -20.0),
    ],
)
def test_a_car_that_stands_beside_the_lane_is_led_back(
    tmp_path: Path, vehicle: str, aside_m: float, turned_deg: float
) -> None:
    bundle = parked(tmp_path, f"{{x_m: 5.0, y_m: {aside_m}, yaw_deg: {turned_deg}}}", vehicle, 12.0)
    table = open_bundle(bundle).log.table(COLUMNS)
    course = Course(solve(OPEN, "open"))
    _, lateral = course.project_all(table.column("vehicle.x_m"), table.column("vehicle.y_m"), 5.0)
    print(f"measured: {vehicle} from {aside_m:g} m and {turned_deg:g} deg: {np.abs(lateral).max():.2f} m at most")
    assert modes(bundle) - {Mode.PARKED} == {Mode.MANUAL, Mode.AUTONOMOUS}
    assert np.abs(lateral).max() <= 1.3
    assert abs(lateral[-1]) < 0.05
    assert table.column("vehicle.distance_m")[-1] > 30.0


@pytest.mark.parametrize(
    ("start", "said"),
    [
        ("{x_m: 5.0, y_m: 2.0}", "gives no commands: the way back leads 2.0 m from the course, at most 1.3 m"),
        ("{x_m: 5.0, y_m: 0.0, yaw_deg: 40}", "gives no commands: the car is turned 40 deg from the course"),
        ("{x_m: 5.0, y_m: 1.2, yaw_deg: 20}", "gives no commands: the way back leads 1.4 m from the course"),
    ],
)
def test_too_far_from_the_course_there_are_no_commands_and_it_says_why(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], start: str, said: str
) -> None:
    bundle = parked(tmp_path, start, duration_s=5.0)
    table = open_bundle(bundle).log.table(COLUMNS)
    assert modes(bundle) - {Mode.PARKED} == {Mode.MANUAL}
    assert Reason.REFUSED_NO_COMMAND in table.column("arbitration.refusal")
    assert table.column("vehicle.distance_m")[-1] < 0.05
    assert capfd.readouterr().err.count(said) == 1


def test_at_the_end_of_an_open_course_the_car_stands(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    bundle = parked(tmp_path, "{x_m: 0.0, y_m: 0.0}", duration_s=35.0)
    table = open_bundle(bundle).log.table(COLUMNS)
    course = Course(solve(OPEN, "open"))
    s_m, lateral = course.project_all(table.column("vehicle.x_m"), table.column("vehicle.y_m"), 0.0)
    speed, asked = table.column("vehicle.vx_mps"), table.column("ros.accel_mps2")
    print(f"measured: the car stands {course.length_m - s_m[-1]:.2f} m before the end")
    assert modes(bundle) - {Mode.PARKED} == {Mode.MANUAL, Mode.AUTONOMOUS}, "no safe stop"
    assert math.isclose(s_m[-1], course.length_m, abs_tol=0.3)
    assert abs(lateral[-1]) < 0.05
    assert np.abs(speed[-500:]).max() < 1e-3
    assert asked.min() > -2.0
    assert np.abs(np.diff(asked)).max() <= 3.0 * 0.02
    assert capfd.readouterr().err.count("stands at the end of the course") == 1


def test_a_refused_command_names_the_limit_that_it_broke(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """What steers too hard to be meant is told to its sender, which tells people; the log names the limit, too."""
    faults = "[{kind: astray, at_s: 8.0, for_s: 0.1, road_wheel_deg: 34}]"
    bundle = parked(tmp_path, "{x_m: 0.0, y_m: 0.0}", duration_s=9.0, faults=faults)
    told = [one for one in capfd.readouterr().err.splitlines() if "command not followed" in one]
    assert re.fullmatch(
        r"autopilot: the console says \(1\): error: command not followed: "
        r"lateral acceleration of \d+\.\d m/s2 at \d+\.\d m/s, at most 10 m/s2",
        told[0],
    )
    shown = {reason_label(code) for code in open_bundle(bundle).log.table().column("arbitration.refusal")}
    assert "refused: too much lateral acceleration" in shown
