"""The template of a controller that sessions name, as a package that registers it. `$name` is what it is called."""

from typing import Final

ENTRY: Final = ("simconsole.controllers", "CONTROLLER")
"""The group of its entry point, and what that names in its module."""

DRIVER: Final = '''\
"""$name: a controller that is called by its name. `pip install -e .` registers it.

From then on `features.controller: {name: $name}` drives a session, a scenario or a sweep with it, where `mode.pacing`
is lockstep; $name.yaml is such a session.
"""

import math

import simconsole
from simconsole.drivers.registered import ControllerSettings, OwnController
from simconsole.values.registered import Bounded

PARAMETERS = {
    "speed_mps": Bounded(8.0, 0.5, 30.0),
    "ahead_s": Bounded(0.5, 0.1, 3.0),
}
"""Each with what it is, and between which values a session may put it (features.controller.parameters)."""


class Controller:
    """Follows the route by pure pursuit. It is called once per control period with the tick that ends it."""

    def __init__(self, settings: ControllerSettings):
        self.route, self.vehicle = settings.route, settings.vehicle
        self.speed_mps, self.ahead_s = (settings.parameters[name] for name in PARAMETERS)
        self.place_m = 0.0

    def __call__(self, seen):
        if self.route is None:
            return simconsole.hold_speed(self.speed_mps)
        car = seen.vehicle
        self.place_m, _, _ = self.route.project(car.x_m, car.y_m, self.place_m)
        ahead_m = 3.0 + self.ahead_s * car.vx_mps
        goal = self.route.at(self.place_m + ahead_m)
        bearing_rad = math.atan2(goal.y_m - car.y_m, goal.x_m - car.x_m) - car.yaw_rad
        bend_1pm = max(abs(self.route.curvature_at(self.place_m + far_m)) for far_m in (0.0, ahead_m, 2.0 * ahead_m))
        speed_mps = min(self.speed_mps, math.sqrt(2.0 / (bend_1pm + 1e-6)))
        steering = 2.0 * self.vehicle.wheelbase_m * math.sin(bearing_rad) / ahead_m
        return simconsole.hold_speed(speed_mps, math.atan(steering))


CONTROLLER = OwnController(PARAMETERS, Controller)
'''

SESSION: Final = """\
# $name drives this session by itself: `simconsole drive $name.yaml --headless`.
schema: 1
title: $name
environment:
  world: urban
scenario:
  vehicle: hatchback
  duration_s: 20
features:
  controller: {name: $name, parameters: {speed_mps: 7.0}}
  control:
    person_required: false
outputs:
  hud: null
devices:
  driver: none
mode:
  pacing: lockstep
"""

TEST: Final = '''\
"""$name drives, stays in its lane, and its parameters have bounds. No installation is needed for this."""

from pathlib import Path
from runpy import run_path

import pytest

import simconsole
from simconsole.drivers.registered import named_controller
from simconsole.profiles.session import ControllerChoice
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import compiled

HERE = Path(__file__).parent
CONTROLLER = run_path(str(HERE / "$name.py"))["CONTROLLER"]
SESSION = simconsole.load(HERE / "$name.yaml")


def made(**parameters):
    choice = SESSION.profile.features.controller
    choice = ControllerChoice(name=choice.name, parameters={**choice.parameters, **parameters})
    vehicle = assemble(SESSION.resolved, compiled)[0].platform
    return named_controller(choice, SESSION.route, vehicle, 0.02, CONTROLLER)


def test_it_stays_in_its_lane():
    drive = SESSION.run(made(speed_mps=6.0), duration_s=20.0)
    assert abs(drive.column("vehicle.vx_mps")[-1] - 6.0) < 0.5
    assert drive.metrics["autonomous"]["lateral_max_m"] < 0.5


def test_its_parameters_have_bounds():
    with pytest.raises(simconsole.SimConsoleError, match="parameters: speed_mps: value 99: 0.5 to 30"):
        made(speed_mps=99.0)
    with pytest.raises(simconsole.SimConsoleError, match="parameters: wings: one of"):
        made(wings=1.0)
'''
