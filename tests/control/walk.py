"""One long walk over arbitration and gate beside the oracle: every tick is foreseen, and compared."""

from typing import Final

from simconsole.control.arbitration import arbitrate
from simconsole.control.gate import gate
from simconsole.control.requests.tick_context import TickContext
from simconsole.values.kernels import Row, is_finite, kernel, put
from simconsole.values.layout import Part, read, write
from simconsole.values.signals import (
    ArbiterMemory,
    Arbitration,
    DriverInput,
    EventInput,
    Reason,
    RemoteCommand,
    Validity,
    VehicleCommand,
    VehicleState,
)
from tests.control.nasty import (
    AY,
    BRAKE,
    BRAKE_VALID,
    ECU_AT,
    ECU_MASK,
    EDGES,
    EVENT_MASK,
    EXPLAINED,
    GAS_VALID,
    HUMAN,
    PRESSED,
    RATE,
    REFUSALS,
    ROS_AT,
    SPEED_NOW,
    THROTTLE,
    WHEEL,
    WHEEL_VALID,
    controller,
    draw,
    events,
    move,
    person,
)
from tests.control.oracle import foresee, has
from tests.control.oracle_acts import told_reason
from tests.control.oracle_rules import (
    ASKED,
    AUTONOMOUS,
    AUTONOMOUS_ASKED,
    B_RESTART,
    BLOCK,
    COUNT,
    E_RESTART,
    ECU,
    EFFECT,
    EMERGENCY,
    EMERGENCY_STOP,
    MANUAL,
    MANUAL_ASKED,
    MODE,
    PARKED,
    RECEIVED,
    RESET,
    RUN,
    SHARED,
    SHARED_ASKED,
    STOPPED,
    TAKEOVER,
    WHO,
    WILD,
    Rules,
)
from tests.control.random_drives import ARBITRATION, COMMAND, ECU_LINK, MEMORY, ROS_LINK, SETTINGS

RULES: Final = Part(Rules)
MODE_AT: Final = ARBITRATION.at("mode")
STEERED_AT, THROTTLE_AT, BRAKE_AT = (COMMAND.at(name) for name in ("road_wheel_rad", "throttle", "brake"))
LIVE: Final = float(Validity.LIVE)
PERSON_ASKED, OPERATOR_ASKED = float(Reason.PERSON_ASKED), float(Reason.OPERATOR_ASKED)
MODES: Final = 8
COLUMNS: Final = (
    *("tick", "mode before", "events", "ecu_events", "explained_rad", "speed_mps", "ay_mps2"),
    *(f"driver.{name}" for name in DriverInput._fields),
    *(f"ros.{name}" for name in RemoteCommand._fields),
    *(f"ecu.{name}" for name in RemoteCommand._fields),
)
DRIVER_COLUMN: Final = 7
ROS_COLUMN: Final = DRIVER_COLUMN + len(DriverInput._fields)
ECU_COLUMN: Final = ROS_COLUMN + len(RemoteCommand._fields)
RECENT: Final = 3
RESTART_TICKS: Final = ArbiterMemory._fields.index("restart_ticks")

BREACHES: Final = (
    *("none", "mode", "reason", "emergency not at once", "emergency not latched", "autonomy not granted"),
    *("no refusal shown", "commander", "not finite", "too long after the last plausible command"),
    *("throttle follows an implausible command", "refusal out of nothing"),
)
MODE_BREACH, REASON_BREACH, NOT_AT_ONCE, NOT_LATCHED, NOT_GRANTED = 1.0, 2.0, 3.0, 4.0, 5.0
NO_REFUSAL, COMMANDER_BREACH, INFINITE, TOO_LONG, FOLLOWED, FROM_NOTHING = 6.0, 7.0, 8.0, 9.0, 10.0, 11.0


@kernel
def is_refused(o: Row, present: Row, before: float) -> bool:
    """Return whether something was asked for in this tick that it does not end in."""
    asked, mode = o[ASKED], o[MODE]
    if has(asked, 1.0) and mode != AUTONOMOUS:
        return True
    if has(asked, 2.0) and mode != SHARED:
        return True
    if has(asked, 4.0) and mode != MANUAL and o[EFFECT] <= MANUAL_ASKED:
        return True
    return has(asked, 8.0) and before >= STOPPED and mode != PARKED


@kernel
def judge(
    o: Row,
    present: Row,
    before: Row,
    arbitration: Arbitration,
    command: VehicleCommand,
    driver: DriverInput,
    new_refusal: bool,
    nothing_asked: bool,
    may_command: bool,
    r: Rules,
) -> float:
    """Return the breach of this tick, 0 for none. `before` is the row of the tick before."""
    mode = arbitration.mode
    was = read(before, ARBITRATION)
    if present[EMERGENCY] != 0.0 and mode != EMERGENCY_STOP:
        return NOT_AT_ONCE
    if was.mode == EMERGENCY_STOP and mode != EMERGENCY_STOP and present[RESET] == 0.0:
        return NOT_LATCHED
    if mode == AUTONOMOUS and was.mode != AUTONOMOUS and present[AUTONOMOUS_ASKED] == 0.0:
        return NOT_GRANTED
    if mode == SHARED and was.mode != SHARED and present[SHARED_ASKED] == 0.0:
        return NOT_GRANTED
    if mode != o[MODE]:
        return MODE_BREACH
    if not may_command:
        return COMMANDER_BREACH
    effect = int(o[EFFECT])
    if effect >= 0:
        expected = told_reason(o)
        if arbitration.reason != expected and not (expected == PERSON_ASKED and arbitration.reason == OPERATOR_ASKED):
            return REASON_BREACH
    elif arbitration.reason != was.reason:
        return REASON_BREACH
    if is_refused(o, present, was.mode) and arbitration.refusal == 0.0:
        return NO_REFUSAL
    at = BLOCK if o[WHO] == ECU else 0
    if new_refusal and nothing_asked and o[at + WILD] == 0.0:
        return FROM_NOTHING
    for value in arbitration:
        if not is_finite(value):
            return INFINITE
    for value in command:
        if not is_finite(value):
            return INFINITE
    driven = SHARED <= mode <= TAKEOVER
    if driven and o[at + RECEIVED] > r.leaves_ticks:
        return TOO_LONG
    if driven and o[at + WILD] != 0.0 and driver.throttle == 0.0:
        held = before[THROTTLE_AT]
        held = was.remote_throttle if was.remote_throttle > held else held  # authority may still fade in towards it
        if command.throttle > held + 1e-12:
            return FOLLOWED
    return 0.0


@kernel
def happen(g: Row, u: Row, o: Row, before: Row, figures: Row, hz: float, r: Rules) -> None:
    """Let a tick's person, events and vehicle happen."""
    mode = before[MODE_AT]
    chance, storm = draw(g, u, hz, figures[5])
    at = BLOCK if o[WHO] == ECU else 0
    ends = mode == TAKEOVER and abs(before[0] + 1.0 - r.no_reaction_ticks) < 1.5
    ends = ends or (SHARED <= mode <= TAKEOVER and o[at + RUN] >= r.invalid_most - 2.0)
    if ends and u[0] < 0.3:  # what comes in the very tick in which a wait runs out is worth a storm
        storm = 1.0
    if mode == TAKEOVER and (u[49] < 0.3 / hz or (ends and u[49] < 0.2)):  # short, and all may happen in it
        storm = 1.0
        g[(ECU_AT if o[WHO] == ECU else ROS_AT) + REFUSALS] += r.invalid_most
    person(g, u, storm > 0.0, 0.3 if storm > 0.0 else chance, hz)
    events(g, u, mode, storm > 0.0, 0.5 if storm > 0.0 else chance, 1.0 / hz)
    move(g, u, chance, hz, before[THROTTLE_AT], before[BRAKE_AT])


@kernel
def driver_of(g: Row) -> DriverInput:
    """Return the person as the cockpit reads them."""
    return DriverInput(
        g[WHEEL], g[RATE], g[THROTTLE], g[BRAKE], 0.0, 0.0, 1.0,
        float(int(g[PRESSED]) | int(g[EDGES])), g[EDGES], g[WHEEL_VALID], g[GAS_VALID], g[BRAKE_VALID],
        LIVE, LIVE, 0.0, 0.0, 0.0, LIVE,
    )  # fmt: skip


@kernel
def vehicle_of(g: Row, before: Row) -> VehicleState:
    """Return the vehicle after the tick before."""
    return VehicleState(
        0.0, 0.0, 0.0, 0.0, 0.0, 0.0, g[SPEED_NOW], 0.0, 0.0, 0.0, g[AY], before[STEERED_AT], 0.0, 0.0, 1.0, 1.0,
        0.0, 0.0, -0.2, 3.8, -9.2, 0.0,
    )  # fmt: skip


@kernel
def note(
    given: Row, g: Row, figures: Row, mode: float, driver: DriverInput, ros: RemoteCommand, ecu: RemoteCommand
) -> None:
    """Write down what came in, for whoever reads of a breach."""
    given[0], given[1], given[2], given[3] = figures[0], mode, g[EVENT_MASK], g[ECU_MASK]
    given[4], given[5], given[6] = g[EXPLAINED] * figures[2], g[SPEED_NOW], g[AY]
    put(given, DRIVER_COLUMN, driver)
    put(given, ROS_COLUMN, ros)
    put(given, ECU_COLUMN, ecu)


@kernel
def count(counts: Row, present: Row, mode: float) -> None:
    """Count which triggers met in this mode."""
    for one in range(COUNT):
        if present[one] != 0.0:
            for other in range(one, COUNT):
                if present[other] != 0.0:
                    counts[(int(mode) * COUNT + one) * COUNT + other] += 1.0


@kernel
def nothing_asked(g: Row, o: Row, before: Row) -> bool:
    """Return whether nobody asked for anything that could be refused."""
    restarts = has(g[EVENT_MASK], E_RESTART) or has(g[EDGES], B_RESTART) or before[RESTART_TICKS] != 0.0
    return bool(o[ASKED] == 0.0 and g[ECU_MASK] == 0.0 and not restarts)


@kernel
def walk(
    draws: Row,
    g: Row,
    o: Row,
    before: Row,
    recent: Row,
    counts: Row,
    figures: Row,
    row: Row,
    rules_row: Row,
    present: Row,
    given: Row,
    tick_s: float,
) -> float:
    """Go on with a drive for as many ticks as there are rows of `draws`; return the breach that ended it, 0 for none.

    All that lasts stands in the rows: the generator's state `g`, the oracle's `o`, and what the tick before gave.
    `figures` is the tick, the longest time after the last plausible command in ticks, the wheel's motor, the oracle's
    mode and the one seen, and how long an automatic mode may last. `present` and `given`, all zeros, are for one tick:
    kernels make no arrays.
    """
    s = read(row, SETTINGS)
    r = read(rules_row, RULES)
    hz = 1.0 / tick_s
    for index in range(draws.shape[0]):
        u = draws[index]
        ros_before, ecu_before = g[ROS_AT + 5], g[ECU_AT + 5]
        mode = before[MODE_AT]
        happen(g, u, o, before, figures, hz, r)
        ros = controller(g, ROS_AT, u, 28, hz, r.stale_ticks, 0.3 / hz)
        ecu = controller(g, ECU_AT, u, 37, hz, r.stale_ticks, 0.3 / hz)
        driver, vehicle = driver_of(g), vehicle_of(g, before)
        explained = g[EXPLAINED] * figures[2]
        command = read(before, COMMAND)
        was = read(before, ARBITRATION)
        now = TickContext(
            driver,
            ros,
            ecu,
            EventInput(g[EVENT_MASK], 0.0, g[ECU_MASK]),
            vehicle,
            read(before, MEMORY),
            read(before, ROS_LINK),
            read(before, ECU_LINK),
            ros_before,
            ecu_before,
            was,
            command,
            explained,
            0.0,
            g[HUMAN],
            0.0,
            0.0,
            figures[2],
            s,
            tick_s,
        )
        memory, ros_link, ecu_link, arbitration, request = arbitrate(now)
        command = gate(
            request, ecu if arbitration.commander == ECU else ros, arbitration, command, vehicle, s, tick_s, 0.0
        )
        felt = (explained, 0.0, abs(g[HUMAN]))
        may_command = foresee(o, present, driver, g[EVENT_MASK], g[ECU_MASK], ros, ecu, vehicle, felt, arbitration, r)
        note(given, g, figures, mode, driver, ros, ecu)
        for at in range(len(given)):
            recent[int(figures[0]) % RECENT, at] = given[at]
        count(counts, present, mode)
        breach = judge(
            o,
            present,
            before,
            arbitration,
            command,
            driver,
            was.refusal == 0.0 and arbitration.refusal != 0.0,
            nothing_asked(g, o, before),
            may_command,
            r,
        )
        at = BLOCK if o[WHO] == ECU else 0
        if SHARED <= arbitration.mode <= TAKEOVER and o[at + RECEIVED] > figures[1]:
            figures[1] = o[at + RECEIVED]
        write(before, MEMORY, memory)
        write(before, ROS_LINK, ros_link)
        write(before, ECU_LINK, ecu_link)
        write(before, ARBITRATION, arbitration)
        write(before, COMMAND, command)
        figures[0] += 1.0
        figures[3], figures[4] = o[MODE], arbitration.mode
        if breach != 0.0:
            return breach
    return 0.0
