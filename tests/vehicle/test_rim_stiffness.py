"""A car's stiffness about the middle, from its profile."""

import pytest

from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.values.platform import NO_STIFFNESS
from simconsole.vehicle.rim_stiffness import rim_stiffness


def test_ball_feels_nothing() -> None:
    assert rim_stiffness(load_vehicle("ball")) == NO_STIFFNESS


def test_car_without_trail_feels_its_own_friction() -> None:
    """0.25 N m of it, over a short way: Dahl's spring."""
    found = rim_stiffness(load_vehicle("commonroad_bmw320i"))
    assert found[:5] == pytest.approx((0.25 * 296.03 / 15.5,) * 5, rel=1e-3)
    assert found.pulls == 0.0


@pytest.mark.parametrize("name", ["hatchback", "light_van"])
def test_cars_grow_firmer_with_speed(name: str) -> None:
    found = rim_stiffness(load_vehicle(name))
    assert 1.0 < found.at_0mps <= found.at_12mps <= found.at_24mps <= found.at_36mps <= found.at_48mps < 150.0
    assert 0.1 < found.relaxation_m < 1.0
    assert found.pulls == 1.0
