"""Body: motion of a rigid body in six degrees of freedom, roll and pitch small, and of the wheels up and down."""

from math import sqrt
from typing import NamedTuple

from simconsole.values.ground import Plane
from simconsole.values.kernels import clip, kernel
from simconsole.values.trigonometry import direction, wrap_angle
from simconsole.vehicle.car.axles import Axles, Contact
from simconsole.vehicle.car.ground import AxleGround, Lie
from simconsole.vehicle.car.parameters import AxleParameters, CarParameters
from simconsole.vehicle.car.state import BodyState, Car, Wheel
from simconsole.vehicle.car.suspension import Travel, axle_roll, strut, support, travel

MOST_LEAN_RAD = 0.5
"""Limit of the model of small angles and springs: the body leans and the wheels lift no further."""
MOST_LIFT_M = 0.5


class AxleMotion(NamedTuple):
    """Wheels of one axle after one step, and what their struts give the body."""

    left_m: float
    left_mps: float
    right_m: float
    right_mps: float
    force_n: float
    moment_nm: float  # about the long axis, positive left side up


class Motion(NamedTuple):
    """Body and lifts of all wheels after one step."""

    body: BodyState
    front: AxleMotion
    rear: AxleMotion


@kernel
def stopped(rate: float, place: float, most: float) -> float:
    """Return the rate of something at `place`: 0 at the end of its travel, where it keeps no speed."""
    if abs(place) < most:  # nearly always
        return rate
    outwards = rate > 0.0 if place > 0.0 else rate < 0.0
    return 0.0 if outwards else rate


@kernel
def axle_step(
    axle: AxleParameters,
    struts: Travel,
    left: Wheel,
    right: Wheel,
    on_left: Contact,
    on_right: Contact,
    under: AxleGround,
    pressing_mps2: float,
    step_s: float,
) -> AxleMotion:
    """Return the wheels' vertical motion one step later. The links load them with the side force directly."""
    links_n = support(axle, on_left.force_x_n + on_right.force_x_n)
    left_n = strut(axle, struts.left_m, struts.left_mps, struts.right_m) + links_n
    right_n = strut(axle, struts.right_m, struts.right_mps, struts.left_m) + links_n
    lifted = (on_left.force_y_n + on_right.force_y_n) * (axle.link_arm_m * axle.roll_rad_per_m)
    share = step_s * axle.per_wheel_mass_kg
    pressed_mps = step_s * pressing_mps2
    left_mps = left.lift_mps + share * (on_left.load_n - axle.static_n - left_n + lifted) - pressed_mps
    right_mps = right.lift_mps + share * (on_right.load_n - axle.static_n - right_n - lifted) - pressed_mps
    left_m = clip(left.lift_m + step_s * (left_mps - under.left_up_mps), -MOST_LIFT_M, MOST_LIFT_M)
    right_m = clip(right.lift_m + step_s * (right_mps - under.right_up_mps), -MOST_LIFT_M, MOST_LIFT_M)
    return AxleMotion(
        left_m=left_m,
        left_mps=stopped(left_mps, left_m, MOST_LIFT_M),
        right_m=right_m,
        right_mps=stopped(right_mps, right_m, MOST_LIFT_M),
        force_n=left_n + right_n,
        moment_nm=axle.half_track_m * (left_n - right_n),
    )


@kernel
def body_step(car: Car, p: CarParameters, lie: Lie, air: Plane, axles: Axles, step_s: float) -> Motion:
    """Advance the body by one semi-implicit step: velocities from the forces, then the pose from the new velocities."""
    before = car.body
    body = p.body
    pressing = lie.pressing_mps2
    struts = travel(p.front, before, car.fl, car.fr)
    front = axle_step(p.front, struts, car.fl, car.fr, axles.fl, axles.fr, lie.front, pressing, step_s)
    struts = travel(p.rear, before, car.rl, car.rr)
    rear = axle_step(p.rear, struts, car.rl, car.rr, axles.rl, axles.rr, lie.rear, pressing, step_s)
    ahead = direction(before.yaw_rad)
    c = ahead.cos
    s = ahead.sin
    into_x = before.vx_mps - (air.wind_x_mps * c + air.wind_y_mps * s)
    into_y = before.vy_mps - (air.wind_y_mps * c - air.wind_x_mps * s)
    speed = sqrt(into_x * into_x + into_y * into_y)
    drag = body.drag_n_per_square_mps * speed
    gravity = lie.gravity_mps2
    per_kg = body.per_mass_kg
    ax = (axles.force_x_n - drag * into_x) * per_kg - gravity * (lie.slope_x * c + lie.slope_y * s)
    side_n = axles.front_y_n + axles.rear_y_n
    beside = body.side_n_per_square_mps * speed
    ay = (side_n - beside * into_y) * per_kg - gravity * (lie.slope_y * c - lie.slope_x * s)
    # One after the other, not both from the old values: turning the body then neither adds nor takes energy.
    vx = before.vx_mps + step_s * (ax + before.yaw_rate_radps * before.vy_mps)
    vy = before.vy_mps + step_s * (ay - before.yaw_rate_radps * vx)
    # Both act at the middle of the wheelbase. Oblique air turns a slender body broadside on (Munk, NACA TR 184).
    weathering = body.yaw_nm_per_square_mps * into_x + beside * (0.5 * (body.cg_to_front_m - body.cg_to_rear_m))
    turning = axles.moment_nm + axles.aligning_nm - weathering * into_y
    yaw_rate = before.yaw_rate_radps + turning * (step_s * body.per_yaw_inertia_kgm2)
    front_lift = body.front_lift_n_per_square_mps * into_x * into_x
    rear_lift = body.rear_lift_n_per_square_mps * into_x * into_x
    lifting = front.force_n + rear.force_n + front_lift + rear_lift
    heave_mps = before.heave_mps + lifting * (step_s * body.per_sprung_kg) - step_s * pressing
    rolling = (
        p.front.roll_arm_m * axles.front_y_n
        + p.rear.roll_arm_m * axles.rear_y_n
        + body.sway_nm_per_rad * before.roll_rad
    )
    rolling += front.moment_nm + rear.moment_nm
    roll_radps = before.roll_radps + rolling * (step_s * body.per_roll_inertia_kgm2)
    pitching = p.front.ahead_m * (front.force_n + front_lift) + p.rear.ahead_m * (rear.force_n + rear_lift)
    pitching += body.cg_height_m * axles.force_x_n + pressing * body.unsprung_kgm
    pitch_radps = before.pitch_radps - pitching * (step_s * body.per_pitch_inertia_kgm2)
    # base_link lies on the ground: it does not go along when the body rocks above standing tyres.
    on_ground_x = vx - body.cg_height_m * pitch_radps
    if car.rl.radps == 0.0 and car.rr.radps == 0.0:
        compressed_mps = 0.5 * (rear.left_mps + rear.right_mps) - (heave_mps - p.rear.ahead_m * pitch_radps)
        on_ground_x += p.rear.support_slope * compressed_mps
    rocking = p.rear.roll_arm_m * roll_radps + p.rear.link_arm_m * axle_roll(p.rear, rear.left_mps, rear.right_mps)
    on_ground_y = vy - body.cg_to_rear_m * yaw_rate + rocking
    heave = clip(before.heave_m + step_s * (heave_mps - lie.cg_up_mps), -MOST_LIFT_M, MOST_LIFT_M)
    roll = clip(before.roll_rad + step_s * (roll_radps - lie.left_up_radps), -MOST_LEAN_RAD, MOST_LEAN_RAD)
    pitch = clip(before.pitch_rad + step_s * (pitch_radps - lie.nose_down_radps), -MOST_LEAN_RAD, MOST_LEAN_RAD)
    map_x = on_ground_x * lie.ahead_share
    map_y = on_ground_y * lie.aside_share
    moved = BodyState(
        x_m=before.x_m + step_s * (map_x * c - map_y * s),
        y_m=before.y_m + step_s * (map_x * s + map_y * c),
        yaw_rad=wrap_angle(before.yaw_rad + step_s * yaw_rate),
        vx_mps=vx,
        vy_mps=vy,
        yaw_rate_radps=yaw_rate,
        ax_mps2=ax,
        ay_mps2=ay,
        heave_m=heave,
        heave_mps=stopped(heave_mps, heave, MOST_LIFT_M),
        roll_rad=roll,
        roll_radps=stopped(roll_radps, roll, MOST_LEAN_RAD),
        pitch_rad=pitch,
        pitch_radps=stopped(pitch_radps, pitch, MOST_LEAN_RAD),
        distance_m=before.distance_m + step_s * sqrt(on_ground_x * on_ground_x + on_ground_y * on_ground_y),
    )
    return Motion(moved, front, rear)
