"""The lab's controller drives as it did."""

from controller import controller

import simconsole


def test_it_comes_to_its_speed_and_stops() -> None:
    drive = simconsole.load("bridge").run(controller, duration_s=14.0)
    speed_mps = drive.column("vehicle.vx_mps")
    assert 7.0 < speed_mps.max() < 8.5
    assert abs(speed_mps[-1]) < 0.1
    assert drive.replay().hashes_equal
