import pytest

from simconsole.profiles.traffic import LeadVehicle, SpeedFrom
from simconsole.values.platform import Pose
from simconsole.world.path_geometry import Piece
from simconsole.world.route import Route, Stretch
from simconsole.world.traffic.lead_vehicle import LeadDriver


def driver(*speeds: SpeedFrom, length_m: float = 500.0) -> LeadDriver:
    route = Route([Stretch(0.0, Pose(0.0, 0.0, 0.0), Piece(length_m, 0.0, 0.0), 14.0)])
    return LeadDriver(LeadVehicle(gap_m=20.0, speeds=speeds, acceleration_mps2=2.0), route, 5.0)


def test_speeds_follow_the_script_no_faster_than_it_accelerates() -> None:
    one = driver(SpeedFrom(speed_kmh=36.0), SpeedFrom(from_s=10.0, speed_kmh=0.0))
    seen = [one.step(0.1) for _ in range(160)]
    assert seen[24].speed_mps == pytest.approx(5.0)
    assert seen[60].speed_mps == pytest.approx(10.0)
    assert seen[-1].speed_mps == 0.0
    assert seen[-1].x_m == pytest.approx(25.0 + 25.0 + 50.0 + 25.0, abs=1.01)  # it may act a step later
    assert seen[-1].y_m == 0.0


def test_who_has_collided_comes_to_rest() -> None:
    one = driver(SpeedFrom(speed_kmh=36.0))
    for _ in range(100):
        before = one.step(0.1)
    one.crash(-0.5 * before.speed_mps)
    speeds = [one.step(0.1).speed_mps for _ in range(100)]
    assert 0.0 < speeds[0] < 0.6 * before.speed_mps
    assert speeds[-1] == 0.0


def test_nothing_is_driven_before_the_first_speed() -> None:
    one = driver(SpeedFrom(from_s=5.0, speed_kmh=36.0))
    assert [one.step(1.0).x_m for _ in range(4)] == pytest.approx([25.0] * 4)


def test_it_stops_at_the_end_of_an_open_route() -> None:
    one = driver(SpeedFrom(speed_kmh=36.0), length_m=100.0)
    assert [one.step(0.1) for _ in range(400)][-1].speed_mps == 0.0
