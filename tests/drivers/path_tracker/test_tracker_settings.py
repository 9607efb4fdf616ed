"""The tracker's model of its car agrees with the profile of the car that it stands for."""

import pytest

from simconsole.drivers.path_tracker.tracker_settings import (
    COMFORT,
    GATE,
    HATCHBACK,
    TIMING,
    CarModel,
    Gate,
    asked_at_most,
    planned_within,
)
from simconsole.profiles.control import ControlProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile

PROFILE = load("vehicles", "hatchback", CarProfile)


def test_the_model_has_the_measures_of_the_shipped_hatchback() -> None:
    body = PROFILE.body
    assert (HATCHBACK.mass_kg, HATCHBACK.yaw_inertia_kgm2) == (body.mass_kg, body.yaw_inertia_kgm2)
    assert HATCHBACK.wheelbase_m == pytest.approx(body.wheelbase_m)
    assert HATCHBACK.rear_m / HATCHBACK.wheelbase_m == pytest.approx(body.front_mass_share)
    assert HATCHBACK.max_road_wheel_rad <= PROFILE.steering.max_road_wheel_deg * 0.0174533


def test_a_front_axle_that_is_weaker_for_its_load_understeers() -> None:
    assert HATCHBACK.understeer_radps2pm > 0.0
    even = CarModel(front_m=1.3, rear_m=1.3, front_stiffness_nprad=80e3, rear_stiffness_nprad=80e3)
    assert even.understeer_radps2pm == 0.0
    tail_heavy = even._replace(front_m=1.5, rear_m=1.1)
    assert tail_heavy.understeer_radps2pm < 0.0
    slip_rad = even.mass_kg * 0.5 / 80e3, even.mass_kg * 0.5 / 60e3  # of either axle at 1 m/s2
    weak_rear = even._replace(rear_stiffness_nprad=60e3)
    assert weak_rear.understeer_radps2pm == pytest.approx(slip_rad[0] - slip_rad[1])


def test_the_delay_is_within_one_period_as_the_tracker_needs_it() -> None:
    assert 0.0 <= TIMING.delay_s <= TIMING.period_s


def test_behind_the_gate_of_a_session_as_shipped_comfort_decides() -> None:
    shipped = ControlProfile()
    assert Gate(shipped.automatic_lateral_accel_mps2, shipped.automatic_lateral_jerk_mps3) == GATE
    assert planned_within(COMFORT, GATE) == planned_within(COMFORT, Gate(lateral_jerk_mps3=0.0)) == COMFORT
    assert asked_at_most(GATE) == asked_at_most(Gate(20.0, 0.0))


@pytest.mark.parametrize("gate", [Gate(2.0, 7.0), Gate(5.0, 2.5), Gate(1.0, 1.0)])
def test_behind_a_tighter_gate_less_is_asked_for_and_still_less_is_planned(gate: Gate) -> None:
    planned, asked = planned_within(COMFORT, gate), asked_at_most(gate)
    assert planned.lateral_mps2 < asked.lateral_mps2 < gate.lateral_mps2
    assert planned.lateral_jerk_mps3 < asked.lateral_jerk_mps3 < gate.lateral_jerk_mps3
