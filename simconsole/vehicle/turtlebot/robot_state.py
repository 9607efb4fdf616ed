"""What a robot's kernel reads and writes: its own columns, and what stays constant over a drive."""

from typing import Final, NamedTuple

from simconsole.values.kernels import Row
from simconsole.values.layout import Part
from simconsole.values.state_vector import OTHER, PLATFORM_AT

STEP_S: Final = 0.001


class ScanKnot(NamedTuple):
    """Pose and speeds at one end of a turn of the lidar, in map."""

    x_m: float
    y_m: float
    yaw_rad: float
    vx_map_mps: float
    vy_map_mps: float
    yaw_rate_radps: float


class Odometry(NamedTuple):
    """What the robot makes of its wheel encoders: pose in odom, which begins at 0, and speeds over the last tick."""

    x_m: float
    y_m: float
    yaw_rad: float
    speed_mps: float
    yaw_rate_radps: float


class Motion(NamedTuple):
    """How the robot moves. The pose is that of base_footprint, between the wheels, in map."""

    x_m: float
    y_m: float
    yaw_rad: float
    left_radps: float  # of the wheels
    right_radps: float
    vx_map_mps: float  # what is left of the wheels' motion after contact
    vy_map_mps: float
    yaw_rate_radps: float
    distance_m: float
    bumper: float  # 0: touches nothing, 1: with its front half, 2: with its rear half
    collisions: float  # since the start: how often a contact has begun


class Gauges(NamedTuple):
    """What the robot carries with it."""

    ax_map_mps2: float  # over the last tick
    ay_map_mps2: float
    left_rad: float  # of the wheel encoders, unwrapped
    right_rad: float
    slip_seed: float  # of the next number drawn
    used_j: float  # energy from the battery
    scan_ms: float  # since the last turn of the lidar ended
    scans: float  # turns since the start


class RobotState(NamedTuple):
    """State after a tick."""

    motion: Motion
    gauges: Gauges
    odometry: Odometry
    scan_from: ScanKnot  # of the last whole turn of the lidar
    scan_to: ScanKnot


class RobotParameters(NamedTuple):
    """What stays constant over a drive, in SI; behind them in the row lie the obstacles."""

    wheel_radius_m: float
    separation_m: float
    max_wheel_radps: float
    max_speed_mps: float
    max_yaw_rate_radps: float
    accel_mps2: float  # at the rim of a wheel
    brake_mps2: float
    max_road_wheel_rad: float
    body_x_m: float  # middle of the round body, ahead of base_footprint
    body_radius_m: float
    distance_scale: float  # odometry's figure over the true one
    turn_scale: float
    slip_m_per_root_m: float
    idle_w: float
    drive_w: float  # at full speed, beside `idle_w`
    scan_ms: float
    others: float  # other robots, at the end of the state vector
    segments: float  # straight obstacles, each x, y of both ends
    circles: float  # round ones, each x, y, radius


ROBOT: Final = Part(RobotState, PLATFORM_AT)
OTHERS_AT: Final = ROBOT.stop
"""Where the other robots begin in the state vector, each x, y and radius of its body in map."""
PARAMETERS: Final = Part(RobotParameters)
OBSTACLES_AT: Final = PARAMETERS.stop


def others_of(vector: Row) -> Row:
    """Return the session's other robots as this one was told of them: [N, 3], x, y and radius of the body in m."""
    return vector[OTHERS_AT:].reshape(-1, len(OTHER))
