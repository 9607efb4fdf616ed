"""What every signal of a road map shows at a tick: a function of the tick and the signals' own programs alone.

One text for the compiled tick, for the wire and for drawings: times are whole ticks, so that all agree at every tick.
"""

from collections.abc import Sequence
from itertools import accumulate
from typing import Final, NamedTuple

import numpy as np

from simconsole.values.kernels import Row, kernel
from simconsole.values.signals import FAR, SignalState
from simconsole.world.roads.road_map import Program, Signal, active

_STATES: Final = {
    "r": SignalState.STOP_AND_REMAIN,
    "u": SignalState.PRE_MOVEMENT,
    "y": SignalState.PERMISSIVE_CLEARANCE,
    "Y": SignalState.PROTECTED_CLEARANCE,
    "g": SignalState.PERMISSIVE_MOVEMENT_ALLOWED,
    "G": SignalState.PROTECTED_MOVEMENT_ALLOWED,
    "s": SignalState.STOP_THEN_PROCEED,
    "o": SignalState.CAUTION_CONFLICTING_TRAFFIC,
    "O": SignalState.DARK,
}
"""SUMO's letters."""


class Timetable(NamedTuple):
    """The programs of all signals as arrays."""

    signals: Row  # float64 [signals, 3]: first phase, number of phases, offset in ticks
    ends_ticks: Row  # float64 [phases]: when each phase ends, in its cycle


class PhaseNow(NamedTuple):
    """Where a program is: a phase, in the table of all phases, and how long it lasts from now on."""

    phase: float
    left_ticks: float


class LinkState(NamedTuple):
    """What one link of a signal shows."""

    state: SignalState
    next_state: SignalState  # what it shows after that
    change_s: float  # until then; FAR: it never changes


class Signals:
    """The signals of a map under their programs; of several the first one works, and all phases have fixed lengths."""

    def __init__(self, signals: Sequence[Signal], tick_hz: int) -> None:
        self.signals = tuple(signals)
        self.tick_hz = tick_hz
        self.timetable = timetable_of(signals, tick_hz)

    def phase(self, signal: int, tick: int) -> tuple[int, float]:
        """Return the phase of a signal in its program, and for how many ticks it lasts from `tick` on."""
        now = phase_now(self.timetable, float(signal), float(tick))
        return int(now.phase - self.timetable.signals[signal, 0]), float(now.left_ticks)

    def letters(self, signal: int, tick: int) -> str:
        """Return what the links of a signal show, a letter of SUMO's each."""
        return active(self.signals[signal]).phases[self.phase(signal, tick)[0]].state

    def state(self, signal: int, link: int, tick: int) -> SignalState:
        """Return what a link of a signal shows."""
        return state_of(self.letters(signal, tick), link)

    def link(self, signal: int, link: int, tick: int) -> LinkState:
        """Return what a link of a signal shows, what it will show, and when."""
        phase, left = self.phase(signal, tick)
        program = active(self.signals[signal])
        states, durations = link_states(program, (link,)), durations_ticks(program, self.tick_hz)
        more, following = until_change(states, durations)[phase]
        return LinkState(states[phase], following, FAR if more >= FAR else (left + more) / self.tick_hz)


def timetable_of(signals: Sequence[Signal], tick_hz: int) -> Timetable:
    """Return the programs of these signals."""
    rows: list[tuple[float, float, float]] = []
    ends: list[int] = []
    for signal in signals:
        program = active(signal)
        durations = durations_ticks(program, tick_hz)
        rows.append((float(len(ends)), float(len(durations)), float(round(program.offset_s * tick_hz))))
        ends += accumulate(durations)
    return Timetable(np.array(rows, dtype=np.float64).reshape(-1, 3), np.array(ends, dtype=np.float64))


def durations_ticks(program: Program, tick_hz: int) -> list[int]:
    """Return how long each phase lasts, at least a tick."""
    return [max(round(phase.duration_s * tick_hz), 1) for phase in program.phases]


def link_states(program: Program, links: Sequence[int]) -> list[SignalState]:
    """Return what these links together show in each phase: who follows one of them obeys the most permissive."""
    return [max((state_of(phase.state, link) for link in links), key=PERMISSIVENESS.index) for phase in program.phases]


PERMISSIVENESS: Final = (
    SignalState.STOP_AND_REMAIN,
    SignalState.PRE_MOVEMENT,
    SignalState.PROTECTED_CLEARANCE,
    SignalState.PERMISSIVE_CLEARANCE,
    SignalState.STOP_THEN_PROCEED,
    SignalState.UNAVAILABLE,
    SignalState.DARK,
    SignalState.CAUTION_CONFLICTING_TRAFFIC,
    SignalState.PERMISSIVE_MOVEMENT_ALLOWED,
    SignalState.PROTECTED_MOVEMENT_ALLOWED,
)
"""The states, from the one that stops everybody."""


def until_change(states: Sequence[SignalState], durations: Sequence[int]) -> list[tuple[float, SignalState]]:
    """Return for each phase how many ticks after its end the state changes, and to what; FAR: it never does."""
    count, found = len(states), []
    for phase, state in enumerate(states):
        later = [(phase + step) % count for step in range(1, count)]
        change = next((step for step, other in enumerate(later) if states[other] != state), None)
        if change is None:
            found.append((FAR, state))
        else:
            found.append((float(sum(durations[other] for other in later[:change])), states[later[change]]))
    return found


GREEN: Final = (SignalState.PERMISSIVE_MOVEMENT_ALLOWED, SignalState.PROTECTED_MOVEMENT_ALLOWED)


def greens(
    now: SignalState, left_ticks: float, later: Sequence[tuple[SignalState, float]]
) -> list[tuple[float, float]]:
    """Return the next two times of green as (begin, end) in ticks from now; 0: it is green, FAR: nobody knows its end.

    Args:
        now: what is shown.
        left_ticks: for how long; FAR: nobody knows.
        later: what follows and for how long, in order, ending with what is shown now.
    """
    if left_ticks >= FAR or not later:
        return [(0.0, FAR)] if now in GREEN else []
    found: list[tuple[float, float]] = []
    begin, at = (0.0 if now in GREEN else -1.0), left_ticks
    for state, lasts_ticks in (*later, *later):
        if state in GREEN and begin < 0.0:
            begin = at
        elif state not in GREEN and begin >= 0.0:
            found.append((begin, at))
            begin = -1.0
        at += lasts_ticks
    return found[:2] if found or begin != 0.0 else [(0.0, FAR)]


@kernel
def phase_now(timetable: Timetable, signal: float, tick: float) -> PhaseNow:
    """Return where the program of a signal is in a tick."""
    which = int(signal)
    first, count = int(timetable.signals[which, 0]), int(timetable.signals[which, 1])
    cycle = timetable.ends_ticks[first + count - 1]
    at = tick - timetable.signals[which, 2]
    at -= cycle * int(at / cycle)
    if at < 0.0:
        at += cycle
    phase = first
    while timetable.ends_ticks[phase] <= at:
        phase += 1
    return PhaseNow(float(phase), timetable.ends_ticks[phase] - at)


def state_of(letters: str, link: int) -> SignalState:
    """Return what a link shows by SUMO's letters."""
    return _STATES.get(letters[link], SignalState.UNAVAILABLE) if 0 <= link < len(letters) else SignalState.UNAVAILABLE
