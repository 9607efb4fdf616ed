"""A second implementation of who drives, written from docs/modes.md, docs/can.md and the profile's comments.

It shares no code with simconsole/control and sees no state of it: from the inputs alone it keeps its own ages, runs and
waits, and says which mode each tick must end in. What is present is a row of flags; a mode is judged by what it bears.
"""

import math

from simconsole.values.kernels import Row, kernel
from simconsole.values.signals import NEVER_TICKS, Arbitration, DriverInput, RemoteCommand, VehicleState
from tests.control.oracle_acts import all_finite, hands_count, note_loss, note_whose
from tests.control.oracle_rules import (
    AGE,
    ARMED,
    ASKED,
    AUTONOMOUS,
    AUTONOMOUS_ASKED,
    B_AUTONOMOUS,
    B_MANUAL,
    B_RESET,
    B_SHARED,
    B_STOP,
    B_TAKEOVER,
    BRAKE,
    BY_REQUEST,
    COMMAND_INVALID,
    COMMAND_STALE,
    COMMANDER_LOST,
    COUNT,
    DEVICE_LOST,
    E_AUTONOMOUS,
    E_LEFT,
    E_MANUAL,
    E_NO_ANSWER,
    E_RESET,
    E_SHARED,
    E_STALL,
    E_STOP,
    E_TAKEOVER,
    ECU,
    ECU_AT,
    EFFECT,
    EMERGENCY,
    EMERGENCY_STOP,
    FRESH,
    GOOD,
    INVALID,
    LAST_KIND,
    LIVE,
    LOOP_STALL,
    MANUAL,
    MANUAL_ASKED,
    MINIMAL,
    MODE,
    NO_REACTION,
    NOBODY,
    PARKED,
    PERSON_READY,
    QUIET,
    RECEIVED,
    REFERENCE,
    REFERRED,
    REFUSED,
    RESET,
    ROS,
    ROS_AT,
    RUN,
    SEEN,
    SHARED,
    SHARED_ASKED,
    SINCE,
    SPEED_KIND,
    STALE,
    STANDING,
    STANDSTILL,
    STEADY,
    STEERING,
    STOPPED,
    TAKEOVER,
    TAKEOVER_ASKED,
    TURNED,
    TWIST_KIND,
    WAIT,
    WHO,
    WIDTH,
    WILD,
    Rules,
)


@kernel
def has(mask: float, bit: float) -> bool:
    """Return whether a mask, a whole number, holds a bit."""
    return int(mask) & int(bit) != 0


@kernel
def is_wild(command: RemoteCommand, speed_mps: float, r: Rules) -> bool:
    """Return whether a finite command steers harder than anybody can mean at this speed."""
    if command.kind == TWIST_KIND:
        return abs(speed_mps * command.yaw_rate_radps) > r.wild_mps2
    return abs(speed_mps * speed_mps * math.tan(command.road_wheel_rad) / r.wheelbase_m) > r.wild_mps2


@kernel
def hear(o: Row, at: int, command: RemoteCommand, speed_mps: float, r: Rules) -> None:
    """Take in what one controller has said by this tick."""
    known = 1.0 <= command.kind <= LAST_KIND and command.kind == float(int(command.kind))
    finite = all_finite(command)
    wild = finite and known and is_wild(command, speed_mps, r)
    plausible = finite and known and not wild
    came = finite and command.sequence > o[at + SEEN]
    refused = command.refused - o[at + REFUSED] if finite else 0.0
    if finite:  # what is refused meanwhile counts when a finite one comes
        o[at + SEEN], o[at + REFUSED] = command.sequence, command.refused
    if plausible:
        o[at + AGE] = command.age_ticks
        o[at + RECEIVED] = command.age_ticks
    else:
        o[at + AGE] += 1.0
        o[at + RECEIVED] += 1.0
    if came and plausible:
        o[at + RUN] = 0.0
    else:
        o[at + RUN] += refused + (1.0 if came and wild else 0.0)
    fresh = finite and known and command.age_ticks < r.stale_ticks
    o[at + WILD] = 1.0 if wild else 0.0
    o[at + FRESH] = 1.0 if fresh else 0.0
    o[at + STALE] = 0.0 if known and command.age_ticks < r.stale_ticks else 1.0
    o[at + INVALID] = 0.0
    if not finite or o[at + RUN] >= r.invalid_most or (wild and fresh and o[at + AGE] >= r.stale_ticks):
        o[at + INVALID] = 1.0
    good = fresh and not wild and refused <= 0.0 and o[at + INVALID] == 0.0
    o[at + STEADY] = o[at + STEADY] + 1.0 if good else 0.0
    o[at + GOOD] = 1.0 if fresh and not wild and o[at + INVALID] == 0.0 else 0.0
    o[at + QUIET] = 0.0 if fresh else o[at + QUIET] + 1.0


@kernel
def choose(o: Row, who: float, r: Rules) -> bool:
    """Take in whose commands count, and return whether it may be them.

    While the remote side drives they are the same as before. Else one who is well and preferred comes first, one who is
    well before nobody, and nobody stays whose lease is over. When a lease ends that nothing good has renewed is left
    open here: no mode hangs on it.
    """
    if SHARED <= o[MODE] <= MINIMAL and o[WHO] != NOBODY:
        return bool(who == o[WHO])
    o[WHO] = who
    first, second = (ECU, ROS) if r.preferred == ECU else (ROS, ECU)
    first_at, second_at = (ECU_AT, ROS_AT) if r.preferred == ECU else (ROS_AT, ECU_AT)
    if o[first_at + GOOD] != 0.0:
        return who == first
    if who == first:
        return bool(o[first_at + QUIET] <= r.lease_ticks)
    if o[second_at + GOOD] != 0.0:
        return who == second
    return who == NOBODY or bool(o[second_at + QUIET] <= r.lease_ticks)


@kernel
def bears(mode: float, trigger: int, person_required: float) -> float:
    """Return the mode that a trigger which takes authority leaves of this one: the upper rows of the table."""
    automatic = mode in (AUTONOMOUS, TAKEOVER)
    if trigger == EMERGENCY:
        return EMERGENCY_STOP
    if trigger in (BRAKE, STEERING):
        return MANUAL if automatic or mode == MINIMAL else mode
    if trigger == MANUAL_ASKED:
        return mode if mode == EMERGENCY_STOP else MANUAL
    if trigger == LOOP_STALL:
        return MINIMAL if automatic or mode in (MANUAL, SHARED) else mode
    if trigger == DEVICE_LOST:
        if mode in (MANUAL, SHARED):
            return MINIMAL
        return TAKEOVER if mode == AUTONOMOUS and person_required != 0.0 else mode
    if trigger in (COMMANDER_LOST, COMMAND_STALE, COMMAND_INVALID):
        if mode == SHARED:
            return MANUAL
        return MINIMAL if automatic else mode
    if trigger == TAKEOVER_ASKED:
        if mode == SHARED:
            return MANUAL
        return TAKEOVER if mode == AUTONOMOUS else mode
    if trigger == NO_REACTION:
        return MINIMAL if mode == TAKEOVER else mode
    return mode


@kernel
def steps(mode: float, trigger: int) -> float:
    """Return the mode that a step towards driving or towards rest leads to: the lower rows of the table."""
    rests = mode in (PARKED, STOPPED)
    if trigger == MANUAL_ASKED and rests:
        return MANUAL
    if trigger == STANDSTILL and mode == MINIMAL:
        return STOPPED
    if trigger == RESET and (mode in (STOPPED, EMERGENCY_STOP)):
        return PARKED
    if trigger == AUTONOMOUS_ASKED and (rests or mode in (MANUAL, SHARED, TAKEOVER)):
        return AUTONOMOUS
    if trigger == SHARED_ASKED and (mode in (MANUAL, AUTONOMOUS)):
        return SHARED
    if trigger == PERSON_READY and mode == PARKED:
        return MANUAL
    return mode


@kernel
def turned(o: Row, driver: DriverInput, trusted: bool, explained: tuple[float, float, float], r: Rules) -> bool:
    """Return whether the person has taken the wheel; `explained` is the motor's angle and rate, and their own pull."""
    if not AUTONOMOUS <= o[MODE] <= MINIMAL:
        o[TURNED] = 0.0
        return False
    if driver.wheel_validity != ARMED and driver.wheel_validity != LIVE:
        o[TURNED] = o[REFERRED] = 0.0
        return False
    if o[REFERRED] == 0.0:
        o[REFERENCE], o[REFERRED], o[TURNED] = driver.hand_wheel_rad - explained[0], 1.0, 0.0
        return False
    moved = abs(driver.hand_wheel_rad - explained[0] - o[REFERENCE])
    far = moved > (r.moved_still_rad if o[TURNED] > 0.0 else r.moved_rad)
    fast = abs(driver.hand_wheel_radps - explained[1]) > r.turned_radps
    pulled = explained[2] > r.pulled_nm
    o[TURNED] = o[TURNED] + 1.0 if far or fast or pulled else 0.0
    return bool(trusted and o[TURNED] > r.turned_ticks)


@kernel
def may_engage(
    o: Row, at: int, command: RemoteCommand, asked_rad: float, driver: DriverInput, vehicle: VehicleState, r: Rules
) -> bool:
    """Return whether the controller may be given the car now, as far as car and commands say."""
    enough = r.steady_again_ticks if o[MODE] >= TAKEOVER else r.steady_ticks
    if o[at + FRESH] == 0.0 or o[at + INVALID] != 0.0 or o[at + STEADY] < enough:
        return False
    if driver.brake >= r.brake or abs(vehicle.vx_mps) > r.fast_mps or abs(vehicle.ay_mps2) > r.cornering_mps2:
        return False
    says_speed = command.kind == SPEED_KIND or command.kind == TWIST_KIND
    if says_speed and abs(command.speed_mps - vehicle.vx_mps) > r.apart_mps:
        return False
    apart = abs(asked_rad - vehicle.road_wheel_rad)
    return not (abs(vehicle.vx_mps) > r.apart_above_mps and apart > r.apart_rad)


@kernel
def gather(
    o: Row,
    present: Row,
    driver: DriverInput,
    events: float,
    ecu_events: float,
    ros: RemoteCommand,
    ecu: RemoteCommand,
    vehicle: VehicleState,
    explained: tuple[float, float, float],
    seen: Arbitration,
    r: Rules,
) -> None:
    """Write 1 for every trigger that is present. Of `seen` only the angle that the controller asks for is read."""
    who = o[WHO]
    heard = ecu_events if who == ECU else float(int(ecu_events) & int(E_STOP))
    mask = float(int(events if who != ECU else float(int(events) & ~(int(E_LEFT) | int(E_NO_ANSWER)))) | int(heard))
    edges = driver.edges
    mode = o[MODE]
    trusted = (
        (driver.wheel_validity == ARMED or driver.wheel_validity == LIVE)
        and (driver.throttle_validity == ARMED or driver.throttle_validity == LIVE)
        and (driver.brake_validity == ARMED or driver.brake_validity == LIVE)
    )
    released = driver.throttle < r.accelerator
    for trigger in range(COUNT):
        present[trigger] = 0.0
    stop = has(driver.pressed, B_STOP) or has(edges, B_STOP) or has(mask, E_STOP)
    present[EMERGENCY] = 1.0 if stop else 0.0
    hands = hands_count(o, trusted, r)
    note_whose(o, mask, edges, driver.pressed)
    present[BRAKE] = 1.0 if trusted and driver.brake >= r.brake and hands else 0.0
    present[STEERING] = 1.0 if turned(o, driver, trusted, explained, r) and hands else 0.0
    rests = mode in (PARKED, STOPPED)
    wants_manual = has(mask, E_MANUAL) or has(edges, B_MANUAL)
    present[MANUAL_ASKED] = 1.0 if wants_manual and trusted and (released or not rests) else 0.0
    present[LOOP_STALL] = 1.0 if has(mask, E_STALL) else 0.0
    present[DEVICE_LOST] = 0.0 if trusted else 1.0
    present[COMMANDER_LOST] = 1.0 if has(mask, E_LEFT) else 0.0
    at = ECU_AT if who == ECU else ROS_AT
    if who != NOBODY:
        silent = o[at + STALE] != 0.0 or has(mask, E_NO_ANSWER)
        present[COMMAND_STALE] = 1.0 if silent and o[at + INVALID] == 0.0 else 0.0
        present[COMMAND_INVALID] = o[at + INVALID]
    present[TAKEOVER_ASKED] = 1.0 if has(mask, E_TAKEOVER) or has(edges, B_TAKEOVER) else 0.0
    if mode == TAKEOVER and o[WAIT] + 1.0 >= r.no_reaction_ticks and (o[BY_REQUEST] != 0.0 or not trusted):
        present[NO_REACTION] = 1.0
    o[STANDING] = o[STANDING] + 1.0 if abs(vehicle.vx_mps) <= r.stands_mps else 0.0
    stands = o[STANDING] >= r.stands_ticks
    present[STANDSTILL] = 1.0 if stands else 0.0
    wants_reset = has(mask, E_RESET) or has(edges, B_RESET)
    present[RESET] = 1.0 if wants_reset and stands and not stop else 0.0
    command = ecu if who == ECU else ros
    asked_rad = seen.ecu_road_wheel_rad if who == ECU else seen.ros_road_wheel_rad
    engages = who != NOBODY and may_engage(o, at, command, asked_rad, driver, vehicle, r)
    wants_autonomy = has(mask, E_AUTONOMOUS) or has(edges, B_AUTONOMOUS)
    wants_shared = has(mask, E_SHARED) or has(edges, B_SHARED)
    present[AUTONOMOUS_ASKED] = 1.0 if wants_autonomy and engages and (trusted or r.person_required == 0.0) else 0.0
    present[SHARED_ASKED] = 1.0 if wants_shared and engages and trusted else 0.0
    present[PERSON_READY] = 1.0 if trusted and released else 0.0
    wants = 1.0 if wants_autonomy else 0.0
    wants += 2.0 if wants_shared else 0.0
    wants += 4.0 if wants_manual else 0.0
    o[ASKED] = wants + (8.0 if wants_reset else 0.0)


@kernel
def withstands(mode: float, present: Row, person_required: float) -> bool:
    """Return whether no trigger that takes authority would change this mode."""
    for trigger in range(STANDSTILL):
        step = trigger == MANUAL_ASKED and (mode in (PARKED, STOPPED))
        if present[trigger] != 0.0 and not step and bears(mode, trigger, person_required) != mode:
            return False
    return True


@kernel
def settle(o: Row, present: Row, r: Rules) -> None:
    """Find the mode that this tick ends in, and begin the waits that belong to it."""
    before = mode = o[MODE]
    effect = -1
    rests = mode in (PARKED, STOPPED)
    requested = False
    for trigger in range(STANDSTILL):
        if present[trigger] == 0.0 or (trigger == MANUAL_ASKED and rests):
            continue
        after = bears(mode, trigger, r.person_required)
        if trigger == TAKEOVER_ASKED and after == TAKEOVER:
            requested = True
        if after != mode:
            effect, mode = trigger, after
    if effect < 0:
        for trigger in range(MANUAL_ASKED, COUNT):
            step = trigger >= STANDSTILL or trigger == MANUAL_ASKED
            after = steps(mode, trigger)
            if step and present[trigger] != 0.0 and after != mode and withstands(after, present, r.person_required):
                effect, mode = trigger, after
                break
    o[SINCE] = 0.0 if mode != before else o[SINCE] + 1.0
    o[WAIT] += 1.0
    if mode == TAKEOVER and before != TAKEOVER:
        o[WAIT] = 0.0
        o[BY_REQUEST] = 1.0 if requested else 0.0
        effect = TAKEOVER_ASKED if requested else effect
    elif mode == TAKEOVER and requested and o[BY_REQUEST] == 0.0:
        o[BY_REQUEST] = 1.0
        o[WAIT] = o[WAIT] if present[DEVICE_LOST] != 0.0 else 0.0
        effect = TAKEOVER_ASKED
    o[MODE], o[EFFECT] = mode, float(effect)
    note_loss(o)


@kernel
def foresee(
    o: Row,
    present: Row,
    driver: DriverInput,
    events: float,
    ecu_events: float,
    ros: RemoteCommand,
    ecu: RemoteCommand,
    vehicle: VehicleState,
    explained: tuple[float, float, float],
    seen: Arbitration,
    r: Rules,
) -> bool:
    """Take one tick: leave in `o[MODE]` the mode that it must end in, and in `present` what was present.

    Returns whether the commander is one that may be it.
    """
    hear(o, ROS_AT, ros, vehicle.vx_mps, r)
    hear(o, ECU_AT, ecu, vehicle.vx_mps, r)
    known = choose(o, seen.commander, r)
    before = o[MODE]
    gather(o, present, driver, events, ecu_events, ros, ecu, vehicle, explained, seen, r)
    settle(o, present, r)
    if not AUTONOMOUS <= before <= MINIMAL and AUTONOMOUS <= o[MODE] <= MINIMAL:
        there = driver.wheel_validity == ARMED or driver.wheel_validity == LIVE
        o[REFERENCE], o[REFERRED], o[TURNED] = driver.hand_wheel_rad - explained[0], 1.0 if there else 0.0, 0.0
    return known


@kernel
def blank(o: Row) -> None:
    """Begin: parked, and nothing was ever heard."""
    for index in range(WIDTH):
        o[index] = 0.0
    for at in (ROS_AT, ECU_AT):
        o[at + AGE] = o[at + RECEIVED] = o[at + QUIET] = NEVER_TICKS
