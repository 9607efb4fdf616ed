"""What the person sees is what the snapshot shows, each in its own place."""

import numpy as np

from simconsole.drivers.simulated_person.situation import Light, Situation
from simconsole.drivers.simulated_person.view import view_of
from simconsole.values.signals import Mode, VehicleState
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot


def test_each_field_is_that_of_the_vehicle() -> None:
    row = np.zeros(PLATFORM_AT)
    vehicle = VehicleState(*(float(place) for place in range(1, len(VehicleState._fields) + 1)))
    row[LAYOUT.vehicle.slice] = vehicle
    row[LAYOUT.arbitration.at("mode")] = Mode.AUTONOMOUS
    row[LAYOUT.driver.at("hand_wheel_rad")] = 0.7
    ahead = Situation(lead_gap_m=12.0, light=float(Light.RED), line_m=30.0)
    seen = view_of(Snapshot(500, 250, row), ahead)
    assert (seen.hand_wheel_rad, seen.situation) == (0.7, ahead)
    assert (seen.time_s, seen.mode) == (2.0, Mode.AUTONOMOUS)
    assert seen.speed_mps == vehicle.vx_mps
    same = set(seen._fields) & set(vehicle._fields)
    assert len(same) == 7
    assert {name: getattr(seen, name) for name in same} == {name: getattr(vehicle, name) for name in same}
