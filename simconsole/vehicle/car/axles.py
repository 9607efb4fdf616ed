"""The four wheels on the ground: the motion of their contact patches, and the forces of their tyres."""

from collections.abc import Callable
from typing import Any, Final, NamedTuple

from simconsole.values.kernels import kernel
from simconsole.vehicle.car.ground import Grips, Lie
from simconsole.vehicle.car.parameters import AxleParameters, CarParameters, SteeringParameters
from simconsole.vehicle.car.state import BodyState, Car, Wheel
from simconsole.vehicle.car.steering import WheelDirections, aligning_moment, patch_twist, turn_slip_moment
from simconsole.vehicle.car.suspension import axle_roll, compression_rate, wheel_load
from simconsole.vehicle.car.tyre import Tyre

TyreModel = Callable[..., Any]
"""A kernel with the arguments of `tyre.tyre` that returns a `Tyre` or a record with the same fields and more."""

KingpinMoment = Callable[[SteeringParameters, Any, float], float]
"""A kernel that returns the moment about the kingpin, as `kingpin_moment`, from what the tyre's kernel returns."""

LIGHT_SHARE: Final = 0.1
"""Share of the static load below which a standing wheel is about to lift: it keeps its deflection as it is."""


class Contact(NamedTuple):
    """One tyre on the ground after one step; speed and forces along the body."""

    tyre: Tyre
    load_n: float
    ground_mps: float  # of the wheel's centre over the ground, along the wheel
    force_x_n: float
    force_y_n: float


class Axles(NamedTuple):
    """Tyres of one step and the sum of their forces on the body."""

    fl: Contact
    fr: Contact
    rl: Contact
    rr: Contact
    force_x_n: float  # along the body
    front_y_n: float
    rear_y_n: float
    moment_nm: float  # about the centre of gravity, left-positive
    aligning_nm: float  # about the kingpins, left-positive
    patch_twist_rad: float
    slope: float  # of the ground under the car, both ways together


@kernel
def standing_on(wheel: Wheel, above_m: float, rising_mps: float) -> Wheel:
    """Return a wheel with its lift against the ground under it."""
    return Wheel(
        radps=wheel.radps,
        deflection_x_m=wheel.deflection_x_m,
        deflection_y_m=wheel.deflection_y_m,
        lift_m=wheel.lift_m - above_m,
        lift_mps=wheel.lift_mps - rising_mps,
        brake_nm=wheel.brake_nm,
    )


@kernel
def kept_share(axle: AxleParameters, wheel: Wheel, step_s: float) -> float:
    """Return the share of its deflection that a held wheel's contact patch keeps while the load on it changes.

    The side force is proportional to the load, but the rubber that more load brings to the ground has no deflection:
    the force stays. Otherwise a stored force would follow the load without resisting it, and two tyres of an
    axle that are braced against each other would feed energy into the body's sway.
    """
    load = axle.static_n - axle.carcass_npm * wheel.lift_m
    before = load + axle.carcass_npm * wheel.lift_mps * step_s
    least = LIGHT_SHARE * axle.static_n
    return before / load if load > least and before > least else 1.0


@kernel
def unsteered_tyre(
    tyre: TyreModel,
    axle: AxleParameters,
    friction: float,
    wheel: Wheel,
    vx_mps: float,
    vy_mps: float,
    camber_rad: float,
    side: float,
    step_s: float,
) -> Contact:
    """Return one tyre one step later, its wheel pointing ahead, its contact patch moving with (vx, vy)."""
    load = wheel_load(axle, wheel)
    share = kept_share(axle, wheel, step_s) if wheel.radps == 0.0 else 1.0
    t = tyre(
        axle,
        friction,
        load,
        vx_mps - wheel.radps * axle.radius_m,
        vy_mps,
        wheel.radps,
        share * wheel.deflection_x_m,
        share * wheel.deflection_y_m,
        camber_rad,
        side,
        step_s,
    )
    return Contact(t, load, vx_mps, t.force_x_n, t.force_y_n)


@kernel
def steered_tyre(
    tyre: TyreModel,
    axle: AxleParameters,
    friction: float,
    wheel: Wheel,
    vx_mps: float,
    vy_mps: float,
    c: float,
    s: float,
    turned_rad: float,
    camber_rad: float,
    side: float,
    step_s: float,
) -> Contact:
    """Return the same as `unsteered_tyre` for a wheel that points along (c, s) and has just turned by `turned_rad`."""
    # The contact patch stays on the ground while the wheel turns about it: its deflection turns back in the wheel.
    x = wheel.deflection_x_m + turned_rad * wheel.deflection_y_m
    y = wheel.deflection_y_m - turned_rad * x
    seen = Wheel(
        radps=wheel.radps,
        deflection_x_m=x,
        deflection_y_m=y,
        lift_m=wheel.lift_m,
        lift_mps=wheel.lift_mps,
        brake_nm=wheel.brake_nm,
    )
    along = vx_mps * c + vy_mps * s
    on = unsteered_tyre(tyre, axle, friction, seen, along, vy_mps * c - vx_mps * s, camber_rad, side, step_s)
    force_x = on.force_x_n * c - on.force_y_n * s
    return Contact(on.tyre, on.load_n, on.ground_mps, force_x, on.force_x_n * s + on.force_y_n * c)


@kernel
def kingpin_moment(p: SteeringParameters, tyre_force: Tyre, rolling_mps: float) -> float:
    """Return one tyre's moment about its kingpin."""
    return aligning_moment(p, tyre_force.force_y_n, tyre_force.demand, rolling_mps)


@kernel
def side_speed(axle: AxleParameters, body: BodyState, left: Wheel, right: Wheel) -> float:
    """Return the velocity of an axle's contact patches to the left.

    Rolling moves them against the body with the same arms with which their forces roll it: leaving out one
    of the two would create energy.
    """
    turning = body.vy_mps + axle.ahead_m * body.yaw_rate_radps
    return (
        turning + axle.roll_arm_m * body.roll_radps + axle.link_arm_m * axle_roll(axle, left.lift_mps, right.lift_mps)
    )


@kernel
def along_speed(axle: AxleParameters, body: BodyState, left: Wheel, right: Wheel, cg_height_m: float) -> float:
    """Return the velocity of an axle's middle on the ground along the body: pitching moves it against the body.

    A wheel that the brake holds turns with its links: the slope of their pole moves its contact patch with the arm with
    which braking pushes body and wheel apart. On a wheel that turns the brake gets that motion.
    """
    along = body.vx_mps - cg_height_m * body.pitch_radps
    if left.radps == 0.0 and right.radps == 0.0:
        along += axle.support_slope * compression_rate(axle, body, left.lift_mps, right.lift_mps)
    return along


@kernel
def inclination(axle: AxleParameters, body: BodyState, left: Wheel, right: Wheel) -> float:
    """Return the lean of an axle's wheels."""
    return body.roll_rad + axle.camber_gain * (body.roll_rad - axle_roll(axle, left.lift_m, right.lift_m))


@kernel
def tyre_forces(
    car: Car,
    p: CarParameters,
    grips: Grips,
    lie: Lie,
    points: WheelDirections,
    turned_rad: float,
    step_s: float,
    tyre: TyreModel,
    rim_moment: KingpinMoment,
) -> Axles:
    """Return the tyres one step later, with the front wheels pointing to `points`."""
    body = car.body
    front = p.front
    rear = p.rear
    left = standing_on(car.fl, lie.front.left_m, lie.front.left_mps)
    right = standing_on(car.fr, lie.front.right_m, lie.front.right_mps)
    vx = along_speed(front, body, car.fl, car.fr, p.body.cg_height_m)
    vy = side_speed(front, body, car.fl, car.fr)
    side = front.half_track_m * body.yaw_rate_radps
    lean = inclination(front, body, car.fl, car.fr)
    fl = steered_tyre(
        tyre, front, grips.fl, left, vx - side, vy, points.left_cos, points.left_sin, turned_rad, lean, 1.0, step_s
    )
    fr = steered_tyre(
        tyre, front, grips.fr, right, vx + side, vy, points.right_cos, points.right_sin, turned_rad, lean, -1.0, step_s
    )
    left = standing_on(car.rl, lie.rear.left_m, lie.rear.left_mps)
    right = standing_on(car.rr, lie.rear.right_m, lie.rear.right_mps)
    vx = along_speed(rear, body, car.rl, car.rr, p.body.cg_height_m)
    vy = side_speed(rear, body, car.rl, car.rr)
    side = rear.half_track_m * body.yaw_rate_radps
    lean = inclination(rear, body, car.rl, car.rr)
    rl = unsteered_tyre(tyre, rear, grips.rl, left, vx - side, vy, lean, 1.0, step_s)
    rr = unsteered_tyre(tyre, rear, grips.rr, right, vx + side, vy, lean, -1.0, step_s)
    front_y = fl.force_y_n + fr.force_y_n
    rear_y = rl.force_y_n + rr.force_y_n
    steering = p.steering
    left_mps = car.fl.radps * front.radius_m
    right_mps = car.fr.radps * front.radius_m
    rolled = 0.5 * step_s * abs(left_mps + right_mps)
    twist = patch_twist(car.steering.patch_twist_rad, turned_rad + step_s * body.yaw_rate_radps, rolled)
    aligning = rim_moment(steering, fl.tyre, left_mps) + rim_moment(steering, fr.tyre, right_mps)
    aligning += turn_slip_moment(steering, twist, grips.fl * fl.load_n, fl.tyre.demand) + turn_slip_moment(
        steering, twist, grips.fr * fr.load_n, fr.tyre.demand
    )
    return Axles(
        fl=fl,
        fr=fr,
        rl=rl,
        rr=rr,
        force_x_n=(fl.force_x_n + fr.force_x_n) + (rl.force_x_n + rr.force_x_n),
        front_y_n=front_y,
        rear_y_n=rear_y,
        moment_nm=(front.ahead_m * front_y + rear.ahead_m * rear_y)
        + (front.half_track_m * (fr.force_x_n - fl.force_x_n) + rear.half_track_m * (rr.force_x_n - rl.force_x_n)),
        aligning_nm=aligning,
        patch_twist_rad=twist,
        slope=abs(lie.slope_x) + abs(lie.slope_y),
    )
