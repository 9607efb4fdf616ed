"""Driver aids: anti-lock brakes, traction control, stability control, hill hold. Each has its switch in the profile.

They use the true speed over ground, which a real car has to estimate from its wheel speeds.
"""

from typing import Final, NamedTuple

from simconsole.values.kernels import clip, kernel
from simconsole.values.signals import Request
from simconsole.vehicle.car.axles import Axles, Contact
from simconsole.vehicle.car.engine import EngineTorques
from simconsole.vehicle.car.gearbox import LOCKED_RADPS, gear_ratio
from simconsole.vehicle.car.parameters import AxleParameters, CarParameters
from simconsole.vehicle.car.state import AidState, Car, Wheel

RELEASE_PEAKS: Final = 1.25
RESUME_PEAKS: Final = 0.7
"""Slips, as multiples of that at the peak of the force, above which ABS releases a brake, and below which it lets it
build up fast. In between it lets it build up slowly: it feels its way to the peak again and again."""
RELEASE_PER_S: Final = 6.0
FEEL_PER_S: Final = 0.6
LEAST_SHARE: Final = 0.1
"""Rates of the torque in force, and of this share of the full torque: valves pass less at a lower pressure."""
FREE_PER_S: Final = 1000.0
"""Without ABS: nothing but the lag."""
LEAST_SLIP_MPS: Final = 0.3
"""Slip that is never too much: the tyre's deflection needs its way to build up."""
SLOW_MPS: Final = 1.5
"""Below this speed ABS leaves the wheels alone: a lock at walking pace hurts nobody."""
TRACTION_S: Final = 0.05
"""Time in which traction control brings the slip to that of the peak."""
ANY_NM: Final = 1e9
"""No limit of a torque."""
DEAD_RADPS: Final = 0.035
"""Yaw rate by which a car may differ from the model before ESC acts: 2 deg/s."""
STABILITY_FROM_MPS: Final = 4.0
STABILITY_LAG_S: Final = 0.02
STABILITY_SLIP: Final = 0.08
STABILITY_LEAST_NM: Final = 1.0
"""Slip at which a wheel is held that ESC brakes, and the least torque that counts as braking."""
SAME_NM: Final = 0.1
HOLD_S: Final = 2.0
HOLD_SLOPE: Final = 0.03
HOT_HOLD_BRAKE: Final = 0.6
"""Pedal with which the hill hold takes the car over from a clutch that must cool."""
LEAVING_THROTTLE: Final = 0.02
"""Throttle beyond which the driver is about to drive off: the hill hold then waits for the drive, not for the time."""
DOWNHILL_SHARE: Final = 0.1
"""Share of the hill's pull from which on a drive torque in the downhill direction frees the hill hold."""


class Brakes(NamedTuple):
    """Torque of each wheel's brake in N m, as the pressure of now gives it."""

    fl_nm: float
    fr_nm: float
    rl_nm: float
    rr_nm: float


class Drive(NamedTuple):
    """What traction control leaves of the drive."""

    share: float  # of the throttle; 1: it does nothing
    throttle: float  # what is left of the driver's
    clutch_nm: float  # the most that the automatic's clutch may transmit while it slips


class Spin(NamedTuple):
    """The driven wheels on their ground, forwards in the direction in which the gear drives."""

    way: float  # 1, and -1 in reverse
    force_n: float
    load_n: float
    slip_mps: float
    bound: float  # load times the slip that they may have, N m/s


@kernel
def slip_at_peak(axle: AxleParameters, force_n: float, speed_mps: float) -> float:
    """Return load times slip velocity, N m/s, at which a tyre that gives this force along its wheel were at its peak.

    At the peak of the force half of the stiffness at small slip is left, on any ground. So the peak lies at the
    slip at which the force is half of what that stiffness would give: the friction in use tells where, and who goes
    for that slip arrives at the peak from either side. A force to the side leaves less of the slip along the wheel.
    """
    return axle.peak_slip * abs(force_n) * speed_mps


@kernel
def anti_lock_rate(axle: AxleParameters, wheel: Wheel, on: Contact, stability_nm: float) -> float:
    """Return how fast ABS lets a brake build up, as share of its torque per second; negative: it releases.

    A tyre that slides sideways has its peak along the wheel at nearly no slip. Where ESC brakes the wheel
    (`stability_nm` above 0) that must not take the brake off: what turns the car back is that it brakes, and that its
    side force is gone. Such a wheel is held at a slip of its own.
    """
    speed = abs(on.ground_mps)
    rim = wheel.radps * axle.radius_m
    slip = speed - (rim if on.ground_mps > 0.0 else -rim)
    peak = slip_at_peak(axle, on.tyre.force_x_n, speed)
    loaded = on.load_n * slip
    wanted = STABILITY_SLIP * speed if stability_nm > STABILITY_LEAST_NM else 0.0
    if speed < SLOW_MPS or loaded < RESUME_PEAKS * peak or slip < RESUME_PEAKS * wanted:
        return FREE_PER_S
    least = wanted if wanted > LEAST_SLIP_MPS else LEAST_SLIP_MPS
    return -RELEASE_PER_S if loaded > RELEASE_PEAKS * peak and slip > least else FEEL_PER_S


@kernel
def spin_of(axle: AxleParameters, left: Contact, right: Contact, mean_radps: float, gear: float) -> Spin:
    """Return how the driven wheels slip. Wheels that the engine holds back, or brakes, have a slip below 0."""
    way = -1.0 if gear < 0.0 else 1.0
    ground = 0.5 * (left.ground_mps + right.ground_mps)
    force = left.tyre.force_x_n + right.tyre.force_x_n
    load = left.load_n + right.load_n + 1.0  # never 0
    peak = slip_at_peak(axle, force, abs(ground))
    least = LEAST_SLIP_MPS * load
    return Spin(way, way * force, load, way * (mean_radps * axle.radius_m - ground), peak if peak > least else least)


@kernel
def traction(
    car: Car,
    p: CarParameters,
    request: Request,
    can: EngineTorques,
    axle: AxleParameters,
    left: Contact,
    right: Contact,
    mean_radps: float,
) -> Drive:
    """Return what is left of the drive where the driven wheels slip beyond the peak of their force.

    `can` is what the engine can give, `mean_radps` the speed of the driven wheels.
    """
    if p.aids.traction != 0.0:
        spin = spin_of(axle, left, right, mean_radps, car.box.gear)
        if car.aids.throttle_share != 1.0 or spin.slip_mps * spin.load_n > spin.bound:
            return regulated(car, p, request, can, axle, spin, mean_radps)
    return Drive(1.0, request.throttle, ANY_NM)


@kernel
def regulated(
    car: Car,
    p: CarParameters,
    request: Request,
    can: EngineTorques,
    axle: AxleParameters,
    spin: Spin,
    mean_radps: float,
) -> Drive:
    """Return the drive that brings the slip to that of the peak, from either side and whatever the tyres' curve.

    That is the torque which the tyres take now, and beyond it what gives all that turns with the wheels the speed they
    lack. So nothing is summed up, and nothing has to be taken back later. Where the clutch is closed it is the torque
    of the engine. Where the automatic slips it, it is that of the clutch: the engine keeps its throttle, or it could
    never pull the car off. While a person slips the clutch the throttle has no hold on the wheels; once it is closed
    the engine must not be slowed down to where it dies.
    """
    gears = p.gears
    ratio = gear_ratio(gears, car.box.gear)
    leverage = spin.way * ratio
    engine = car.shafts.engine_radps
    closed = abs(engine - ratio * mean_radps) < LOCKED_RADPS
    by_hand = car.box.lever_adopted != 0.0
    span = request.throttle * (can.full_nm + can.friction_nm - can.closed_nm)
    if leverage <= 0.0 or span <= 0.0 or (by_hand and not closed):
        return Drive(1.0, request.throttle, ANY_NM)
    lacking = spin.bound / spin.load_n - spin.slip_mps
    if by_hand:
        pulling = gears.launch_from_radps + gears.launch_per_throttle_radps * request.throttle
        alive = (pulling / leverage - spin.way * mean_radps) * axle.radius_m
        lacking = lacking if lacking > alive else alive
    inertia = 2.0 * axle.wheel_inertia_kgm2
    if closed or lacking > 0.0:
        inertia += ratio * ratio * p.engine.inertia_kgm2
    wheels_mps2 = spin.way * car.body.ax_mps2 + lacking * (1.0 / TRACTION_S)
    wheels_nm = axle.radius_m * (spin.force_n + axle.rolling_resistance * spin.load_n)
    most_nm = (wheels_nm + inertia * wheels_mps2 / axle.radius_m) / (leverage * (1.0 - gears.loss_share))
    share = (most_nm + can.friction_nm - can.closed_nm) / span
    if share >= 1.0:
        return Drive(1.0, request.throttle, ANY_NM)
    share = share if share > 0.0 else 0.0
    if closed:
        return Drive(share, share * request.throttle, ANY_NM)
    return Drive(share, request.throttle, most_nm if most_nm > 0.0 else 0.0)


@kernel
def stability(car: Car, p: CarParameters, handbrake: float, step_s: float) -> float:
    """Return the torque with which ESC brakes one wheel, positive where it turns the car to the left.

    The reference is the yaw rate of a linear single track with the car's understeer, r = v d / (L (1 + k v^2)), limited
    to what the ground allows at that speed. A deviation beyond a dead band is corrected by braking. While the hand
    brake is pulled ESC does not act: the driver wants the rear to slide.
    """
    body = car.body
    speed = body.vx_mps
    wanted = 0.0
    if p.aids.stability != 0.0 and speed > STABILITY_FROM_MPS and handbrake < 0.3:
        wheelbase = p.body.cg_to_front_m + p.body.cg_to_rear_m
        model = (
            speed * car.steering.road_wheel_rad / (wheelbase * (1.0 + p.aids.understeer_per_square_mps * speed * speed))
        )
        most = p.aids.lateral_mps2 / speed
        error = clip(model, -most, most) - body.yaw_rate_radps
        beyond = error - clip(error, -DEAD_RADPS, DEAD_RADPS)
        wanted = clip(p.aids.stability_nms * beyond, -p.aids.stability_most_nm, p.aids.stability_most_nm)
    before = car.aids.stability_nm
    if wanted == 0.0 and before == 0.0:
        return 0.0
    torque = before + (wanted - before) * (step_s / (STABILITY_LAG_S + step_s))
    return torque if abs(torque) > 1e-6 else 0.0


@kernel
def carried(drive_n: float, pull_n: float) -> bool:
    """Return whether the drive force carries the hill's pull, or acts downhill like it."""
    if pull_n < 0.0:
        return drive_n <= pull_n or drive_n > -DOWNHILL_SHARE * pull_n
    return drive_n >= pull_n or drive_n < -DOWNHILL_SHARE * pull_n


@kernel
def hill_hold(car: Car, p: CarParameters, request: Request, axles: Axles, ratio: float, step_s: float) -> AidState:
    """Return pedal and remaining time of the hill hold: set by braking at rest on a hill, freed by drive or time.

    While the car stands, its tyres together balance the hill's pull. As soon as the driven wheels do so alone, the
    brake has nothing left to hold.
    """
    s = car.aids
    left = s.hold_left_s
    brake = s.hold_brake
    steep = axles.slope > HOLD_SLOPE
    # The gears take their loss of it; as much again is the margin by which the drive must be the stronger.
    kept = (1.0 - 2.0 * p.gears.loss_share) * p.gears.per_wheel_radius_m
    drive_n = car.shafts.clutch_impulse_nms * ratio * (kept * (1.0 / step_s))
    standing = p.aids.hill_hold != 0.0 and steep and abs(car.body.vx_mps) < 0.05
    if standing and car.shafts.clutch_hot != 0.0:
        brake = HOT_HOLD_BRAKE
        left = HOLD_S
    elif standing and request.brake > 0.1:
        # A pedal that is released slowly must not lower the held pressure.
        if left == 0.0 or request.brake > brake:
            brake = request.brake
        left = HOLD_S
    elif request.brake > brake:
        left = clip(left, 0.0, 0.3)
    elif request.throttle <= LEAVING_THROTTLE:
        left = left - step_s if left > step_s else 0.0
    elif carried(drive_n, axles.force_x_n):
        left = 0.0
    return AidState(s.throttle_share, s.stability_nm, left, brake)


@kernel
def pressed(axle: AxleParameters, wheel: Wheel, wanted_nm: float, rate_per_s: float, step_s: float) -> float:
    """Return the torque of a brake one step later: its pressure follows with a lag, and as ABS lets it."""
    way = (wanted_nm - wheel.brake_nm) * axle.brake_ease
    allowed = rate_per_s * step_s * (wheel.brake_nm + LEAST_SHARE * axle.brake_nm)
    now = wheel.brake_nm + (way if way < allowed else allowed)
    return wanted_nm if abs(wanted_nm - now) < SAME_NM else (now if now > 0.0 else 0.0)


@kernel
def brake_torques(car: Car, p: CarParameters, request: Request, axles: Axles, aids: AidState, step_s: float) -> Brakes:
    """Return the torque of each brake: pedal under ABS, and ESC on one wheel. The hand brake is a cable of its own.

    ESC brakes the rear wheel inside where the car turns too little, the front wheel outside where it turns too much.
    """
    pedal = request.brake
    if aids.hold_left_s > 0.0 and aids.hold_brake > pedal:
        pedal = aids.hold_brake
    turn = aids.stability_nm
    in_force = car.fl.brake_nm + car.fr.brake_nm + car.rl.brake_nm + car.rr.brake_nm
    if pedal == 0.0 and turn == 0.0 and in_force == 0.0:
        return Brakes(0.0, 0.0, 0.0, 0.0)
    front = p.front
    rear = p.rear
    fl = FREE_PER_S
    fr = FREE_PER_S
    low = FREE_PER_S
    to_left = turn if turn > 0.0 else 0.0
    to_right = -turn if turn < 0.0 else 0.0
    inwards = turn * car.body.yaw_rate_radps > 0.0  # it turns too little
    front_share = 0.0 if inwards else 1.0
    rear_share = 1.0 - front_share
    if p.aids.anti_lock != 0.0 and (pedal > 0.02 or abs(turn) > STABILITY_LEAST_NM):
        fl = anti_lock_rate(front, car.fl, axles.fl, front_share * to_left)
        fr = anti_lock_rate(front, car.fr, axles.fr, front_share * to_right)
        rl = anti_lock_rate(rear, car.rl, axles.rl, rear_share * to_left)
        rr = anti_lock_rate(rear, car.rr, axles.rr, rear_share * to_right)
        low = rl if rl < rr else rr  # select-low: both rear wheels keep the side force of the better one
    return Brakes(
        fl_nm=pressed(front, car.fl, pedal * front.brake_nm + front_share * to_left, fl, step_s),
        fr_nm=pressed(front, car.fr, pedal * front.brake_nm + front_share * to_right, fr, step_s),
        rl_nm=pressed(rear, car.rl, pedal * rear.brake_nm + rear_share * to_left, low, step_s),
        rr_nm=pressed(rear, car.rr, pedal * rear.brake_nm + rear_share * to_right, low, step_s),
    )
