"""What the car stands on: friction under each wheel, and how the ground lies and moves under it.

A car on a field is on the plane through its four contacts: lean, lifts and speeds are measured against that plane.
Rates (`heave_mps`, `roll_radps`, `pitch_radps`, `lift_mps`) are the body's and the wheels' own: what the plane does as
the car travels is taken from them where they move something, so that a crest takes load off the tyres and a kerb pushes
a wheel, not the car. A step is made for a plane or a field, as it is for its tyre: on a plane all of that is 0 and
compiles to nothing.
"""

from math import sqrt
from typing import NamedTuple

from simconsole.values.ground import GROUND, LEAST_FRICTION, NODES_AT, Patch, Plane
from simconsole.values.height_field import Grid, Spot, spot_at
from simconsole.values.kernels import Row, kernel
from simconsole.values.layout import read
from simconsole.values.trigonometry import Direction, direction
from simconsole.values.units import STANDARD_GRAVITY_MPS2
from simconsole.vehicle.car.parameters import AxleParameters, CarParameters
from simconsole.vehicle.car.state import BodyState, Car


class Grips(NamedTuple):
    """Friction of tyre and ground together under each wheel, at static load. Looked up once a tick: 8 cm at 20 m/s."""

    fl: float
    fr: float
    rl: float
    rr: float


class AxleGround(NamedTuple):
    """The ground under the wheels of one axle: above the plane under the car, and how fast it rises there."""

    left_m: float
    right_m: float
    left_mps: float  # of the ground under the wheel, the plane's own motion included
    right_mps: float
    left_up_mps: float  # of the plane alone
    right_up_mps: float


class Lie(NamedTuple):
    """How the ground lies under the car."""

    height_m: float  # of base_link
    slope_x: float  # of the plane under the car, along x and y of map
    slope_y: float
    gravity_mps2: float  # gravity / sqrt(1 + slope^2)
    pressing_mps2: float  # by how much more than standing on the level the car presses on the ground
    ahead_share: float  # way in map per way along the plane, ahead and to the side
    aside_share: float
    cg_up_mps: float  # the plane under the centre of gravity
    left_up_radps: float
    nose_down_radps: float
    front: AxleGround
    rear: AxleGround


@kernel
def on_patch(patch: Patch, x_m: float, y_m: float, share: float) -> float:
    """Return the share of friction at a place, `share` where the patch is not."""
    if patch.from_x_m <= x_m and x_m <= patch.to_x_m and patch.from_y_m <= y_m and y_m <= patch.to_y_m:
        return patch.share if patch.share > LEAST_FRICTION else LEAST_FRICTION
    return share


@kernel
def share_at(ground: Row, x_m: float, y_m: float) -> float:
    """Return the share of the ground's friction at a place in map: that of the last patch there."""
    share = on_patch(read(ground, GROUND.patch_1), x_m, y_m, 1.0)
    share = on_patch(read(ground, GROUND.patch_2), x_m, y_m, share)
    share = on_patch(read(ground, GROUND.patch_3), x_m, y_m, share)
    return on_patch(read(ground, GROUND.patch_4), x_m, y_m, share)


@kernel
def on_base(p: CarParameters, plane: Plane) -> Grips:
    """Return the friction under each wheel where there is neither patch nor verge."""
    front = p.front.friction * plane.friction
    rear = p.rear.friction * plane.friction
    return Grips(front, front * plane.right_share, rear, rear * plane.right_share)


@kernel
def plane_grips(car: Car, p: CarParameters, ground: Row) -> Grips:
    """Return the friction under each wheel on a plane."""
    base = on_base(p, read(ground, GROUND.plane))
    first = read(ground, GROUND.patch_1)
    return _on_patches(car, p, ground, base) if first.from_x_m <= first.to_x_m else base


@kernel
def field_grips(car: Car, p: CarParameters, ground: Row) -> Grips:
    """Return the friction under each wheel on a field: less beside the road."""
    base = plane_grips(car, p, ground)
    grid = read(ground, GROUND.grid)
    body = car.body
    ahead = direction(body.yaw_rad)
    front_m = p.front.ahead_m - p.rear.ahead_m
    return Grips(
        base.fl * _at(ground, grid, body, ahead, front_m, p.front.half_track_m).friction_share,
        base.fr * _at(ground, grid, body, ahead, front_m, -p.front.half_track_m).friction_share,
        base.rl * _at(ground, grid, body, ahead, 0.0, p.rear.half_track_m).friction_share,
        base.rr * _at(ground, grid, body, ahead, 0.0, -p.rear.half_track_m).friction_share,
    )


@kernel
def _on_patches(car: Car, p: CarParameters, ground: Row, base: Grips) -> Grips:
    body = car.body
    ahead = direction(body.yaw_rad)
    rear = p.rear.half_track_m
    front = p.front.half_track_m
    x = body.x_m + (p.front.ahead_m - p.rear.ahead_m) * ahead.cos
    y = body.y_m + (p.front.ahead_m - p.rear.ahead_m) * ahead.sin
    return Grips(
        base.fl * share_at(ground, x - front * ahead.sin, y + front * ahead.cos),
        base.fr * share_at(ground, x + front * ahead.sin, y - front * ahead.cos),
        base.rl * share_at(ground, body.x_m - rear * ahead.sin, body.y_m + rear * ahead.cos),
        base.rr * share_at(ground, body.x_m + rear * ahead.sin, body.y_m - rear * ahead.cos),
    )


@kernel
def _axle_ground(twist_m: float, left_mps: float, right_mps: float, up_mps: float, turned_mps: float) -> AxleGround:
    return AxleGround(
        left_m=twist_m,
        right_m=0.0 - twist_m,
        left_mps=left_mps,
        right_mps=right_mps,
        left_up_mps=up_mps + turned_mps,
        right_up_mps=up_mps - turned_mps,
    )


@kernel
def on_plane(car: Car, p: CarParameters, ground: Row) -> Lie:
    """Return how a plane lies: everywhere the same, and at rest."""
    plane = read(ground, GROUND.plane)
    return Lie(
        height_m=plane.rise_x * car.body.x_m + plane.rise_y * car.body.y_m,
        slope_x=plane.slope_x,
        slope_y=plane.slope_y,
        gravity_mps2=plane.gravity_mps2,
        pressing_mps2=plane.gravity_mps2 - STANDARD_GRAVITY_MPS2,
        ahead_share=1.0,
        aside_share=1.0,
        cg_up_mps=0.0,
        left_up_radps=0.0,
        nose_down_radps=0.0,
        front=_axle_ground(0.0, 0.0, 0.0, 0.0, 0.0),
        rear=_axle_ground(0.0, 0.0, 0.0, 0.0, 0.0),
    )


@kernel
def on_field(car: Car, p: CarParameters, ground: Row) -> Lie:
    """Return how a field lies under the four contacts, and how that changes as the car travels over it."""
    plane = read(ground, GROUND.plane)
    grid = read(ground, GROUND.grid)
    body = car.body
    ahead = direction(body.yaw_rad)
    length = p.front.ahead_m - p.rear.ahead_m
    half_front, half_rear = p.front.half_track_m, p.rear.half_track_m
    fl = _at(ground, grid, body, ahead, length, half_front)
    fr = _at(ground, grid, body, ahead, length, -half_front)
    rl = _at(ground, grid, body, ahead, 0.0, half_rear)
    rr = _at(ground, grid, body, ahead, 0.0, -half_rear)
    per_length = 1.0 / length
    along = (0.5 * (fl.height_m + fr.height_m) - 0.5 * (rl.height_m + rr.height_m)) * per_length
    front_aside = (fl.height_m - fr.height_m) * (0.5 / half_front)
    rear_aside = (rl.height_m - rr.height_m) * (0.5 / half_rear)
    aside = 0.5 * (front_aside + rear_aside)
    twist = front_aside - aside
    fl_mps = _rising(fl, body, ahead, along, aside, p.front, half_front)
    fr_mps = _rising(fr, body, ahead, along, aside, p.front, -half_front)
    rl_mps = _rising(rl, body, ahead, along, aside, p.rear, half_rear)
    rr_mps = _rising(rr, body, ahead, along, aside, p.rear, -half_rear)
    front_up, rear_up = 0.5 * (fl_mps + fr_mps), 0.5 * (rl_mps + rr_mps)
    nose_up = (front_up - rear_up) * per_length
    left_up = 0.5 * ((fl_mps - fr_mps) * (0.5 / half_front) + (rl_mps - rr_mps) * (0.5 / half_rear))
    # The slope of the session's plane comes on top: it is the same everywhere, so it only tilts.
    along += plane.slope_x * ahead.cos + plane.slope_y * ahead.sin
    aside += plane.slope_y * ahead.cos - plane.slope_x * ahead.sin
    gravity = STANDARD_GRAVITY_MPS2 / sqrt(1.0 + along * along + aside * aside)
    turning = body.vx_mps * nose_up + body.vy_mps * left_up
    return Lie(
        height_m=0.5 * (rl.height_m + rr.height_m) + plane.slope_x * body.x_m + plane.slope_y * body.y_m,
        slope_x=along * ahead.cos - aside * ahead.sin,
        slope_y=along * ahead.sin + aside * ahead.cos,
        gravity_mps2=gravity,
        pressing_mps2=gravity - STANDARD_GRAVITY_MPS2 + turning,
        ahead_share=1.0 / sqrt(1.0 + along * along),
        aside_share=1.0 / sqrt(1.0 + aside * aside),
        cg_up_mps=(front_up * p.body.cg_to_rear_m + rear_up * p.body.cg_to_front_m) * per_length,
        left_up_radps=left_up,
        nose_down_radps=-nose_up,
        front=_axle_ground(half_front * twist, fl_mps, fr_mps, front_up, half_front * left_up),
        rear=_axle_ground(-half_rear * twist, rl_mps, rr_mps, rear_up, half_rear * left_up),
    )


@kernel
def _at(ground: Row, grid: Grid, body: BodyState, ahead: Direction, ahead_m: float, left_m: float) -> Spot:
    """Return the ground at a place of the car, from base_link."""
    x = body.x_m + ahead_m * ahead.cos - left_m * ahead.sin
    y = body.y_m + ahead_m * ahead.sin + left_m * ahead.cos
    return spot_at(ground, NODES_AT, grid, x, y)


@kernel
def _rising(
    spot: Spot, body: BodyState, ahead: Direction, along: float, aside: float, axle: AxleParameters, left_m: float
) -> float:
    """Return how fast the ground under a wheel rises, against the plane that the car moves along."""
    vx = body.vx_mps - body.yaw_rate_radps * left_m
    vy = body.vy_mps + body.yaw_rate_radps * axle.ahead_m
    ahead_slope = spot.slope_x * ahead.cos + spot.slope_y * ahead.sin - along
    aside_slope = spot.slope_y * ahead.cos - spot.slope_x * ahead.sin - aside
    return (ahead_slope * vx + aside_slope * vy) * (1.0 / (1.0 + along * along + aside * aside))
