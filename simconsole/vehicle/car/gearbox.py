"""Clutch and gears: what the person's lever and pedal do, and the automatic that works both by itself.

Rules of the lever: a gear goes in only with the clutch open or with matching speeds, and only if the engine would turn
neither beyond its limit nor backwards; otherwise the gearbox stays in neutral until it may. After automatic driving the
engaged gear and the automatic clutch stay until the person takes them back: by pressing the clutch, or by putting the
lever where the gearbox is while the clutch is closed.
"""

from math import sqrt
from typing import Final, NamedTuple

from simconsole.values.kernels import approach, clip, foreseen, kernel
from simconsole.values.signals import GearFault, Request
from simconsole.vehicle.car.parameters import GearParameters
from simconsole.vehicle.car.state import Gearbox

BACKWARDS_RADPS = -40.0
"""A gear that would turn the engine's side backwards faster than this does not go in: a slow walking pace."""

ROLLING_MPS = 1.0
"""Above this speed the automatic does not engage a gear of the other direction (a slow walking pace). One that is in
stays in: who rolls back on a hill wants the drive, which the slipping clutch gives."""

SHIFT_RAMP_SHARE: Final = 0.4
"""Share of a shift's time in which the automatic takes the torque away before it, and gives it back after it."""

LOCKED_RADPS = 2.0
"""Slip up to which the automatic clutch counts as through with slipping: it then closes."""

CUT_BAND_RADPS = 15.0
"""Engine speed beyond the one that it shall have over which the automatic takes the throttle back."""

CREEP_BRAKE = 0.1
"""Brake pedal, and hand brake, from which on the automatic does not creep."""

COOLED = 0.7
"""Heat, as share of what the clutch may have, at which it takes up its work again."""

BLIP_BAND_RADPS = 40.0
BLIP_MOST = 0.7
"""The automatic's throttle by the speed that the engine is short of when it shifts down."""


class Turning(NamedTuple):
    """What the automatic measures and knows of engine, clutch and wheels."""

    engine_radps: float
    wheel_radps: float  # mean of the driven wheels
    vx_mps: float
    asked_nm: float  # what the engine would give at its speed and at the driver's throttle, friction taken off
    most_nm: float  # what the clutch may transmit at most while it slips: more would spin the wheels
    hot: float  # 1 while the clutch must cool


@kernel
def gear_ratio(p: GearParameters, gear: float) -> float:
    """Return engine speed per wheel speed, 0 in neutral and for a gear that this car has not."""
    if gear == 0.0:
        return 0.0
    if gear < 0.0:
        return p.ratio_reverse
    if gear < 3.5:
        return p.ratio_1 if gear < 1.5 else (p.ratio_2 if gear < 2.5 else p.ratio_3)
    if gear < 5.5:
        return p.ratio_4 if gear < 4.5 else p.ratio_5
    return p.ratio_6 if gear < 6.5 else p.ratio_7


@kernel
def bite(p: GearParameters, clutch: float) -> float:
    """Return the share of its torque that the clutch can transmit at a pedal position."""
    share = clip((p.bite_open - clutch) * p.per_bite, 0.0, 1.0)
    return share * share


@kernel
def by_person(
    p: GearParameters, box: Gearbox, lever: float, pedal: float, engine_radps: float, wheel_radps: float
) -> Gearbox:
    """Return the gearbox under the person's lever and clutch pedal."""
    if lever == box.gear:
        return Gearbox(
            gear=lever,
            clutch=pedal,
            lever_adopted=1.0,
            wanted_gear=lever,
            shift_left_s=0.0,
            since_shift_s=box.since_shift_s,
            gear_fault=0.0,
        )
    ratio = gear_ratio(p, lever)
    speed = ratio * wheel_radps
    free = pedal >= p.bite_open or abs(speed - engine_radps) < p.synchro_radps
    fault = 0.0
    if lever != 0.0:
        if not free:
            fault += GearFault.GRIND
        if speed >= p.limit_radps:
            fault += GearFault.MONEY_SHIFT
        if ratio == 0.0 or speed <= BACKWARDS_RADPS:
            fault += GearFault.MISSED
    gear = lever if fault == 0.0 else 0.0
    return Gearbox(
        gear=gear,
        clutch=pedal,
        lever_adopted=1.0,
        wanted_gear=gear,
        shift_left_s=0.0,
        since_shift_s=0.0,
        gear_fault=fault,
    )


@kernel
def gear_for(p: GearParameters, box: Gearbox, direction: float, throttle: float, vx_mps: float) -> float:
    """Return the gear that the automatic wants: up and down by engine speed, wider apart than one step of the gears."""
    if direction == 0.0:
        return 0.0
    if direction < 0.0:
        return -1.0 if vx_mps < ROLLING_MPS or box.gear < 0.0 else 0.0
    if vx_mps < -ROLLING_MPS:
        return 1.0 if box.gear >= 1.0 else 0.0
    wheel = vx_mps * p.per_wheel_radius_m
    up = p.up_radps + p.up_per_throttle_radps * throttle
    if box.gear < 1.0:
        gear = 1.0
        while gear < p.gears and gear_ratio(p, gear) * wheel > up:
            gear += 1.0
        return gear
    if vx_mps < ROLLING_MPS:
        return 1.0
    if box.since_shift_s < p.shift_pause_s:
        return box.gear
    speed = gear_ratio(p, box.gear) * wheel
    if speed > up and box.gear < p.gears:
        return box.gear + 1.0
    if speed < p.down_radps + p.down_per_throttle_radps * throttle and box.gear > 1.0:
        return box.gear - 1.0
    return box.gear


@kernel
def shift_ramp(p: GearParameters, box: Gearbox) -> float:
    """Return the share of the torque that a shift leaves: down before the gear changes, up once it is in."""
    left = box.shift_left_s
    return clip((left - p.shift_s) * p.per_ramp_s + 1.0 if left > 0.0 else box.since_shift_s * p.per_ramp_s, 0.0, 1.0)


@kernel
def held_speed(p: GearParameters, gearbox_radps: float, throttle: float) -> float:
    """Return the engine speed that the slipping clutch holds: that of a launch, or the gearbox's where it is faster."""
    launch = p.launch_from_radps + p.launch_per_throttle_radps * throttle
    return gearbox_radps if gearbox_radps > launch else launch


@kernel
def creep_torque(
    p: GearParameters, engine_radps: float, gearbox_radps: float, push_nm: float, request: Request
) -> float:
    """Return the clutch torque that lets the car creep, less where the engine falls below idle or somebody brakes.

    Where the throttle gives the engine more torque than it creeps with the clutch must let it speed up.
    """
    pressed = request.brake if request.brake > request.handbrake else request.handbrake
    share = clip(1.0 - (gearbox_radps - p.idle_radps) * p.per_fade_radps, 0.0, 1.0)
    share = share * clip(1.0 - pressed * (1.0 / CREEP_BRAKE), 0.0, 1.0)
    share = share * clip(2.0 - push_nm * p.per_creep_held_nm, 0.0, 1.0)
    return clip(share * p.creep_nm + p.launch_nms * (engine_radps - p.idle_radps), 0.0, share * p.creep_nm)


@kernel
def automatic_torque(p: GearParameters, box: Gearbox, request: Request, turning: Turning) -> float:
    """Return the torque that the automatic lets the clutch transmit, in N m.

    While it slips: what the engine gives, and as much more or less as brings the engine to the speed that it shall
    have. So the car gets what the pedal asks for, in a launch as in the slip after a shift. Once nothing slips and the
    gearbox is fast enough to carry the engine it closes. A hot clutch stays open.
    """
    if box.gear == 0.0 or turning.hot != 0.0:
        return 0.0
    ramp = shift_ramp(p, box)
    asked = turning.asked_nm
    if box.shift_left_s > 0.0:
        return ramp * abs(asked)
    gearbox = gear_ratio(p, box.gear) * turning.wheel_radps
    slip = turning.engine_radps - gearbox
    push = asked if asked > 0.0 else 0.0
    if slip >= 0.0:
        beyond = turning.engine_radps - held_speed(p, gearbox, request.throttle)
        torque = push + clip(p.launch_nms * beyond, -push, p.sync_nm)
    else:
        torque = 0.0 if push > 0.0 else p.sync_nm - asked
    if abs(box.gear) == 1.0:
        creep = creep_torque(p, turning.engine_radps, gearbox, push, request)
        torque = creep if creep > torque else torque
    torque = ramp * torque
    if abs(slip) < LOCKED_RADPS:
        closed = p.clutch_nm * clip((gearbox - p.lock_from_radps) * p.per_lock_radps, 0.0, 1.0)
        torque = closed if closed > torque else torque
    return torque


@kernel
def automatic_clutch(p: GearParameters, box: Gearbox, request: Request, turning: Turning, step_s: float) -> float:
    """Return the pedal position of the automatic clutch, one step further to where it transmits the wanted torque."""
    torque = automatic_torque(p, box, request, turning)
    torque = torque if torque < turning.most_nm else turning.most_nm
    share = clip(torque * p.per_clutch_nm, 0.0, 1.0)
    target = 0.0  # fully closed, as with the pedal released
    if share < 1.0:
        foreseen()
        target = p.bite_open - sqrt(share) * (p.bite_open - p.bite_closed)
    rate = p.clutch_opening_per_s if target > box.clutch else p.clutch_closing_per_s
    return approach(box.clutch, target, rate * step_s)


@kernel
def matched_throttle(
    p: GearParameters, box: Gearbox, throttle: float, engine_radps: float, wheel_radps: float
) -> float:
    """Return the throttle under the automatic: as asked, less where the engine is too fast, a blip where too slow.

    Too fast is a revving engine on a slipping clutch. The blip is for a shift down: without it the closing clutch would
    spin the engine up out of the car's motion, a jolt of several m/s2.
    """
    shifting = box.shift_left_s > 0.0
    asked = shift_ramp(p, box) * throttle if shifting else throttle
    if box.lever_adopted != 0.0 or box.clutch <= p.bite_closed:
        return asked
    coming = gear_ratio(p, box.wanted_gear if shifting else box.gear) * wheel_radps
    if not shifting and box.gear != 0.0:
        beyond = engine_radps - held_speed(p, coming, throttle)
        asked = asked * clip(1.0 - beyond * (1.0 / CUT_BAND_RADPS), 0.0, 1.0)
    if coming < p.lock_from_radps:
        return asked
    blip = clip((coming - engine_radps) * (1.0 / BLIP_BAND_RADPS), 0.0, BLIP_MOST)
    return blip if blip > asked else asked


@kernel
def by_automatic(
    p: GearParameters, box: Gearbox, wanted: float, request: Request, turning: Turning, step_s: float
) -> Gearbox:
    """Return the gearbox under the automatic: a shift opens the clutch, changes the gear half-way and closes again."""
    gear = box.gear
    left = box.shift_left_s
    target = box.wanted_gear
    since = clip(box.since_shift_s + step_s, 0.0, 10.0)
    if left > 0.0:
        left -= step_s
        if left < 0.5 * p.shift_s:
            gear = target
        if left <= 0.0:
            left = 0.0
            since = 0.0
    elif wanted != gear:
        target = wanted
        left = p.shift_s
    shifted = Gearbox(
        gear=gear,
        clutch=box.clutch,
        lever_adopted=0.0,
        wanted_gear=target,
        shift_left_s=left,
        since_shift_s=since,
        gear_fault=0.0,
    )
    clutch = automatic_clutch(p, shifted, request, turning, step_s)
    # No conditional expression within the call: Python 3.12 and later compile a call for each branch, and numba does
    # not unify their types.
    fault = 0.0
    if turning.hot != 0.0:
        fault += GearFault.CLUTCH_HOT
    return Gearbox(
        gear=gear,
        clutch=clutch,
        lever_adopted=0.0,
        wanted_gear=target,
        shift_left_s=left,
        since_shift_s=since,
        gear_fault=fault,
    )


@kernel
def gearbox_step(p: GearParameters, box: Gearbox, request: Request, turning: Turning, step_s: float) -> Gearbox:
    """Advance clutch and gears by one step: automatic, person, or the wait in between."""
    if request.automatic != 0.0:
        wanted = gear_for(p, box, request.gear, request.throttle, turning.vx_mps)
        return by_automatic(p, box, wanted, request, turning, step_s)
    closed = box.gear == 0.0 or (box.clutch <= p.bite_closed and box.shift_left_s <= 0.0)
    taken_back = request.clutch >= p.bite_open or (request.gear == box.gear and closed)
    if box.lever_adopted != 0.0 or taken_back:
        return by_person(p, box, request.gear, request.clutch, turning.engine_radps, turning.wheel_radps)
    kept = by_automatic(p, box, box.gear, request, turning, step_s)
    clutch = request.clutch if request.clutch > kept.clutch else kept.clutch
    return Gearbox(
        gear=kept.gear,
        clutch=clutch,
        lever_adopted=0.0,
        wanted_gear=kept.wanted_gear,
        shift_left_s=kept.shift_left_s,
        since_shift_s=kept.since_shift_s,
        gear_fault=kept.gear_fault,
    )
