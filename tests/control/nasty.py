"""Inputs of the walk: quiet stretches in which modes last, and storms in which everything comes in one tick.

What comes next is drawn tick by tick from uniform numbers, and may depend on the mode that the drive is in: a latched
stop is worth less of the walk's time than a mode with much to go wrong.
"""

import math
from typing import Final

import numpy as np

from simconsole.values.kernels import Row, kernel
from simconsole.values.signals import (
    NEVER_TICKS,
    Button,
    DriverInput,
    Event,
    Mode,
    RemoteCommand,
    RemoteKind,
    Validity,
    VehicleState,
)

MANUAL, STOPPED = float(Mode.MANUAL), float(Mode.STOPPED)
LIVE, LOST = float(Validity.LIVE), float(Validity.LOST)
ACCELERATION, SPEED, TWIST, POSE = (
    float(kind) for kind in (RemoteKind.ACCELERATION, RemoteKind.SPEED, RemoteKind.TWIST, RemoteKind.POSE)
)

STOP_BUTTON: Final = int(Button.EMERGENCY_STOP.value)
ASK_AUTONOMOUS: Final = int(Event.REQUEST_AUTONOMOUS.value)
ASK_SHARED: Final = int(Event.REQUEST_SHARED.value)
RESET_EVENT: Final = int(Event.RESET.value)
EVENTS: Final = np.array([float(event) for event in Event])
COMMON: Final = np.array(
    [float(Event.REQUEST_AUTONOMOUS)] * 7
    + [float(Event.REQUEST_SHARED)] * 3
    + [float(Event.RESET)] * 2
    + [float(Event.REQUEST_MANUAL), float(Event.REQUEST_TAKEOVER), float(Event.REQUEST_TAKEOVER)]
)
BUTTONS: Final = np.array(
    [
        float(button)
        for button in (
            *(Button.AUTONOMOUS, Button.AUTONOMOUS, Button.MANUAL, Button.EMERGENCY_STOP, Button.RESET),
            *(Button.TAKEOVER, Button.SHARED, Button.RESTART, Button.MARK, Button.HAZARD),
        )
    ]
)
VALIDITIES: Final = np.array([float(validity) for validity in Validity])
LASTS_S: Final = np.array([0.0, 0.0, 0.02, 0.05, 0.06, 0.2, 0.5, 1.0, 1.0, 3.0])
PEDALS: Final = np.array([0.03, 0.045, 0.06, 0.3, 1.0])
SPEEDS_MPS: Final = np.array([0.0, 0.0, 0.05, 0.5, 3.0, 8.0, 8.0, 14.0, 24.0, 30.0, -1.5])
PERIODS_S: Final = np.array([0.0, 0.01, 0.02, 0.02, 0.05, 0.1, 0.16, 0.19, 0.195, 0.198, 0.2, 0.21, 0.3])
KINDS: Final = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 3.0, 4.0, 5.0])
STRANGE_KINDS: Final = np.array([0.0, 2.5, 9.0, -1.0])
NASTY: Final = np.array([math.nan, math.inf, -math.inf])
GOOD, CALM, WILD, MISSING, REFUSED, LATE, NOT_FINITE, STRANGE = range(8)
PATTERN_LENGTH: Final = 6

DRAWS: Final = 50
"""Uniform numbers that one tick uses."""

# The generator's state: the person's, the vehicle's, then a block for each controller.
LEFT, NERVE, WHEEL, RATE, RATE_LEFT, THROTTLE, THROTTLE_LEFT, BRAKE, BRAKE_LEFT = range(9)
STOP_LEFT, WHEEL_VALID, WHEEL_LEFT, GAS_VALID, GAS_LEFT, BRAKE_VALID, BRAKE_VALID_LEFT = range(9, 16)
GIVEN, GIVEN_LEFT, AY, SPEED_NOW, EXPLAINED, EVENT_MASK, ECU_MASK, EDGES, PRESSED, HUMAN = range(16, 26)
ROS_AT: Final = 26
PERIOD, TO_NEXT, CYCLE, SEQUENCE, REFUSALS, RECEIPT, KIND, STEER, TARGET, ACCEL, PATTERN_AT = range(11)
BLOCK: Final = 11 + PATTERN_LENGTH
ECU_AT: Final = ROS_AT + BLOCK
STATE: Final = ECU_AT + BLOCK
DRIVER_WIDTH: Final = len(DriverInput._fields)
VEHICLE_WIDTH: Final = len(VehicleState._fields)
REMOTE_WIDTH: Final = len(RemoteCommand._fields)


@kernel
def pick(values: Row, u: float) -> float:
    """Return the value that a uniform number falls on."""
    return float(values[int(u * len(values))])


@kernel
def fresh_start(g: Row) -> None:
    """Begin a drive: nobody has said anything, everything is there."""
    for index in range(STATE):
        g[index] = 0.0
    g[WHEEL_VALID] = g[GAS_VALID] = g[BRAKE_VALID] = LIVE
    for at in (ROS_AT, ECU_AT):
        g[at + RECEIPT] = NEVER_TICKS


@kernel
def held(g: Row, value_at: int, left_at: int, rest: float) -> None:
    """Let what was begun last, and end."""
    if g[left_at] > 0.0:
        g[left_at] -= 1.0
        if g[left_at] <= 0.0:
            g[value_at] = rest


@kernel
def person(g: Row, u: Row, storm: bool, chance: float, hz: float) -> None:
    """Move the person's hands and feet, and let their devices come and go."""
    held(g, THROTTLE, THROTTLE_LEFT, 0.0)
    held(g, BRAKE, BRAKE_LEFT, 0.0)
    held(g, RATE, RATE_LEFT, 0.0)
    held(g, PRESSED, STOP_LEFT, 0.0)
    held(g, WHEEL_VALID, WHEEL_LEFT, LIVE)
    held(g, GAS_VALID, GAS_LEFT, LIVE)
    held(g, BRAKE_VALID, BRAKE_VALID_LEFT, LIVE)
    lasts = 1.0 + float(int(pick(LASTS_S, u[1]) * hz))
    if u[2] < chance:
        g[THROTTLE], g[THROTTLE_LEFT] = pick(PEDALS, u[3]), lasts
    if u[4] < 0.5 * chance:
        g[BRAKE], g[BRAKE_LEFT] = pick(PEDALS, u[5]), 1.0 if storm else lasts
    if u[6] < chance:
        g[WHEEL] += (u[7] - 0.5) * 0.6
    if u[6] > 1.0 - 0.5 * chance:
        g[WHEEL] = 0.0
    if u[8] < 0.5 * chance:
        g[RATE], g[RATE_LEFT] = (u[9] - 0.5) * 8.0, lasts
    g[WHEEL] = min(7.0, max(-7.0, g[WHEEL] + g[RATE] / hz))
    if u[10] < 0.5 * chance:
        validity = pick(VALIDITIES, u[11])
        which = u[12] * 4.0
        if which < 2.0 or which >= 3.5:
            g[WHEEL_VALID], g[WHEEL_LEFT] = validity, lasts
        if 2.0 <= which < 3.0 or which >= 3.5:
            g[GAS_VALID], g[GAS_LEFT] = validity, lasts
        if which >= 3.0:
            g[BRAKE_VALID], g[BRAKE_VALID_LEFT] = validity, lasts
    g[EDGES] = 0.0
    if u[13] < chance:
        g[EDGES] = pick(BUTTONS, u[14])
        if u[15] < 0.3:
            g[EDGES] = float(int(g[EDGES]) | int(pick(BUTTONS, u[15] / 0.3)))
    if g[EDGES] == float(int(g[EDGES]) | STOP_BUTTON) and g[EDGES] > 0.0:
        g[PRESSED], g[STOP_LEFT] = float(STOP_BUTTON), lasts
    if u[13] > 1.0 - 0.1 * chance:
        g[HUMAN] = (u[14] - 0.5) * 6.0
    if u[16] < 0.2 * chance:
        g[EXPLAINED] = (u[17] - 0.5) * 0.2


@kernel
def events(g: Row, u: Row, mode: float, storm: bool, chance: float, calm: float) -> None:
    """Raise edges of operators, the console and the ECU."""
    mask = 0
    if u[18] < chance:
        mask |= int(pick(COMMON, u[19]))
    if storm:
        for index in range(5):
            if u[20 + index] < 0.4:
                mask |= int(pick(EVENTS, u[20 + index] / 0.4))
    elif u[20] < 0.3 * chance:
        mask |= int(pick(EVENTS, u[21]))
    if mode >= STOPPED and u[22] < 0.02:
        mask |= RESET_EVENT
    if mode <= MANUAL and u[23] < 2.0 * calm:
        mask |= ASK_SHARED if u[24] < 0.3 else ASK_AUTONOMOUS
    g[EVENT_MASK] = float(mask)
    mask = 0
    if u[25] < 0.5 * chance:
        mask |= int(pick(EVENTS if u[25] < 0.2 * chance else COMMON, u[26]))
        if storm and u[27] < 0.5:
            mask |= int(pick(EVENTS, u[27] * 2.0))
    g[ECU_MASK] = float(mask)


@kernel
def controller(g: Row, at: int, u: Row, first: int, hz: float, stale_ticks: float, changes: float) -> RemoteCommand:
    """Say what one controller sends: a cycle of good, wild, missing, refused, late, non-finite and strange commands."""
    if u[first] < changes or g[at + PERIOD] == 0.0:
        v = u[first + 1]
        g[at + PERIOD] = 1.0 + float(int(pick(PERIODS_S, u[first + 2]) * hz))
        if v > 0.8:  # just inside and just outside of what counts as silence
            g[at + PERIOD] = max(1.0, stale_ticks + float(int((v - 0.8) * 30.0)) - 3.0)
        if v < 0.5:
            g[at + PERIOD] = max(1.0, float(int(0.02 * hz)))
        nasty = u[first + 3]
        for index in range(PATTERN_LENGTH):
            spread = u[first + 4] * 977.0 + u[first + 5] * 131.0 * float(index + 1)
            spread -= float(int(spread))
            g[at + PATTERN_AT + index] = GOOD if nasty < 0.6 or spread < 0.4 else float(int(spread * 8.0))
        if nasty > 0.9:  # one kind of fault all the time, but for the first
            for index in range(1, PATTERN_LENGTH):
                g[at + PATTERN_AT + index] = float(int(u[first + 4] * 8.0))
    g[at + RECEIPT] += 1.0
    g[at + TO_NEXT] -= 1.0
    if g[at + TO_NEXT] <= 0.0:
        g[at + TO_NEXT] = g[at + PERIOD]
        g[at + CYCLE] += 1.0
        if g[at + CYCLE] >= PATTERN_LENGTH:
            g[at + CYCLE] = 0.0
        send(g, at, g[at + PATTERN_AT + int(g[at + CYCLE])], u, first, stale_ticks)
    kind = g[at + KIND]
    twist = kind == TWIST
    return RemoteCommand(
        kind,
        g[at + SEQUENCE],
        g[at + REFUSALS],
        g[at + RECEIPT],
        0.0 if twist or kind == POSE else g[at + STEER],
        0.0,
        g[at + TARGET],
        g[at + ACCEL],
        g[at + STEER] if twist else 0.0,
        0.5 if g[at + ACCEL] > 0.0 else 0.0,
        0.0 if g[at + ACCEL] > 0.0 else 0.3,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
    )


@kernel
def send(g: Row, at: int, what: float, u: Row, first: int, stale_ticks: float) -> None:
    """Send one command of a kind of good or bad, or none."""
    if what == MISSING:
        return
    if what == REFUSED:
        g[at + REFUSALS] += 1.0 + float(int(u[first + 6] * 2.0))
        return
    g[at + SEQUENCE] += 1.0
    g[at + RECEIPT] = 0.0
    if what == LATE:
        g[at + RECEIPT] = float(int(u[first + 6] * 1.6 * stale_ticks))
    g[at + KIND] = pick(KINDS, u[first + 7])
    if what == STRANGE:
        g[at + KIND] = pick(STRANGE_KINDS, u[first + 7])
    speed = g[SPEED_NOW]
    g[at + STEER] = (u[first + 8] - 0.5) * 0.1
    if what == WILD or u[first + 8] > 0.97:
        g[at + STEER] = (u[first + 6] - 0.5) * 2.4
    g[at + TARGET] = speed + (u[first + 6] - 0.4) * 6.0
    g[at + ACCEL] = (u[first + 5] - 0.45) * 3.0
    if what == NOT_FINITE:
        value = pick(NASTY, u[first + 6])
        if u[first + 8] < 0.5:
            g[at + ACCEL] = value
        else:
            g[at + STEER] = value


@kernel
def draw(g: Row, u: Row, hz: float, stop_s: float) -> tuple[float, float]:
    """Draw the tick's phase: how much happens (the chance of one thing) and whether this tick is a storm."""
    g[LEFT] -= 1.0
    if g[LEFT] <= 0.0:
        g[NERVE] = float(int(u[0] * 4.0))
        g[LEFT] = 1.0 + float(int(hz * (0.05 + stop_s * 1.3 * u[1] * u[1])))
        if g[NERVE] > 0.0:
            g[LEFT] = 1.0 + float(int(hz * 0.5 * u[1]))
    if g[NERVE] == 0.0:
        return 0.0, 0.0
    if g[NERVE] == 1.0:
        return 0.6 / hz, 0.0
    if g[NERVE] == 2.0:
        return 4.0 / hz, 1.0 if u[0] < 1.0 / hz else 0.0
    return 8.0 / hz, 1.0 if u[0] < 4.0 / hz else 0.0


@kernel
def move(g: Row, u: Row, chance: float, hz: float, throttle: float, brake: float) -> None:
    """Let the vehicle follow its pedals, or be at a speed of its own for a while."""
    if g[GIVEN_LEFT] > 0.0:
        g[GIVEN_LEFT] -= 1.0
        g[SPEED_NOW] = g[GIVEN]
    else:
        g[SPEED_NOW] = max(0.0, g[SPEED_NOW] + (4.0 * throttle - 9.0 * brake - 0.2) / hz)
        if g[SPEED_NOW] > 30.0:
            g[SPEED_NOW] = 30.0
    if u[46] < 0.5 * chance:
        g[GIVEN] = pick(SPEEDS_MPS, u[47])
        g[GIVEN_LEFT] = 1.0 + (float(int(u[48] * hz)) if u[47] < 0.9 else 0.0)
    if u[46] > 1.0 - 0.3 * chance:
        g[AY] = 3.0 if u[47] < 0.2 else 0.0
