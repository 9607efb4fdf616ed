"""Courses on which an autopilot that does not know the gate or the delay is stopped: with noisy, late odometry."""

import math
from pathlib import Path

import numpy as np
import pytest

from simconsole.profiles.course_plan import CoursePlan, Curve, Straight
from simconsole.profiles.files.world_files import load_world
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.values.units import DEG_PER_RAD
from simconsole.world.course import Course
from simconsole.world.kinds.worlds import open_world
from simconsole.world.planning import solve
from simconsole.world.tools.generate import to_text
from tests.drives.random_courses import HAND_OVER_M, SHORT, Tracked, random_course, tracked, tracked_on
from tests.samples import Sample

NOISE = "{delay_ms: 40, localisation: {position_noise_m: 0.02, yaw_noise_deg: 0.2}}"
CARS = ("hatchback", "light_van", "commonroad_bmw320i")
PART_M = (645.0, 1130.0)
"""The sample drives this part of the urban course: bends of 50 and 80 m to both sides, and the roundabout."""
BENDS_M = (245.0, 650.0)
"""This part a plain tracker drives: bends to both sides, one of them of 12 m."""
LOOP_PART_M = 1000.0
"""So far the sample drives over the loop."""
GATE_PART_M = 260.0
"""So far the sample drives behind a gate: two bends."""
FAST_WHEEL_M = (520.0, 720.0)
"""In this part of its course the wheel is turned fast."""
WHOLE = (0.0, math.inf)


def s_bend(radius_m: float, angle_deg: float) -> CoursePlan:
    """To the left and at once to the right, curvature ramps of 3 m."""
    return CoursePlan(
        schema=1,
        title="S bend",
        lane_width_m=3.5,
        speed_limit_kmh=80.0,
        elements=(
            Straight(length_m=60.0),
            Curve(radius_m=radius_m, angle_deg=angle_deg, ramp_m=3.0),
            Curve(radius_m=radius_m, angle_deg=-angle_deg, ramp_m=3.0),
            Straight(length_m=30.0),
        ),
    )


def loop() -> CoursePlan:
    """Three kilometres at 80 km/h, bends of 150 to 200 m to both sides."""
    return CoursePlan(
        schema=1,
        title="loop",
        lane_width_m=3.5,
        speed_limit_kmh=80.0,
        length_m=3000.0,
        elements=(
            Straight(length_m=200.0),
            Curve(radius_m=180.0, angle_deg=90.0, ramp_m=30.0),
            Straight(length_m="free"),
            Curve(radius_m=200.0, angle_deg=-40.0, ramp_m=30.0),
            Straight(length_m=80.0),
            Curve(radius_m=150.0, angle_deg=130.0, ramp_m=30.0),
            Straight(length_m="free"),
            Curve(radius_m=170.0, angle_deg=90.0, ramp_m=30.0),
            Straight(length_m="free"),
            Curve(radius_m=180.0, angle_deg=90.0, ramp_m=30.0),
        ),
    )


def holds(done: Tracked, what: str) -> None:
    print(f"measured: {what}: {done}")
    assert not done.stopped
    assert done.rms_cm <= 3.0
    assert done.max_cm <= 12.0
    assert done.lateral_kept >= 0.999
    assert done.longitudinal_kept >= 0.999


@pytest.mark.parametrize(("radius_m", "angle_deg"), [(20.0, 57.0), (40.0, 60.0)], ids=["40 m long", "of 40 m radius"])
def test_an_s_bend_with_ramps_of_3_m(sample: Sample, tmp_path: Path, radius_m: float, angle_deg: float) -> None:
    world = solve(s_bend(radius_m, angle_deg), "S bend")
    for car in CARS[: sample.of(1, 3)]:
        holds(tracked(world, car, NOISE, tmp_path / car), f"{car}, S bend of {radius_m:g} m")


def test_three_kilometres_at_80_kmh(sample: Sample, tmp_path: Path) -> None:
    """The sample drives two of its bends, one to each side."""
    world = solve(loop(), "loop")
    for car in CARS[: sample.of(1, 3)]:
        until_m = math.inf if sample.long else LOOP_PART_M
        hand_over_m = HAND_OVER_M if sample.long else None
        done = tracked(world, car, NOISE, tmp_path / car, until_m=until_m, hand_over_m=hand_over_m)
        holds(done, f"{car}, loop")
        assert done.driven_s < min(until_m, 3000.0) / (70.0 / 3.6), "nor slowly"


def test_behind_a_gate_that_lets_less_pass(sample: Sample, tmp_path: Path) -> None:
    """The console tells the autopilot that it starts; one that plans for another gate is 3 m off its lane here."""
    world = random_course(np.random.default_rng(2), SHORT)
    for car in CARS[: sample.of(1, 3)]:
        until_m = math.inf if sample.long else GATE_PART_M
        gate = "{automatic_lateral_jerk_mps3: 2.5}"
        done = tracked(world, car, NOISE, tmp_path / car, control=gate, until_m=until_m)
        holds(done, f"{car}, 2.5 m/s3")
        assert done.reached >= 0.999


def test_plain_trackers_drive_the_demos_course_behind_the_gate(sample: Sample, tmp_path: Path) -> None:
    """Their links are late, too; with noise they may be stopped: `scripts/make_tracking.py` counts how often."""
    route = open_world(load_world("urban")).route
    for tracker in ("stanley", "pure_pursuit")[: sample.of(1, 2)]:
        folder = tmp_path / tracker
        folder.mkdir()
        start_m, until_m = WHOLE if sample.long else BENDS_M
        hand_over_m = HAND_OVER_M if sample.long else None
        link, part = "{delay_ms: 40}", (start_m, until_m)
        done = tracked_on(route, "urban", "hatchback", link, folder, hand_over_m, tracker, "{}", *part)
        print(f"measured: {tracker}: {done}")
        assert not done.stopped
        assert done.max_cm <= 50.0


def test_resting_hands_that_a_fast_wheel_carries_along_take_nothing_over(tmp_path: Path) -> None:
    """A bend of 10 m that ends within 3.3 m, by a slow steering: the motor unwinds the wheel at 600 deg/s."""
    seed = 3241296937210489
    link = f"{{seed: {seed}, delay_ms: 40, localisation: {{position_noise_m: 0.02, yaw_noise_deg: 0.2}}}}"
    (tmp_path / "course.yaml").write_text(to_text(world := random_course(np.random.default_rng(seed)), "random"))
    start_m, until_m = FAST_WHEEL_M
    route, car = Course(world), "commonroad_bmw320i"
    done = tracked_on(route, "course.yaml", car, link, tmp_path, start_m=start_m, until_m=until_m)
    rates = open_bundle(tmp_path / "bundle").log.table(("motor.wheel_radps",)).column("motor.wheel_radps")
    print(f"measured: a wheel that is turned at {np.abs(rates).max() * DEG_PER_RAD:.0f} deg/s: {done}")
    assert np.abs(rates).max() * DEG_PER_RAD > 590.0
    assert not done.stopped


def test_urban_course_without_noise_and_delay(sample: Sample, tmp_path: Path) -> None:
    """Over the WebSocket; the long run drives the whole lap."""
    route, (start_m, until_m) = open_world(load_world("urban")).route, WHOLE if sample.long else PART_M
    hand_over_m = HAND_OVER_M if sample.long else None
    done = tracked_on(route, "urban", "hatchback", "{}", tmp_path, hand_over_m, start_m=start_m, until_m=until_m)
    print(f"measured: urban course, no noise, no delay: {done}")
    assert not done.stopped
    assert done.rms_cm <= 0.2
    assert done.max_cm <= 1.0
