"""Drivers and evaluation of the manoeuvres, on drives whose answer is known."""

import math

import numpy as np
import pytest

from simconsole.drivers.manoeuvre_driver.lane_changer import course_of, path_at
from simconsole.evaluation.manoeuvres.attempt import Attempt
from simconsole.evaluation.manoeuvres.braking import straight_braking
from simconsole.evaluation.manoeuvres.lane_change import least_room_m
from simconsole.evaluation.manoeuvres.library import drive_manoeuvre
from simconsole.evaluation.manoeuvres.observed import observed
from simconsole.evaluation.manoeuvres.sine_with_dwell import completion_s, wave
from simconsole.evaluation.metrics.table import Array, Drive, drive_of
from simconsole.profiles.manoeuvre import Observed, SineWithDwell, StraightBraking
from tests.vehicle.driving import platform

HZ = 250
CAR = platform()


def drive(seconds: float, **columns: Array) -> Drive:
    """Return a drive with these columns; a dot in a name is a double underscore."""
    count = round(seconds * HZ)
    names = [name.replace("__", ".") for name in columns]
    rows = np.column_stack([np.broadcast_to(column, count) for column in columns.values()])
    return drive_of(rows, names, HZ)


def test_the_sine_holds_its_second_peak() -> None:
    spec = SineWithDwell()
    assert completion_s(spec) == pytest.approx(1.0 / 0.7 + 0.5)
    assert wave(spec, 0.25 / 0.7) == pytest.approx(1.0)
    assert wave(spec, 0.75 / 0.7) == wave(spec, 0.75 / 0.7 + 0.49) == -1.0
    assert wave(spec, completion_s(spec) - 1e-9) == pytest.approx(0.0, abs=1e-6)
    assert wave(spec, completion_s(spec) + 0.5) == 0.0
    steps = np.diff([wave(spec, time_s) for time_s in np.arange(0.0, 3.0, 0.001)])
    assert np.abs(steps).max() < 1.01 * math.tau * 0.7 * 0.001, "no jump"


def test_the_courses_have_their_lengths_and_widths() -> None:
    long, short = course_of("iso_3888_1", 1.8), course_of("iso_3888_2", 1.8)
    assert long.lanes[-1].to_m == 125.0
    assert short.lanes[-1].to_m == 61.0
    assert [lane.width_m for lane in short.lanes] == pytest.approx([2.23, 2.8, 3.0])
    first, second = short.lanes[:2]
    assert second.middle_m - 0.5 * second.width_m - (first.middle_m + 0.5 * first.width_m) == pytest.approx(1.0)


@pytest.mark.parametrize("name", ["iso_3888_1", "iso_3888_2"])
def test_the_path_has_the_slope_and_curvature_that_it_says(name: str) -> None:
    course = course_of(name, CAR.width_m)
    for s_m in np.arange(-10.0, 130.0, 0.7):
        before, (side, slope, curvature), after = (path_at(course, s_m + step) for step in (-1e-4, 0.0, 1e-4))
        assert (after[0] - before[0]) / 2e-4 == pytest.approx(slope, abs=1e-5)
        assert (after[1] - before[1]) / 2e-4 == pytest.approx(curvature, abs=1e-3)
        for lane in course.lanes:
            if lane.from_m + 2.0 < s_m < lane.to_m - 2.0:
                assert abs(side - lane.middle_m) < 0.5 * lane.width_m


@pytest.mark.parametrize(("aside_m", "room_m"), [(0.0, 0.2145), (0.1, 0.1145), (0.4, -0.1855)])
def test_room_is_that_of_the_nearest_corner(aside_m: float, room_m: float) -> None:
    course = course_of("iso_3888_2", 1.79)._replace(lanes=course_of("iso_3888_2", 1.79).lanes[:1])
    x = np.linspace(-10.0, 20.0, HZ)
    straight = drive(1.0, vehicle__x_m=x, vehicle__y_m=np.array(aside_m), vehicle__yaw_rad=np.array(0.0))
    assert least_room_m(straight, course, CAR) == pytest.approx(room_m)
    short = drive(1.0, vehicle__x_m=x - 20.0, vehicle__y_m=np.array(0.0), vehicle__yaw_rad=np.array(0.0))
    assert least_room_m(short, course, CAR) == -math.inf, "it never got through"


def test_braking_at_eight_metres_per_second_squared() -> None:
    at_work = straight_braking(StraightBraking(speed_kmh=90.0, without=False), CAR)
    attempt = next(at_work)
    assert attempt.pilot is not None
    attempt.pilot.began_tick = 1  # type: ignore[attr-defined]  # as if the run-up were over
    time_s = np.arange(HZ * 3) / HZ
    speed = 24.0 - 8.0 * time_s
    spin = {f"platform__{wheel}_radps": 0.9 * speed / 0.306 for wheel in ("fl", "fr", "rl")}
    spin = {name: np.where(time_s > 0.5, values, values / 0.9) for name, values in spin.items()}
    braked = drive(
        3.0,
        vehicle__vx_mps=speed,
        vehicle__distance_m=24.0 * time_s - 4.0 * time_s**2,
        vehicle__x_m=time_s,
        vehicle__y_m=0.1 * time_s,
        vehicle__yaw_rad=-0.01 * time_s,
        platform__rr_radps=speed / 0.306,
        **spin,
    )
    with pytest.raises(StopIteration) as end:
        at_work.send(braked)
    values = end.value.value.values
    assert values["stopping_distance_m"] == pytest.approx(24.0**2 / 16.0 * (25.0 / 24.0) ** 2, rel=1e-3)
    assert values["mean_fully_developed_deceleration_mps2"] == pytest.approx(8.0, rel=1e-3)
    assert values["lowest_wheel_speed_share"] == pytest.approx(0.9, rel=1e-3)
    assert values["largest_yaw_angle_deg"] == pytest.approx(1.72, abs=0.01)


def test_a_watched_drive_is_described() -> None:
    at_work = observed(Observed(from_s=1.0, until_s=3.0), CAR, 4.0)
    assert next(at_work) == Attempt("script", None, 4.0)
    time_s = (1 + np.arange(HZ * 4)) / HZ
    running = np.where(time_s > 2.0, 0.0, 1.0)
    seen = drive(
        4.0,
        vehicle__vx_mps=np.sin(time_s),
        vehicle__x_m=-time_s,
        vehicle__y_m=np.array(0.0),
        vehicle__yaw_rad=np.array(0.0),
        vehicle__ax_mps2=time_s,
        vehicle__engine_radps=100.0 * time_s,
        vehicle__engine_running=running,
        vehicle__distance_m=time_s,
    )
    with pytest.raises(StopIteration) as end:
        at_work.send(seen)
    values = end.value.value.values
    assert values["engine_stalled"] == 1.0
    assert values["end_engine_running"] == 0.0
    assert values["rolled_back_m"] == pytest.approx(2.0, abs=0.01)
    assert values["lowest_engine_speed_rpm"] == pytest.approx(955.0, abs=5.0)


@pytest.mark.parametrize(
    ("spec", "kind"),
    [(Observed(), "observed"), (SineWithDwell(), "sine_with_dwell"), (StraightBraking(), "straight_braking")],
)
def test_every_description_finds_its_manoeuvre(spec: Observed | SineWithDwell | StraightBraking, kind: str) -> None:
    at_work = drive_manoeuvre(spec, CAR, 1.0)
    assert at_work.gi_code.co_name == kind  # type: ignore[attr-defined]  # of a generator function
