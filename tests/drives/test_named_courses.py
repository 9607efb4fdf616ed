"""Courses on which an autopilot that does not know the gate or the delay is stopped: with noisy, late odometry."""

import math
from pathlib import Path

import numpy as np
import pytest

from simconsole.profiles.course_plan import CoursePlan, Curve, Straight
from simconsole.profiles.files.world_files import load_world
from simconsole.world.kinds.worlds import open_world
from simconsole.world.planning import solve
from tests.drives.random_courses import SHORT, Tracked, random_course, tracked, tracked_on
from tests.samples import Sample

NOISE = "{delay_ms: 40, localisation: {position_noise_m: 0.02, yaw_noise_deg: 0.2}}"
CARS = ("hatchback", "light_van", "commonroad_bmw320i")
PART_M = 1200.0
"""So far the sample drives over the urban course: bends to both sides, and the roundabout."""
BENDS_M = 700.0
"""So far a plain tracker does: bends to both sides, one of them of 12 m."""
LOOP_PART_M = 1150.0
"""So far the sample drives over the loop."""


def s_bend(radius_m: float, angle_deg: float) -> CoursePlan:
    """To the left and at once to the right, curvature ramps of 3 m."""
    return CoursePlan(
        schema=1,
        title="S bend",
        lane_width_m=3.5,
        speed_limit_kmh=80.0,
        elements=(
            Straight(length_m=90.0),
            Curve(radius_m=radius_m, angle_deg=angle_deg, ramp_m=3.0),
            Curve(radius_m=radius_m, angle_deg=-angle_deg, ramp_m=3.0),
            Straight(length_m=60.0),
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
    """The sample drives two of its bends, one to each side, and ends in the third."""
    world = solve(loop(), "loop")
    for car in CARS[: sample.of(1, 3)]:
        until_m = math.inf if sample.long else LOOP_PART_M
        done = tracked(world, car, NOISE, tmp_path / car, until_m=until_m)
        holds(done, f"{car}, loop")
        assert done.driven_s < min(until_m, 3000.0) / (70.0 / 3.6), "nor slowly"


def test_behind_a_gate_that_lets_less_pass(sample: Sample, tmp_path: Path) -> None:
    """The console tells the autopilot that it starts; one that plans for another gate is 3 m off its lane here."""
    world = random_course(np.random.default_rng(2), SHORT)
    for car in CARS[: sample.of(1, 3)]:
        done = tracked(world, car, NOISE, tmp_path / car, control="{automatic_lateral_jerk_mps3: 2.5}")
        holds(done, f"{car}, 2.5 m/s3")
        assert done.reached >= 0.999


def test_plain_trackers_drive_the_demos_course_behind_the_gate(sample: Sample, tmp_path: Path) -> None:
    """Their links are late, too; with noise they may be stopped: `scripts/make_tracking.py` counts how often."""
    route = open_world(load_world("urban")).route
    for tracker in ("stanley", "pure_pursuit")[: sample.of(1, 2)]:
        folder = tmp_path / tracker
        folder.mkdir()
        until_m = math.inf if sample.long else BENDS_M
        done = tracked_on(route, "urban", "hatchback", "{delay_ms: 40}", folder, tracker=tracker, until_m=until_m)
        print(f"measured: {tracker}: {done}")
        assert not done.stopped
        assert done.max_cm <= 50.0


def test_resting_hands_that_a_fast_wheel_carries_along_take_nothing_over(tmp_path: Path) -> None:
    """A bend of 16 m that begins within 3.3 m, by a slow steering: the motor unwinds the wheel at 590 deg/s."""
    seed = 3241296937210489
    link = f"{{seed: {seed}, delay_ms: 40, localisation: {{position_noise_m: 0.02, yaw_noise_deg: 0.2}}}}"
    world = random_course(np.random.default_rng(seed))
    done = tracked(world, "commonroad_bmw320i", link, tmp_path / "course")
    print(f"measured: a wheel that is turned fast: {done}")
    assert not done.stopped


def test_urban_course_without_noise_and_delay(sample: Sample, tmp_path: Path) -> None:
    """Over the WebSocket; the long run drives the whole lap."""
    route, until_m = open_world(load_world("urban")).route, math.inf if sample.long else PART_M
    done = tracked_on(route, "urban", "hatchback", "{}", tmp_path, until_m=until_m)
    print(f"measured: urban course, no noise, no delay: {done}")
    assert not done.stopped
    assert done.rms_cm <= 0.2
    assert done.max_cm <= 1.0
