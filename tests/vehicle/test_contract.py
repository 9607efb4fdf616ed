"""The contract of vehicles, held by all that are shipped; what breaks it is named."""

from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row
from simconsole.values.layout import read, write
from simconsole.values.platform import Ground, Platform, Pose
from simconsole.values.state_vector import LAYOUT
from simconsole.vehicle.contract import problems
from simconsole.vehicle.platforms import build
from tests.vehicle.fmu.building import build as build_unit

LEVEL = Ground(friction=1.0, slope_x=0.0, slope_y=0.0)


def shipped(name: str) -> Platform:
    return build(load_vehicle(name), Pose(0.0, 0.0, 0.0), LEVEL)


@pytest.mark.parametrize("name", ["ball", "turtlebot3_burger", "hatchback", "light_van", "commonroad_bmw320i"])
def test_what_is_shipped_keeps_it(name: str) -> None:
    vehicle = shipped(name)
    assert problems(vehicle._replace(step=compiled(vehicle.step))) == []


@pytest.mark.parametrize("version", [2, 3])
def test_an_fmu_keeps_it(version: Literal[2, 3], tmp_path: Path) -> None:
    profile = load_vehicle(str(build_unit(tmp_path, version, speed_mps=0.0)))
    assert problems(build(profile, Pose(0.0, 0.0, 0.0), LEVEL)) == []


def test_what_breaks_it_is_named() -> None:
    ball = shipped("ball")
    count = [0.0]

    def forgetful(previous: Row, row: Row, parameters: Row, ground: Row, substeps: int) -> None:
        ball.step(previous, row, parameters, ground, substeps)
        count[0] += 1.0
        vehicle = read(row, LAYOUT.vehicle)
        write(row, LAYOUT.vehicle, vehicle._replace(pitch_rad=count[0]))

    found = problems(ball._replace(step=forgetful))
    assert any("give other bits" in one for one in found)
    assert any("keeps something beside its state" in one for one in found)

    def runs_away(previous: Row, row: Row, parameters: Row, ground: Row, substeps: int) -> None:
        write(
            row, LAYOUT.vehicle, read(previous, LAYOUT.vehicle)._replace(x_m=read(previous, LAYOUT.vehicle).x_m + 1.0)
        )

    assert any("braked at rest: it moves 500 m" in one for one in problems(ball._replace(step=runs_away)))

    def breaks(previous: Row, row: Row, parameters: Row, ground: Row, substeps: int) -> None:
        row[LAYOUT.vehicle.start] = np.nan

    assert problems(ball._replace(step=breaks)) == ["braked at rest: a value is not finite"]
    assert problems(ball._replace(initial_state=(), width_m=0.0)) == [
        "initial_state: 0 values, 10 columns",
        "width_m: not above 0",
    ]
