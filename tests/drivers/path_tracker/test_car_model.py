import pytest

from simconsole.drivers.path_tracker.car_model import car_model
from simconsole.drivers.path_tracker.tracker_settings import HATCHBACK
from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import BallProfile, VehicleProfile


def test_the_hatchbacks_model_is_the_one_that_was_measured() -> None:
    assert tuple(car_model(load("vehicles", "hatchback", VehicleProfile))[:7]) == pytest.approx(HATCHBACK[:7], rel=2e-3)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["hatchback", "light_van", "commonroad_bmw320i"])
def test_every_shipped_car_is_modelled_whole_and_understeers(name: str) -> None:
    model = car_model(load("vehicles", name, VehicleProfile))  # type: ignore[arg-type]
    assert model.wheelbase_m == pytest.approx(model.front_m + model.rear_m)
    assert min(model) > 0.0
    assert model.understeer_radps2pm > -1e-4


def test_a_ball_is_steered_as_the_hatchback() -> None:
    assert car_model(load("vehicles", "ball", BallProfile)) is HATCHBACK
