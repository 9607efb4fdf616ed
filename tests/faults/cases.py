"""The faults that arbiter and gate answer: what happens, how soon, and who brings the car to rest. One list for all.

`python -m tests.faults.cases > docs/faults.md` writes the page; a test holds the two equal. Identifiers are
those of the catalogue of fault cases: D devices, R ROS commands, N the network, P the process.
"""

from functools import cache
from typing import Final, NamedTuple

import numpy as np

from simconsole.profiles import faults as kinds
from simconsole.profiles.faults import Fault, words
from simconsole.rows import Snapshot
from simconsole.signals import Mode, Reason
from simconsole.words import mode_words, reason_words
from tests.faults.course import HZ, PLACES, Driven, circuit

SECONDS: Final = 20.0
AFTER_S: Final = 1.0
"""How long after the saved state the fault comes."""


class Case(NamedTuple):
    """One fault. `reaction` None: the drive goes on. `alone`: nobody in the seat needs to do anything."""

    number: str
    fault: str
    kind: type[kinds.Onset]
    parameters: dict[str, object]
    reaction: Mode | None
    reason: Reason | None
    promised_ms: float
    alone: bool

    def made(self, at_s: float) -> Fault:
        return self.kind(at_s=at_s, **self.parameters)  # type: ignore[arg-type, return-value]  # a kind's own keys


_STOP, _ASK = Mode.MINIMAL_RISK, Mode.TAKEOVER_REQUESTED
CASES: Final = (
    Case("D02", "the wheel is unplugged", kinds.Unplug, {"device": "wheel"}, _ASK, Reason.DEVICE_LOST, 50, True),
    Case("D02", "the pedals are unplugged", kinds.Unplug, {"device": "pedals"}, _ASK, Reason.DEVICE_LOST, 50, True),
    Case("D03", "the wheel says nothing new", kinds.Freeze, {"device": "wheel"}, _ASK, Reason.DEVICE_LOST, 100, True),
    Case("D03", "the pedals say nothing new", kinds.Freeze, {"device": "pedals"}, _ASK, Reason.DEVICE_LOST, 100, True),
    Case("D07", "the wheel reads no number", kinds.Invalid, {"axis": "wheel"}, _ASK, Reason.DEVICE_LOST, 104, True),
    Case("R01", "commands are 300 ms old", kinds.LateCommands, {"by_ms": 300}, _STOP, Reason.COMMAND_STALE, 210, False),
    Case("R02", "commands stop", kinds.Silent, {}, _STOP, Reason.COMMAND_STALE, 210, False),
    Case("R03", "commands are 150 ms old", kinds.LateCommands, {"by_ms": 150}, None, None, 0, True),
    Case("R04 R05 R07 R08", "every command is refused", kinds.Refused, {}, _STOP, Reason.COMMAND_INVALID, 210, False),
    Case("R05", "a command that is no number", kinds.NotFinite, {}, _STOP, Reason.COMMAND_INVALID, 210, False),
    Case("N01", "the connection closes", kinds.Disconnected, {}, _STOP, Reason.COMMANDER_LOST, 210, False),
    Case("N04", "the connection is half open", kinds.Silent, {}, _STOP, Reason.COMMAND_STALE, 210, False),
    Case("P06", "the loop stands for 15 ms", kinds.Stall, {"stall_ms": 15}, None, None, 0, True),
    Case("P06", "the loop stands for 50 ms", kinds.Stall, {"stall_ms": 50}, None, None, 0, True),
    Case("P06", "the loop stands for 500 ms", kinds.Stall, {"stall_ms": 500}, _STOP, Reason.LOOP_STALL, 250, True),
    Case("P10 P12", "a display raises", kinds.Raises, {"part": "stations"}, None, None, 0, True),
    Case("P12", "the cockpit raises", kinds.Raises, {"part": "devices"}, _ASK, Reason.DEVICE_LOST, 100, True),
    Case("P12", "the ROS side raises", kinds.Raises, {"part": "ros"}, _STOP, Reason.COMMANDER_LOST, 210, False),
)


class Measured(NamedTuple):
    """What became of one case at one place."""

    driven: Driven
    fault: Fault
    after_ms: float | None
    """From the fault's first tick to the first tick of the reaction; None without one."""


def drive(case: Case, place: str) -> Measured:
    """Drive 20 s from the saved state of a place, the fault after one second; each drive is driven once."""
    return _driven(CASES.index(case), place)


@cache
def _driven(index: int, place: str) -> Measured:
    case = CASES[index]
    track = circuit()
    state = track.state_at(PLACES[place])
    fault = case.made(Snapshot(state.tick, HZ, state.row).t_s + AFTER_S)
    driven = track.drive(state, SECONDS, [fault], attentive=not case.alone)
    began = int(np.flatnonzero(driven.column("events.faults"))[0])
    changed = np.flatnonzero(driven.column("arbitration.mode") != float(Mode.AUTONOMOUS))
    return Measured(driven, fault, (int(changed[0]) - began) * 1000.0 / HZ if len(changed) else None)


_INTRODUCTION = """# What the console does about faults

Generated from the tests by `python -m tests.faults.cases > docs/faults.md`; a test holds the two equal.

Each fault is put into the drive one second after a saved state (any row of a drive is one), at three places of the
urban course: on a straight at 13.6 m/s, in a bend of 60 m at 12.7 m/s, at the roundabout. The path tracker drives.
The time is from the fault's first tick to the first tick of the reaction, the longest of the three; a tick is 4 ms.

Where the controller is not at fault, it goes on steering while the console brakes: the car stops in its lane with
nobody in the seat. Where it is, nobody knows the way: the wheels are held and slowly straightened, and in a bend only a
person keeps the car in its lane. The person of these drives takes 1.15 s (0.4 s and 0.75 s, the benchmark driver of
UN R157) from the alarm to the brake. A scenario's `faults:` names the same kinds.

| case | fault | in a scenario | reaction | reason told | promised | measured | ends |
|---|---|---|---|---|---|---|---|
"""
_END = """
Other cases have tests of their own: D01 to D10 in tests/faults/test_devices.py, D11 to D13 in
tests/faults/test_force_feedback.py, R and N cases at the bridge in tests/faults/test_r_commands.py and test_n_*.py, P01
to P04 in tests/recording, P11 in tests/stations/test_realtime.py. P05: nothing between an input and the gate reads the
wall clock; the import rules in pyproject.toml hold the pure floors to it.

R06, a command in range that steers far off the way, is a limit, not a fault that is recognised: the gate lets it come
with 1 rad/s and 5 m/s2 of lateral acceleration at most, and a person who takes over 1.15 s later is out of the lane.
"""


def page() -> str:
    """Return docs/faults.md."""
    return _INTRODUCTION + "\n".join(_row(case) for case in CASES) + "\n" + _END


def _row(case: Case) -> str:
    measured = [drive(case, place) for place in PLACES]
    kind = words(measured[0].fault).partition(" controller ros")[0]
    ends = "drives on"
    if case.reaction is not None:
        ends = "at rest in its lane" if case.alone else "under the person's control, in its lane"
    if case.reaction is None or case.reason is None:
        return f"| {case.number} | {case.fault} | `{kind}` | none | - | - | - | {ends} |"
    longest = max(entry.after_ms for entry in measured if entry.after_ms is not None)
    return (
        f"| {case.number} | {case.fault} | `{kind}` | {mode_words(case.reaction)} | {reason_words(case.reason)} "
        f"| {case.promised_ms:.0f} ms | {longest:.0f} ms | {ends} |"
    )


if __name__ == "__main__":
    print(page(), end="")
