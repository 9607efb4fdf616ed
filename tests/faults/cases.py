"""The faults that arbiter and gate answer: what happens, how soon, and who brings the car to rest. One list for all.

The first half of docs/faults.md; tests/faults/catalogue.py has the second, all cases.
"""

from collections.abc import Mapping
from functools import cache
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.table import drive_of
from simconsole.profiles import faults as kinds
from simconsole.profiles.faults import Fault, fault_label
from simconsole.values.labels import mode_label, reason_label
from simconsole.values.signals import Mode, Reason
from simconsole.values.state_vector import Snapshot
from tests.faults.course import AUTOPILOT, BY_HAND, BY_HAND_ALONE, HZ, PLACES, WATCHED, Crew, Driven, Rest, circuit

SECONDS: Final = 20.0
KEPT: Final = (
    *("arbitration.mode", "arbitration.reason", "arbitration.refusal", "command.road_wheel_rad", "events.faults"),
    *("ros_link.implausible_ticks", "vehicle.x_m", "vehicle.y_m", "vehicle.yaw_rad", "vehicle.vx_mps"),
)
"""What is looked at of each drive."""
AFTER_S: Final = 1.0
"""How long after the saved state the fault comes."""


class Case(NamedTuple):
    """One fault. `reaction` None: the drive goes on. `crew`: nobody in the seat needs to do anything."""

    number: str
    fault: str
    kind: type[kinds.Onset]
    parameters: Mapping[str, object]
    reaction: Mode | None
    reason: Reason | None
    promised_ms: float
    crew: Crew = AUTOPILOT

    @property
    def watched(self) -> bool:
        """Whether the controller is at fault: then a person who watches takes over, and that is driven, too."""
        return self.reaction is Mode.MINIMAL_RISK and self.reason in AT_FAULT

    def made(self, at_s: float) -> Fault:
        return self.kind(at_s=at_s, **self.parameters)  # type: ignore[arg-type, return-value]  # a kind's own keys


AT_FAULT: Final = (Reason.COMMAND_STALE, Reason.COMMAND_INVALID, Reason.COMMANDER_LOST)
_STOP, _ASK = Mode.MINIMAL_RISK, Mode.TAKEOVER_REQUESTED
_WHEEL, _PEDALS = {"device": "wheel"}, {"device": "pedals"}
_LOST = Reason.DEVICE_LOST
CASES: Final = (
    Case(
        "D01", "by hand, the wheel is unplugged; a controller is there", kinds.Unplug, _WHEEL, _STOP, _LOST, 50, BY_HAND
    ),
    Case("D01", "by hand, the wheel is unplugged", kinds.Unplug, _WHEEL, _STOP, _LOST, 50, BY_HAND_ALONE),
    Case("D01", "by hand, the pedals are unplugged", kinds.Unplug, _PEDALS, _STOP, _LOST, 50, BY_HAND_ALONE),
    Case("D02", "the wheel is unplugged", kinds.Unplug, _WHEEL, _ASK, _LOST, 50),
    Case("D02", "the pedals are unplugged", kinds.Unplug, _PEDALS, _ASK, _LOST, 50),
    Case("D03", "by hand, the wheel says nothing new", kinds.Freeze, _WHEEL, _STOP, _LOST, 100, BY_HAND),
    Case("D03", "the wheel says nothing new", kinds.Freeze, _WHEEL, _ASK, _LOST, 100),
    Case("D03", "the pedals say nothing new", kinds.Freeze, _PEDALS, _ASK, _LOST, 100),
    Case("D07", "the wheel reads no number", kinds.Invalid, {"axis": "wheel"}, _ASK, _LOST, 104),
    Case("R01", "commands are 300 ms old", kinds.LateCommands, {"by_ms": 300}, _STOP, Reason.COMMAND_STALE, 210),
    Case("R01", "commands act 300 ms late", kinds.DelayedCommands, {"by_ms": 300}, _STOP, Reason.COMMAND_STALE, 210),
    Case("R02", "commands stop", kinds.Silent, {}, _STOP, Reason.COMMAND_STALE, 210),
    Case("R03", "commands are 150 ms old", kinds.LateCommands, {"by_ms": 150}, None, None, 0),
    Case("R03", "commands act 40 ms late", kinds.DelayedCommands, {"by_ms": 40}, None, None, 0),
    Case("R04 R05 R07 R08", "every command is refused", kinds.Refused, {}, _STOP, Reason.COMMAND_INVALID, 210),
    Case("R05", "a command that is no number", kinds.NotFinite, {}, _STOP, Reason.COMMAND_INVALID, 210),
    Case("R06", "full lock to the left", kinds.Astray, {"road_wheel_deg": 34}, _STOP, Reason.COMMAND_INVALID, 210),
    Case("R06", "full lock to the right", kinds.Astray, {"road_wheel_deg": -34}, _STOP, Reason.COMMAND_INVALID, 210),
    Case("N01", "the connection closes", kinds.Disconnected, {}, _STOP, Reason.COMMANDER_LOST, 210),
    Case("N04", "the connection is half open", kinds.Silent, {}, _STOP, Reason.COMMAND_STALE, 210),
    Case("P06", "the loop stands for 15 ms", kinds.Stall, {"stall_ms": 15}, None, None, 0),
    Case("P06", "the loop stands for 50 ms", kinds.Stall, {"stall_ms": 50}, None, None, 0),
    Case("P06", "the loop stands for 500 ms", kinds.Stall, {"stall_ms": 500}, _STOP, Reason.LOOP_STALL, 250),
    Case("P10 P12", "a display raises", kinds.Raises, {"part": "outputs"}, None, None, 0),
    Case("P12", "the cockpit raises", kinds.Raises, {"part": "devices"}, _ASK, _LOST, 100),
    Case("P12", "the ROS side raises", kinds.Raises, {"part": "ros"}, _STOP, Reason.COMMANDER_LOST, 210),
)


class Measured(NamedTuple):
    """What became of one case at one place."""

    driven: Driven
    fault: Fault
    after_ms: float | None
    """From the fault's first tick to the first tick of the reaction; None without one."""
    found: Mapping[str, Any]
    """The metrics of the drive."""


def drive(case: Case, place: str, crew: Crew | None = None) -> Measured:
    """Drive 20 s from the saved state of a place, or until the car rests, the fault after one second; only once."""
    return _driven(CASES.index(case), place, crew or case.crew)


@cache
def _driven(index: int, place: str, crew: Crew) -> Measured:
    case = CASES[index]
    track = circuit()
    track.pass_by(PLACES.values())
    state = track.state_at(PLACES[place])
    fault = case.made(Snapshot(state.tick, HZ, state.vector).t_s + AFTER_S)
    driven = track.drive(state, SECONDS, [fault], crew, finished=Rest())
    began = int(np.flatnonzero(driven.column("events.faults"))[0])
    mode = driven.column("arbitration.mode")
    changed = np.flatnonzero(mode[began:] != mode[began - 1])
    whole = drive_of(driven.vectors, driven.columns, HZ, driven.first_tick)
    return Measured(
        driven=driven.only(KEPT),
        fault=fault,
        after_ms=int(changed[0]) * 1000.0 / HZ if len(changed) else None,
        found=metrics(whole, driven.course, None, [fault_label(fault)]),
    )


_INTRODUCTION = """# What the console does about faults

Generated from the tests by `make faults`; a test holds the page to them.

Each fault is put into the drive one second after a saved state (any row of a drive is one), at three places of the
urban course: on a straight at 13.6 m/s, in a bend of 60 m at 12.7 m/s, at the roundabout. The path tracker drives.
The time is from the fault's first tick to the first tick of the reaction, the longest of the three; a tick is 4 ms.

Where the controller is not at fault, it steers while the console brakes: the car stops in its lane with nobody in the
seat. Where it is, or where nobody else drives, nobody knows the way: the wheels are held, hardly straightened, and the
stop is short (docs/decisions/0009-stops-that-nobody-steers.md; over the whole course, the car alone ends in its lane
four times out of five). A person who watches takes 1.15 s (0.4 s and 0.75 s, the benchmark driver of UN R157) from the
alarm to the brake; those drives are driven as well. The last column says how far the car ends from the lane's centre,
the most of the three places; 0.85 m are still in the lane. A scenario's `faults:` names the same kinds.

| case | fault | in a scenario | reaction | reason told | promised | measured | ends | beside |
|---|---|---|---|---|---|---|---|---|
"""
_END = """
The same kinds in whole drives of the program over a real WebSocket: `pytest --long tests/faults/test_whole_drives.py`
(one for each answer without `--long`), N04 with a TCP connection that is really half open. Robots that follow velocity
commands: `pytest tests/faults/test_robots.py`; 0.35 s after the reaction at the latest both wheels of a TurtleBot3
stand, and stay.

R06 is a command that cannot be meant at the speed: more than 10 m/s2 of lateral acceleration. One that steers wrong by
less is a limit, not a fault that is recognised: the gate lets it come with 5 m/s2, 7 m/s3 and 1 rad/s at most, and a
person who takes over 1.15 s later may be out of the lane by then.

## All cases of the catalogue

D devices, R ROS commands, N the network, P the process, C CAN, F files. Where the catalogue sets a bar in real time,
the tests hold one in ticks, counts, bytes or processor time, and so does this table; tests are found by their
`@pytest.mark.fault`. The last column is what they measured when `make faults` ran last: figures differ from one run and
machine to the next, what is promised does not.

"""


def page() -> str:
    """Return docs/faults.md up to the table of all cases."""
    return _INTRODUCTION + "\n".join(_row(case) for case in CASES) + "\n" + _END


def _row(case: Case) -> str:
    measured = [drive(case, place) for place in PLACES]
    kind = fault_label(measured[0].fault).partition(" controller ros")[0]
    beside_m = max(abs(entry.driven.lateral_m) for entry in measured)
    if case.reaction is None or case.reason is None:
        return f"| {case.number} | {case.fault} | `{kind}` | none | - | - | - | drives on | {beside_m:.2f} m |"
    ends = "at rest in its lane"
    if case.watched:
        ends += f"; under a person's control within {max(_beside(case, place) for place in PLACES):.2f} m"
    longest = max(entry.after_ms for entry in measured if entry.after_ms is not None)
    return (
        f"| {case.number} | {case.fault} | `{kind}` | {mode_label(case.reaction)} | {reason_label(case.reason)} "
        f"| {case.promised_ms:.0f} ms | {longest:.0f} ms | {ends} | {beside_m:.2f} m |"
    )


def _beside(case: Case, place: str) -> float:
    return abs(drive(case, place, WATCHED).driven.lateral_m)
