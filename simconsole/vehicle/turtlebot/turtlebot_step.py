"""One tick of a robot with two driven wheels: it follows a commanded speed and yaw rate, and turns in place.

A person in the seat commands both, too: the pedal gives the speed, the wheel the yaw rate. The brake always works.
Contact stops the body, not the wheels: they slip on the floor, and odometry counts on.
"""

from math import sqrt
from typing import Final, NamedTuple

from simconsole.values.kernels import Row, approach, clip, is_finite, kernel, stage
from simconsole.values.layout import read, write
from simconsole.values.signals import VehicleCommand, VehicleState
from simconsole.values.state_vector import LAYOUT
from simconsole.values.trigonometry import cos, sin, wrap_angle
from simconsole.vehicle.turtlebot.contact import pushed_out
from simconsole.vehicle.turtlebot.robot_state import (
    PARAMETERS,
    ROBOT,
    STEP_S,
    Gauges,
    Motion,
    Odometry,
    RobotParameters,
    RobotState,
    ScanKnot,
)

_FRONT, _REAR = 1.0, 2.0
_STANDING_MPS: Final = 0.01
# The generator of Park and Miller (CACM 1988): its products are below 2^46, so floats hold them exactly.
_MULTIPLIER: Final = 16807.0
_MODULUS: Final = 2147483647.0
_ROOT_3: Final = 1.7320508075688772


class Wheels(NamedTuple):
    """Speeds of both wheels."""

    left_radps: float
    right_radps: float


class Drawn(NamedTuple):
    """A number of mean 0 and standard deviation 1, and the seed of the next one."""

    value: float
    seed: float


@stage
def step(previous: Row, row: Row, parameters: Row, ground: Row, substeps: int) -> None:
    """Advance the robot by one tick: the platform interface of values/platform.py. Its floor is level."""
    p = read(parameters, PARAMETERS)
    command = read(row, LAYOUT.command)
    before = read(previous, ROBOT)
    brake = command.brake if is_finite(command.brake) else 0.0
    wanted = wanted_wheels(p, command, brake)
    most = STEP_S * (p.accel_mps2 + brake * p.brake_mps2) / p.wheel_radius_m
    motion = before.motion
    left_rad = 0.0
    right_rad = 0.0
    for _ in range(substeps):
        motion = moved(motion, wanted, most, p, parameters, row)
        left_rad += STEP_S * motion.left_radps
        right_rad += STEP_S * motion.right_radps
    state = measured(before, motion, left_rad, right_rad, p, substeps)
    write(row, ROBOT, state)
    write(row, LAYOUT.vehicle, vehicle_state(state, p, command.road_wheel_rad))


@kernel
def wanted_wheels(p: RobotParameters, command: VehicleCommand, brake: float) -> Wheels:
    """Return the wheel speeds that are asked for, each limited by itself as the motors' controller does."""
    throttle = command.throttle if is_finite(command.throttle) else 0.0
    steering = command.road_wheel_rad if is_finite(command.road_wheel_rad) else 0.0
    speed = command.target_speed_mps if is_finite(command.target_speed_mps) else 0.0
    turn = command.target_yaw_rate_radps if is_finite(command.target_yaw_rate_radps) else 0.0
    way = -1.0 if command.gear < 0.0 else 1.0
    share = 1.0 - brake
    speed = share * clip(speed + way * throttle * p.max_speed_mps, -p.max_speed_mps, p.max_speed_mps)
    turn += steering / p.max_road_wheel_rad * p.max_yaw_rate_radps
    turn = share * clip(turn, -p.max_yaw_rate_radps, p.max_yaw_rate_radps)
    apart = 0.5 * turn * p.separation_m
    return Wheels(
        left_radps=clip((speed - apart) / p.wheel_radius_m, -p.max_wheel_radps, p.max_wheel_radps),
        right_radps=clip((speed + apart) / p.wheel_radius_m, -p.max_wheel_radps, p.max_wheel_radps),
    )


@kernel
def moved(s: Motion, wanted: Wheels, most_radps: float, p: RobotParameters, parameters: Row, row: Row) -> Motion:
    """Return the motion 1 ms later; the speed of each wheel changes by at most `most_radps`.

    What stands is in `parameters`, where the other robots are in `row`.
    """
    left = approach(s.left_radps, wanted.left_radps, most_radps)
    right = approach(s.right_radps, wanted.right_radps, most_radps)
    speed = 0.5 * (left + right) * p.wheel_radius_m
    turn = (right - left) * p.wheel_radius_m / p.separation_m
    middle = s.yaw_rad + 0.5 * STEP_S * turn
    yaw = wrap_angle(s.yaw_rad + STEP_S * turn)
    c = cos(yaw)
    d = sin(yaw)
    x = s.x_m + STEP_S * speed * cos(middle)
    y = s.y_m + STEP_S * speed * sin(middle)
    out = pushed_out(
        x + p.body_x_m * c,
        y + p.body_x_m * d,
        p.body_radius_m,
        parameters,
        int(p.segments),
        int(p.circles),
        row,
        int(p.others),
    )
    x += out.push_x_m
    y += out.push_y_m
    bumper = 0.0
    if out.push_x_m != 0.0 or out.push_y_m != 0.0:
        bumper = _FRONT if out.push_x_m * c + out.push_y_m * d <= 0.0 else _REAR
    way_x = x - s.x_m
    way_y = y - s.y_m
    return Motion(
        x_m=x,
        y_m=y,
        yaw_rad=yaw,
        left_radps=left,
        right_radps=right,
        vx_map_mps=way_x / STEP_S,
        vy_map_mps=way_y / STEP_S,
        yaw_rate_radps=turn,
        distance_m=s.distance_m + sqrt(way_x * way_x + way_y * way_y),
        bumper=bumper,
        collisions=s.collisions + (1.0 if bumper > 0.0 and s.bumper == 0.0 else 0.0),
    )


@kernel
def measured(
    before: RobotState, motion: Motion, left_rad: float, right_rad: float, p: RobotParameters, substeps: int
) -> RobotState:
    """Return the state after a tick in which the wheels turned so far: with encoders, odometry, battery and lidar."""
    tick_s = STEP_S * substeps
    gauges = before.gauges
    left = slipped(left_rad, gauges.slip_seed, p)
    right = slipped(right_rad, left.seed, p)
    power_w = p.idle_w + p.drive_w * 0.5 * (abs(motion.left_radps) + abs(motion.right_radps)) / p.max_wheel_radps
    scan_ms = gauges.scan_ms + substeps
    turned = scan_ms >= p.scan_ms
    knot = ScanKnot(
        x_m=motion.x_m,
        y_m=motion.y_m,
        yaw_rad=motion.yaw_rad,
        vx_map_mps=motion.vx_map_mps,
        vy_map_mps=motion.vy_map_mps,
        yaw_rate_radps=motion.yaw_rate_radps,
    )
    return RobotState(
        motion=motion,
        gauges=Gauges(
            ax_map_mps2=(motion.vx_map_mps - before.motion.vx_map_mps) / tick_s,
            ay_map_mps2=(motion.vy_map_mps - before.motion.vy_map_mps) / tick_s,
            left_rad=gauges.left_rad + left.value,
            right_rad=gauges.right_rad + right.value,
            slip_seed=right.seed,
            used_j=gauges.used_j + power_w * tick_s,
            scan_ms=0.0 if turned else scan_ms,
            scans=gauges.scans + (1.0 if turned else 0.0),
        ),
        odometry=integrated(before.odometry, left.value, right.value, p, tick_s),
        scan_from=before.scan_to if turned else before.scan_from,
        scan_to=knot if turned else before.scan_to,
    )


@kernel
def slipped(turned_rad: float, seed: float, p: RobotParameters) -> Drawn:
    """Return what a wheel's encoder counts for the way that the wheel rolled, with its slip, and the next seed.

    The slip of each bit of way is independent: its variance grows with the way.
    """
    if p.slip_m_per_root_m == 0.0 or turned_rad == 0.0:
        return Drawn(turned_rad, seed)
    drawn = normal(seed)
    slip_m = p.slip_m_per_root_m * sqrt(abs(turned_rad) * p.wheel_radius_m) * drawn.value
    return Drawn(turned_rad + slip_m / p.wheel_radius_m, drawn.seed)


@kernel
def normal(seed: float) -> Drawn:
    """Return the sum of four even numbers, scaled: nearly normal, at most 3.5 standard deviations."""
    total = 0.0
    for _ in range(4):
        product = seed * _MULTIPLIER
        seed = product - _MODULUS * float(int(product / _MODULUS))
        if seed < 0.0:  # the quotient was rounded up to a whole number
            seed += _MODULUS
        total += seed / _MODULUS
    return Drawn(_ROOT_3 * (total - 2.0), seed)


@kernel
def integrated(odometry: Odometry, left_rad: float, right_rad: float, p: RobotParameters, tick_s: float) -> Odometry:
    """Return the odometry after the wheels have turned: it takes wheel radius and separation for what they are not."""
    along = 0.5 * (left_rad + right_rad) * p.wheel_radius_m * p.distance_scale
    turn = (right_rad - left_rad) * p.wheel_radius_m / p.separation_m * p.turn_scale
    middle = odometry.yaw_rad + 0.5 * turn
    return Odometry(
        x_m=odometry.x_m + along * cos(middle),
        y_m=odometry.y_m + along * sin(middle),
        yaw_rad=wrap_angle(odometry.yaw_rad + turn),
        speed_mps=along / tick_s,
        yaw_rate_radps=turn / tick_s,
    )


@kernel
def vehicle_state(state: RobotState, p: RobotParameters, road_wheel_rad: float) -> VehicleState:
    """Return the robot as others see it."""
    s = state.motion
    gauges = state.gauges
    c = cos(s.yaw_rad)
    d = sin(s.yaw_rad)
    vx = s.vx_map_mps * c + s.vy_map_mps * d
    coast = -p.accel_mps2 * vx / (abs(vx) + _STANDING_MPS)
    angle = clip(road_wheel_rad, -p.max_road_wheel_rad, p.max_road_wheel_rad) if is_finite(road_wheel_rad) else 0.0
    return VehicleState(
        x_m=s.x_m,
        y_m=s.y_m,
        z_m=0.0,
        yaw_rad=s.yaw_rad,
        pitch_rad=0.0,
        roll_rad=0.0,
        vx_mps=vx,
        vy_mps=s.vy_map_mps * c - s.vx_map_mps * d,
        yaw_rate_radps=s.yaw_rate_radps,
        ax_mps2=gauges.ax_map_mps2 * c + gauges.ay_map_mps2 * d,
        ay_mps2=gauges.ay_map_mps2 * c - gauges.ax_map_mps2 * d,
        road_wheel_rad=angle,
        hand_wheel_torque_nm=0.0,
        engine_radps=0.0,
        engine_running=1.0,
        gear=1.0,
        clutch=0.0,
        distance_m=s.distance_m,
        coast_accel_mps2=coast,
        full_throttle_accel_mps2=p.accel_mps2,
        full_brake_accel_mps2=coast - p.brake_mps2,
        gear_fault=0.0,
    )
