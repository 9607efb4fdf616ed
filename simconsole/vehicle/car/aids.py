"""Driver aids: anti-lock brakes, traction control, stability control, hill hold. Each has its switch in the profile.

They use the true speed over ground, which a real car has to estimate from its wheel speeds.
"""

from typing import Final, NamedTuple

from simconsole.values.kernels import approach, clip, kernel
from simconsole.values.signals import Request
from simconsole.vehicle.car.axles import Axles, Contact
from simconsole.vehicle.car.parameters import AidParameters, CarParameters
from simconsole.vehicle.car.state import AidState, Car

RELEASE_SLIP: Final = 0.12
HOLD_SLIP: Final = 0.07
RELEASE_PER_S: Final = 14.0
BUILD_PER_S: Final = 4.0
SLOW_MPS: Final = 1.5
"""Below this speed ABS and TCS leave the wheels alone: a lock at walking pace hurts nobody."""
SPIN_SLIP: Final = 0.10
SPIN_MPS: Final = 0.6
DEAD_RADPS: Final = 0.035
"""Yaw rate by which a car may differ from the model before ESC acts: 2 deg/s."""
STABILITY_FROM_MPS: Final = 4.0
STABILITY_LAG_S: Final = 0.02
HOLD_S: Final = 2.0
HOLD_SLOPE: Final = 0.03
LEAVING_THROTTLE: Final = 0.02
"""Throttle beyond which the driver is about to drive off: the hill hold then waits for the drive, not for the time."""
DOWNHILL_SHARE: Final = 0.1
"""Share of the hill's pull from which on a drive torque in the downhill direction frees the hill hold."""


class Brakes(NamedTuple):
    """Torque capacity of each wheel's brake in N m, and what ABS leaves of the pedal."""

    fl_nm: float
    fr_nm: float
    rl_nm: float
    rr_nm: float
    fl_share: float
    fr_share: float
    rear_share: float


@kernel
def anti_lock(share: float, spin_mps: float, ground_mps: float, step_s: float) -> float:
    """Return the share of the pedal one step later: release above one slip, hold, build up below another."""
    speed = abs(ground_mps)
    spin = spin_mps if ground_mps > 0.0 else -spin_mps
    target = 1.0
    rate = BUILD_PER_S
    if spin < (1.0 - HOLD_SLIP) * speed:
        target = share
    if spin < (1.0 - RELEASE_SLIP) * speed:
        target = 0.0
        rate = RELEASE_PER_S
    if speed < SLOW_MPS:
        target = 1.0
        rate = RELEASE_PER_S
    return approach(share, target, rate * step_s)


@kernel
def traction(
    aids: AidParameters, share: float, driven: Contact, other: Contact, spin_mps: float, step_s: float
) -> float:
    """Return the share of the throttle one step later, by how much faster the driven wheels turn than they travel."""
    speed = 0.5 * abs(driven.ground_mps + other.ground_mps)
    spinning = aids.traction != 0.0 and abs(spin_mps) > (1.0 + SPIN_SLIP) * speed + SPIN_MPS
    return approach(share, 0.0 if spinning else 1.0, (6.0 if spinning else 1.5) * step_s)


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
    torque = car.aids.stability_nm + (wanted - car.aids.stability_nm) * (step_s / (STABILITY_LAG_S + step_s))
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
    steep = abs(p.body.slope_x) + abs(p.body.slope_y) > HOLD_SLOPE
    drive_n = car.shafts.clutch_impulse_nms * ratio * (p.gears.per_wheel_radius_m * (1.0 / step_s))
    if p.aids.hill_hold != 0.0 and steep and request.brake > 0.1 and abs(car.body.vx_mps) < 0.05:
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
def brake_torques(car: Car, p: CarParameters, request: Request, axles: Axles, aids: AidState, step_s: float) -> Brakes:
    """Return the capacity of each brake: pedal under ABS, hand brake on the rear, ESC on one wheel.

    ESC brakes the rear wheel inside where the car turns too little, the front wheel outside where it turns too much.
    """
    pedal = request.brake
    if aids.hold_left_s > 0.0 and aids.hold_brake > pedal:
        pedal = aids.hold_brake
    front = p.front
    rear = p.rear
    released = RELEASE_PER_S * step_s
    fl = approach(car.fl.brake_share, 1.0, released)
    fr = approach(car.fr.brake_share, 1.0, released)
    rl = approach(car.rl.brake_share, 1.0, released)
    rr = approach(car.rr.brake_share, 1.0, released)
    if p.aids.anti_lock != 0.0 and (pedal > 0.02 or abs(aids.stability_nm) > 1.0):
        fl = anti_lock(car.fl.brake_share, car.fl.radps * front.radius_m, axles.fl.ground_mps, step_s)
        fr = anti_lock(car.fr.brake_share, car.fr.radps * front.radius_m, axles.fr.ground_mps, step_s)
        rl = anti_lock(car.rl.brake_share, car.rl.radps * rear.radius_m, axles.rl.ground_mps, step_s)
        rr = anti_lock(car.rr.brake_share, car.rr.radps * rear.radius_m, axles.rr.ground_mps, step_s)
    low = rl if rl < rr else rr  # select-low: both rear wheels keep the side force of the better one
    turn = aids.stability_nm
    to_left = turn if turn > 0.0 else 0.0
    to_right = -turn if turn < 0.0 else 0.0
    inwards = turn * car.body.yaw_rate_radps > 0.0  # it turns too little
    front_share = 0.0 if inwards else 1.0
    hand = request.handbrake * rear.handbrake_nm
    return Brakes(
        fl_nm=fl * (pedal * front.brake_nm + front_share * to_left),
        fr_nm=fr * (pedal * front.brake_nm + front_share * to_right),
        rl_nm=low * pedal * rear.brake_nm + hand + (1.0 - front_share) * to_left * rl,
        rr_nm=low * pedal * rear.brake_nm + hand + (1.0 - front_share) * to_right * rr,
        fl_share=fl,
        fr_share=fr,
        rear_share=low,
    )
