"""A short made-up drive with one of everything that the scene shows."""

import numpy as np
from numpy.typing import ArrayLike

from simconsole.profiles.view import SceneProfile
from simconsole.scene.entities import Dimensions
from simconsole.scene.timeline import ShownVehicle
from simconsole.scene.viewer.job import Job
from simconsole.scene.wheel_shapes import ShownWheel
from simconsole.values.platform import Pose
from simconsole.values.signals import Event, Mode, Reason
from simconsole.values.state_vector import columns
from simconsole.vehicle.car.state import CarState
from simconsole.world.drawing import Drawing
from simconsole.world.drawing_layers import Light
from simconsole.world.path_geometry import Piece
from simconsole.world.route import Route, Stretch

COLUMNS = columns(CarState)
TICK_HZ = 250
RADIUS_M = 50.0
CHANGES = (  # from tick, mode, reason
    (1, Mode.PARKED, Reason.START),
    (300, Mode.MANUAL, Reason.PERSON_ASKED),
    (1003, Mode.AUTONOMOUS, Reason.PERSON_ASKED),
    (2001, Mode.TAKEOVER_REQUESTED, Reason.COMMAND_STALE),
    (2503, Mode.MANUAL, Reason.STEERING_OVERRIDE),
)


def rows(count: int) -> np.ndarray:
    """Return `count` ticks from tick 1: parked, then driven round a circle of 50 m at up to 10 m/s."""
    tick = np.arange(1, count + 1)
    table = np.zeros((count, len(COLUMNS)))

    def put(name: str, values: ArrayLike) -> None:
        table[:, COLUMNS.index(name)] = values

    speed = np.clip((tick - 300) / TICK_HZ * 2.0, 0.0, 10.0)
    angle = np.cumsum(speed) / TICK_HZ / 50.0
    put("vehicle.x_m", 50.0 * np.sin(angle))
    put("vehicle.y_m", 50.0 * (1.0 - np.cos(angle)))
    put("vehicle.yaw_rad", angle)
    put("vehicle.vx_mps", speed)
    put("vehicle.road_wheel_rad", 0.05)
    put("vehicle.engine_radps", 200.0)
    put("vehicle.gear", np.where(tick < 300, 0.0, np.where(tick < 900, 1.0, 2.0)))
    put("command.throttle", 0.25)
    for start, mode, reason in CHANGES:
        table[start - 1 :, COLUMNS.index("arbitration.mode")] = mode
        table[start - 1 :, COLUMNS.index("arbitration.reason")] = reason
    put("arbitration.takeover_stage", (tick >= 2001) * 1.0 - (tick >= 2503))
    put("arbitration.remote_lateral", (tick >= 1003) * 1.0 - (tick >= 2503))
    put("arbitration.refusal", np.where((tick >= 800) & (tick < 950), float(Reason.REFUSED_BRAKE_PRESSED), 0.0))
    put("events.events", np.where(tick == 1501, float(Event.MARK | Event.REQUEST_MANUAL), 0.0))
    return table


def route() -> Route:
    """Return the middle of the round road, once round to the left."""
    length_m = 2.0 * np.pi * RADIUS_M
    return Route(
        [Stretch(0.0, Pose(0.0, 0.0, 0.0), Piece(length_m, 1.0 / RADIUS_M, 1.0 / RADIUS_M), 13.9)], closed=True
    )


def drawing() -> Drawing:
    """Return a round road."""
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    rim = np.column_stack((np.sin(angle), 1.0 - np.cos(angle)))
    path = 50.0 * rim
    square = np.array(((0.0, -2.0), (3.0, -2.0), (3.0, 2.0), (0.0, 2.0)))
    inside, outside = (np.add(radius * rim, (0.0, 50.0 - radius)) for radius in (48.0, 55.0))
    return Drawing((square,), (), (inside, outside), (path,), (square + 3.0,), (), (Light(5.0, -3.0, 0.0),), path)


WHEELS = tuple(
    ShownWheel(x_m, y_m, 0.31, 3400.0, 2.1e5, stiffness_x_per_m=260.0, stiffness_y_per_m=190.0, friction=1.05)
    for x_m in (2.5, 0.0)
    for y_m in (0.75, -0.75)
)


def job(kind: str = "car") -> Job:
    """Return the drive's scene job: of a car on the round road, or of a ball on nothing."""
    if kind == "ball":
        return Job(COLUMNS, TICK_HZ, Dimensions(1.0, 1.0, 1.0, 0.5), drawing=None, profile=SceneProfile())
    return Job(
        columns=COLUMNS,
        tick_hz=TICK_HZ,
        dimensions=Dimensions(4.2, 1.8, 1.5, 0.8),
        drawing=drawing(),
        profile=SceneProfile(),
        vehicle=ShownVehicle(wheelbase_m=2.5, wheels=(WHEELS[0], WHEELS[1], WHEELS[2], WHEELS[3])),
        route=route(),
    )
