"""One tick of the ball: it rolls to the desired pose with at most the desired speed, or as a person pushes it.

With a target speed above 0 it follows the target; otherwise the person's pedals and wheel push, brake and turn it, and
released it coasts to rest. The brake always works. A ball that rolls without slipping carries 2/7 of its energy in its
spin, so a slope moves it with 5/7 of gravity.
"""

from collections.abc import Callable
from math import sqrt
from typing import Final, NamedTuple

from simconsole.values.ground import GROUND, NODES_AT
from simconsole.values.height_field import spot_at
from simconsole.values.kernels import Row, approach, clip, is_finite, kernel, stage
from simconsole.values.layout import Part, read, write
from simconsole.values.platform import Step
from simconsole.values.signals import VehicleCommand, VehicleState
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.values.trigonometry import atan2, cos, sin, wrap_angle
from simconsole.values.units import STANDARD_GRAVITY_MPS2

STEP_S: Final = 0.001
ROLLING_SHARE: Final = 5.0 / 7.0
"""Acceleration of a solid sphere rolling down a slope, as a share of a sliding body's (inertia 2/5 m r2)."""

ROLLING_MPS: Final = 0.05
"""Below this speed the heading stays as it is: the direction of hardly any motion means nothing."""


class BallState(NamedTuple):
    """State after a step of 1 ms, in map; the height follows the ground."""

    x_m: float
    y_m: float
    yaw_rad: float
    vx_map_mps: float
    vy_map_mps: float
    yaw_rate_radps: float
    rolled_rad: float  # about its left axis, unwrapped
    ax_map_mps2: float
    ay_map_mps2: float
    distance_m: float


class BallParameters(NamedTuple):
    """What stays constant over a drive, in SI."""

    radius_m: float
    max_accel_mps2: float
    brake_mps2: float
    rolling_mps2: float
    approach_s: float
    turn_per_s: float
    max_road_wheel_rad: float


class BallGround(NamedTuple):
    """The ground under the ball: its height, what it can push off and brake with, and where it pulls."""

    height_m: float
    max_accel_mps2: float
    brake_mps2: float
    gravity_x_mps2: float
    gravity_y_mps2: float


BallGroundModel = Callable[[float, float, BallParameters, Row], BallGround]
"""A kernel that returns the ground under a place in map: `on_plane` or `on_field`."""

BALL: Final = Part(BallState, PLATFORM_AT)
PARAMETERS: Final = Part(BallParameters)


class Velocity(NamedTuple):
    """A velocity in map."""

    x_mps: float
    y_mps: float


def make_step(ground_of: BallGroundModel) -> Step:
    """Return the kernel that advances the ball by one tick on such ground: the interface of values/platform.py."""

    @stage
    def step(previous: Row, row: Row, parameters: Row, ground: Row, substeps: int) -> None:
        p = read(parameters, PARAMETERS)
        command = read(row, LAYOUT.command)
        state = read(previous, BALL)
        brake = command.brake if is_finite(command.brake) else 0.0
        following = is_finite(command.target_speed_mps) and command.target_speed_mps > 0.0
        following = following and is_finite(command.target_x_m) and is_finite(command.target_y_m)
        for _ in range(substeps):
            on = ground_of(state.x_m, state.y_m, p, ground)
            state = follow(state, p, on, command, brake) if following else pushed(state, p, on, command, brake)
        write(row, BALL, state)
        on = ground_of(state.x_m, state.y_m, p, ground)
        write(row, LAYOUT.vehicle, vehicle_state(state, p, on, command.road_wheel_rad))

    return step


@kernel
def on_plane(x_m: float, y_m: float, p: BallParameters, ground: Row) -> BallGround:
    """Return the ground of a plane, on which it needs little friction: it limits acceleration and brake."""
    plane = read(ground, GROUND.plane)
    gravity = plane.gravity_mps2
    grip = plane.friction * gravity
    return BallGround(
        height_m=plane.slope_x * x_m + plane.slope_y * y_m,
        max_accel_mps2=grip if grip < p.max_accel_mps2 else p.max_accel_mps2,
        brake_mps2=grip if grip < p.brake_mps2 else p.brake_mps2,
        gravity_x_mps2=-ROLLING_SHARE * gravity * plane.slope_x,
        gravity_y_mps2=-ROLLING_SHARE * gravity * plane.slope_y,
    )


@kernel
def on_field(x_m: float, y_m: float, p: BallParameters, ground: Row) -> BallGround:
    """Return the ground of a field of heights."""
    plane = read(ground, GROUND.plane)
    spot = spot_at(ground, NODES_AT, read(ground, GROUND.grid), x_m, y_m)
    slope_x, slope_y = plane.slope_x + spot.slope_x, plane.slope_y + spot.slope_y
    # In map's own directions: of the pull along the ground the level part moves the ball over the map.
    level = 1.0 / (1.0 + slope_x * slope_x + slope_y * slope_y)
    grip = plane.friction * spot.friction_share * STANDARD_GRAVITY_MPS2 * sqrt(level)
    return BallGround(
        height_m=spot.height_m + plane.slope_x * x_m + plane.slope_y * y_m,
        max_accel_mps2=grip if grip < p.max_accel_mps2 else p.max_accel_mps2,
        brake_mps2=grip if grip < p.brake_mps2 else p.brake_mps2,
        gravity_x_mps2=-ROLLING_SHARE * STANDARD_GRAVITY_MPS2 * level * slope_x,
        gravity_y_mps2=-ROLLING_SHARE * STANDARD_GRAVITY_MPS2 * level * slope_y,
    )


@kernel
def towards(from_x: float, from_y: float, to_x: float, to_y: float, most: float) -> Velocity:
    """Return the vector moved towards another by at most `most`."""
    x = to_x - from_x
    y = to_y - from_y
    length = sqrt(x * x + y * y)
    if length <= most:
        return Velocity(to_x, to_y)
    return Velocity(from_x + x * (most / length), from_y + y * (most / length))


@kernel
def desired(s: BallState, p: BallParameters, on: BallGround, command: VehicleCommand, brake: float) -> Velocity:
    """Return the velocity wanted now: the desired speed, less near the target so that the ball can stop there.

    sqrt(a * d) needs half of the deceleration a over the distance d, which leaves room to be late; the last part of
    the way is exponential with `approach_s`.
    """
    x = command.target_x_m - s.x_m
    y = command.target_y_m - s.y_m
    left = sqrt(x * x + y * y)
    if left == 0.0:
        return Velocity(0.0, 0.0)
    speed = command.target_speed_mps * (1.0 - brake)
    stopping = sqrt(on.max_accel_mps2 * left)
    arriving = left / p.approach_s
    if stopping < speed:
        speed = stopping
    if arriving < speed:
        speed = arriving
    return Velocity(x * (speed / left), y * (speed / left))


@kernel
def follow(s: BallState, p: BallParameters, on: BallGround, command: VehicleCommand, brake: float) -> BallState:
    """Return the ball 1 ms later, driven towards its target; its heading turns to the direction of motion."""
    wanted = desired(s, p, on, command, brake)
    most = STEP_S * (on.max_accel_mps2 + brake * on.brake_mps2)
    v = towards(
        s.vx_map_mps + STEP_S * on.gravity_x_mps2,
        s.vy_map_mps + STEP_S * on.gravity_y_mps2,
        wanted.x_mps,
        wanted.y_mps,
        most,
    )
    turn = 0.0
    if v.x_mps * v.x_mps + v.y_mps * v.y_mps > ROLLING_MPS * ROLLING_MPS:
        ahead = wrap_angle(atan2(v.y_mps, v.x_mps) - s.yaw_rad)
        turn = approach(0.0, ahead, STEP_S * p.turn_per_s)
    return rolled(s, p, v, turn)


@kernel
def pushed(s: BallState, p: BallParameters, on: BallGround, command: VehicleCommand, brake: float) -> BallState:
    """Return the ball 1 ms later under the person: throttle pushes along the heading, the wheel turns it."""
    throttle = command.throttle if is_finite(command.throttle) else 0.0
    angle = command.road_wheel_rad if is_finite(command.road_wheel_rad) else 0.0
    turn = STEP_S * p.turn_per_s * clip(angle, -p.max_road_wheel_rad, p.max_road_wheel_rad)
    way = -1.0 if command.gear < 0.0 else 1.0
    push = STEP_S * way * throttle * on.max_accel_mps2
    c = cos(turn)
    d = sin(turn)
    # Turning rotates the velocity, too: a ball has no side grip that could do so.
    x = s.vx_map_mps * c - s.vy_map_mps * d + STEP_S * on.gravity_x_mps2 + push * cos(s.yaw_rad)
    y = s.vx_map_mps * d + s.vy_map_mps * c + STEP_S * on.gravity_y_mps2 + push * sin(s.yaw_rad)
    return rolled(s, p, towards(x, y, 0.0, 0.0, STEP_S * (p.rolling_mps2 + brake * on.brake_mps2)), turn)


@kernel
def rolled(s: BallState, p: BallParameters, v: Velocity, turn: float) -> BallState:
    """Return the state after rolling 1 ms with velocity `v` and turning by `turn`."""
    along = v.x_mps * cos(s.yaw_rad) + v.y_mps * sin(s.yaw_rad)
    return BallState(
        x_m=s.x_m + STEP_S * v.x_mps,
        y_m=s.y_m + STEP_S * v.y_mps,
        yaw_rad=wrap_angle(s.yaw_rad + turn),
        vx_map_mps=v.x_mps,
        vy_map_mps=v.y_mps,
        yaw_rate_radps=turn / STEP_S,
        rolled_rad=s.rolled_rad + STEP_S * along / p.radius_m,
        ax_map_mps2=(v.x_mps - s.vx_map_mps) / STEP_S,
        ay_map_mps2=(v.y_mps - s.vy_map_mps) / STEP_S,
        distance_m=s.distance_m + STEP_S * sqrt(v.x_mps * v.x_mps + v.y_mps * v.y_mps),
    )


@kernel
def vehicle_state(s: BallState, p: BallParameters, on: BallGround, road_wheel_rad: float) -> VehicleState:
    """Return the ball as others see it: its centre, and its spin as pitch."""
    c = cos(s.yaw_rad)
    d = sin(s.yaw_rad)
    vx = s.vx_map_mps * c + s.vy_map_mps * d
    slope = on.gravity_x_mps2 * c + on.gravity_y_mps2 * d
    coast = slope - p.rolling_mps2 * vx / (abs(vx) + ROLLING_MPS)
    angle = clip(road_wheel_rad, -p.max_road_wheel_rad, p.max_road_wheel_rad) if is_finite(road_wheel_rad) else 0.0
    return VehicleState(
        x_m=s.x_m,
        y_m=s.y_m,
        z_m=on.height_m + p.radius_m,
        yaw_rad=s.yaw_rad,
        pitch_rad=wrap_angle(s.rolled_rad),
        roll_rad=0.0,
        vx_mps=vx,
        vy_mps=s.vy_map_mps * c - s.vx_map_mps * d,
        yaw_rate_radps=s.yaw_rate_radps,
        ax_mps2=s.ax_map_mps2 * c + s.ay_map_mps2 * d,
        ay_mps2=s.ay_map_mps2 * c - s.ax_map_mps2 * d,
        road_wheel_rad=angle,
        hand_wheel_torque_nm=0.0,
        engine_radps=0.0,
        engine_running=1.0,
        gear=1.0,
        clutch=0.0,
        distance_m=s.distance_m,
        coast_accel_mps2=coast,
        full_throttle_accel_mps2=coast + on.max_accel_mps2,
        full_brake_accel_mps2=coast - on.brake_mps2,
        gear_fault=0.0,
    )


step: Final = make_step(on_plane)
"""The step of a ball on a plane."""

field_step: Final = make_step(on_field)
"""The same on a field of heights."""
