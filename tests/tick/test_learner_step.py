"""A learner's step in one call: the same to the bit as its ticks one by one and a look after them."""

import numpy as np
import pytest

from simconsole.control.requests.control_settings import settings
from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.profiles.control import ControlProfile
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.files.world_files import load_world
from simconsole.tick.advance import Console, Execution, advance_vector, build_console
from simconsole.tick.learner_step import learner_step
from simconsole.values.host.jit import compiled, plain
from simconsole.values.platform import Pose
from simconsole.values.signals import NO_COMMAND, NO_EVENTS, NO_SAMPLE, Event, EventInput, RemoteKind
from simconsole.values.state_vector import INPUT_WIDTH, Snapshot, TickInputs, input_vector
from simconsole.world.kinds.worlds import open_world
from simconsole.world.lane_view import LaneView, lane_view, path_of, place_at
from tests.bits import difference
from tests.vehicle.driving import platform

HZ = 250
TICKS = 5
STEPS = 40
ROUTE = open_world(load_world("urban")).route
PATH = path_of(ROUTE)


def console_of(execution: Execution, *, kernel: bool) -> Console:
    """Return a car's console; `kernel`: whether the car's step is one, like ours, or Python like another package's."""
    at = ROUTE.at(0.0)
    car = platform(pose=Pose(at.x_m, at.y_m, at.yaw_rad))._replace(compiled=kernel)
    control = settings(
        ControlProfile(person_required=False), car.steering_ratio, car.max_road_wheel_rad, car.wheelbase_m, HZ
    )
    return build_console(
        cockpit_settings(load("devices", "t500rs_th8rs", CockpitProfile), HZ), control, car, HZ, execution
    )


def commanded(step: int) -> tuple[float, float]:
    """Return the road-wheel angle in rad and the acceleration in m/s2 of a step: left, then right."""
    return 0.002 * step - 0.02, 2.0


def inputs(step: int, tick: int) -> TickInputs:
    wheel, accel = commanded(step)
    command = NO_COMMAND._replace(
        kind=float(RemoteKind.ACCELERATION),
        sequence=1.0 + step,
        age_ticks=float(tick),
        road_wheel_rad=wheel,
        accel_mps2=accel,
    )
    asks = step < STEPS // 2 and tick == 0
    return TickInputs(NO_SAMPLE, command, EventInput(float(Event.REQUEST_AUTONOMOUS)) if asks else NO_EVENTS)


@pytest.fixture(scope="module")
def one_by_one() -> list[tuple[np.ndarray, np.ndarray, np.ndarray, bool]]:
    """Return what each step leaves: the state vector, the place, what is seen, and whether automation drives."""
    console, place, left = console_of(compiled, kernel=True), place_at(PATH, 0.0), []
    vector = console.initial
    for step in range(STEPS):
        for tick in range(TICKS):
            vector = advance_vector(vector, input_vector(inputs(step, tick)), console)
        seen = np.zeros(len(LaneView._fields), np.float32)
        driving = lane_view(PATH, vector, place, seen)
        left.append((vector, place.copy(), seen, driving))
    return left


@pytest.mark.parametrize(
    ("execution", "kernel"), [(compiled, True), (compiled, False), (plain, True)], ids=["compiled", "own", "plain"]
)
def test_a_step_is_its_ticks_and_a_look(
    execution: Execution, kernel: bool, one_by_one: list[tuple[np.ndarray, np.ndarray, np.ndarray, bool]]
) -> None:
    console, place = console_of(execution, kernel=kernel), place_at(PATH, 0.0)
    rows = np.zeros((1 + TICKS, console.width))
    advance = learner_step(console, rows, RemoteKind.ACCELERATION, PATH, place, execution)
    for _ in range(2):  # what it holds is written to begin anew
        rows[0], place[:] = console.initial, place_at(PATH, 0.0)
        for step, (vector, place_then, seen_then, driving) in enumerate(one_by_one):
            for tick in range(TICKS):
                told = inputs(step, tick)
                nobody = told._replace(ros=NO_COMMAND._replace(age_ticks=told.ros.age_ticks))
                rows[1 + tick, :INPUT_WIDTH] = input_vector(nobody)
            seen = np.zeros(len(LaneView._fields), np.float32)
            assert advance(*commanded(step), seen) is driving
            assert not difference(rows[0], vector, console.columns)
            assert not difference(place, place_then)
            assert not difference(seen, seen_then, LaneView._fields)
    assert Snapshot(STEPS * TICKS, HZ, rows[0]).vehicle.vx_mps > 0.1
    assert [driving for *_, driving in one_by_one].count(True) > STEPS // 2
