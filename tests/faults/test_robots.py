"""R and N cases of the fault catalogue for robots: whatever becomes of the commands, stop means stop, wheels and all.

The commands are velocity commands, which only robots follow as they are; the arbiter is that of the cars.
"""

import math
from functools import cache
from typing import Any, NamedTuple

import msgspec
import numpy as np
import pytest

from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.faults.schedule import with_faults
from simconsole.profiles import faults as kinds
from simconsole.profiles.faults import Fault
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.resolution import load_session, resolve
from simconsole.tick.advance import Console, ConsoleState
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.tick.isolation import isolated
from simconsole.tick.loop import Components, run
from simconsole.values.host.jit import compiled
from simconsole.values.protocols import NobodySeated
from simconsole.values.signals import (
    NO_COMMAND,
    NO_EVENTS,
    Event,
    EventInput,
    Mode,
    Reason,
    RemoteCommand,
    RemoteKind,
)

HZ = 200
PERIOD_TICKS = 4
SPEED_MPS, RATE_RADPS = 0.15, 0.5
ENGAGE_TICK = HZ
FAULT_S, SECONDS = 3.0, 6.0
PROMISED_TICKS = 42
"""210 ms."""
ROBOTS = ("turtlebot3_burger", "turtlebot3_waffle")


class Program:
    """Commands a bend of 0.3 m every 20 ms, and asks to drive once."""

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        sent = (tick - 1) // PERIOD_TICKS
        command = NO_COMMAND._replace(
            kind=float(RemoteKind.TWIST),
            sequence=float(sent + 1),
            age_ticks=float(tick - 1 - sent * PERIOD_TICKS),
            speed_mps=SPEED_MPS if tick > ENGAGE_TICK else 0.0,
            yaw_rate_radps=RATE_RADPS if tick > ENGAGE_TICK else 0.0,
        )
        return command, EventInput(float(Event.REQUEST_AUTONOMOUS)) if tick == ENGAGE_TICK else NO_EVENTS


class Robot(NamedTuple):
    """One compiled console."""

    resolved: ResolvedSession
    console: Console
    start: ConsoleState


@cache
def robot(name: str) -> Robot:
    resolved = resolve(load_session(name))
    return Robot(resolved, *assemble(resolved, compiled))


class Driven:
    """A drive with one fault, or without."""

    def __init__(self, name: str, *faults: Fault) -> None:
        made = robot(name)
        self.console, self._recorder = made.console, MemoryRecorder(round(SECONDS * HZ), made.console.width)
        session = made.resolved.session
        scenario = msgspec.structs.replace(session.scenario, faults=faults)
        resolved = msgspec.structs.replace(made.resolved, session=msgspec.structs.replace(session, scenario=scenario))
        parts = with_faults(Components(NobodySeated(), Program(), self._recorder, (), UnpacedPacer()), resolved, HZ)
        run(self.console, made.start, isolated(parts, UnpacedPacer), round(SECONDS * HZ))

    def column(self, name: str) -> Any:
        return self._recorder.vectors[:, self.console.columns.index(name)]


CASES: dict[str, tuple[Fault, Reason]] = {
    "R01": (kinds.LateCommands(at_s=FAULT_S, by_ms=300), Reason.COMMAND_STALE),
    "R01-delayed": (kinds.DelayedCommands(at_s=FAULT_S, by_ms=300), Reason.COMMAND_STALE),
    "R02": (kinds.Silent(at_s=FAULT_S), Reason.COMMAND_STALE),
    "R04": (kinds.Refused(at_s=FAULT_S), Reason.COMMAND_INVALID),
    "R05": (kinds.NotFinite(at_s=FAULT_S), Reason.COMMAND_INVALID),
    "R07": (kinds.Refused(at_s=FAULT_S), Reason.COMMAND_INVALID),
    "R08": (kinds.Refused(at_s=FAULT_S), Reason.COMMAND_INVALID),
    "N01": (kinds.Disconnected(at_s=FAULT_S), Reason.COMMANDER_LOST),
    "N04": (kinds.Silent(at_s=FAULT_S), Reason.COMMAND_STALE),
    "P12": (kinds.Raises(at_s=FAULT_S, part="ros"), Reason.COMMANDER_LOST),
}


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize(
    "case",
    [
        pytest.param("R01", marks=pytest.mark.fault("R01")),
        pytest.param("R01-delayed", marks=pytest.mark.fault("R01")),
        pytest.param("R02", marks=pytest.mark.fault("R02")),
        pytest.param("R04", marks=pytest.mark.fault("R04")),
        pytest.param("R05", marks=pytest.mark.fault("R05")),
        pytest.param("R07", marks=pytest.mark.fault("R07")),
        pytest.param("R08", marks=pytest.mark.fault("R08")),
        pytest.param("N01", marks=pytest.mark.fault("N01")),
        pytest.param("N04", marks=pytest.mark.fault("N04")),
        pytest.param("P12", marks=pytest.mark.fault("P12")),
    ],
)
def test_a_robot_whose_commands_go_wrong_stops_and_stays(name: str, case: str) -> None:
    fault, reason = CASES[case]
    driven = Driven(name, fault)
    mode, told = driven.column("arbitration.mode"), driven.column("arbitration.reason")
    began = int(np.flatnonzero(driven.column("events.faults"))[0])
    assert mode[began - 1] == Mode.AUTONOMOUS
    assert driven.column("vehicle.vx_mps")[began - 1] == pytest.approx(SPEED_MPS)
    left = int(np.flatnonzero(mode != Mode.AUTONOMOUS)[-1])
    first = began + int(np.flatnonzero(mode[began:] != Mode.AUTONOMOUS)[0])
    assert first - began <= PROMISED_TICKS
    assert (mode[first], told[first]) == (Mode.MINIMAL_RISK, reason)
    assert left == len(mode) - 1, "nobody asks again"
    assert mode[-1] == Mode.STOPPED
    # Both wheels brake with 1 m/s2 and more: after a third of a second nothing moves any more, to the bit.
    rest = first + round(0.35 * HZ)
    for column in ("vehicle.x_m", "vehicle.y_m", "vehicle.yaw_rad", "vehicle.distance_m"):
        assert np.ptp(driven.column(column)[rest:]) == 0.0
    for wheel in ("left", "right"):
        assert (driven.column(f"platform.motion.{wheel}_radps")[rest:] == 0.0).all()
    assert np.isfinite(driven.column("command.target_yaw_rate_radps")).all()


@pytest.mark.fault("R03")
@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize(
    "fault", [kinds.LateCommands(at_s=FAULT_S, by_ms=150), kinds.DelayedCommands(at_s=FAULT_S, by_ms=100)]
)
def test_r03_a_robot_drives_on_by_commands_that_are_late_but_steady(name: str, fault: Fault) -> None:
    driven = Driven(name, fault)
    assert (driven.column("arbitration.mode")[2 * HZ :] == Mode.AUTONOMOUS).all()
    for column in ("vehicle.x_m", "vehicle.yaw_rad"):
        assert (driven.column(column) == undisturbed(name).column(column)).all(), "the bend is the same"


@cache
def undisturbed(name: str) -> Driven:
    return Driven(name)


@pytest.mark.parametrize("name", ROBOTS)
def test_without_a_fault_it_drives_its_bend(name: str) -> None:
    driven = undisturbed(name)
    assert driven.column("vehicle.yaw_rate_radps")[2 * HZ] == pytest.approx(RATE_RADPS)
    turned = np.unwrap(driven.column("vehicle.yaw_rad"))
    assert turned[-1] - turned[2 * HZ] == pytest.approx(4.0 * RATE_RADPS, abs=0.01)
    assert math.isclose(driven.column("vehicle.vx_mps")[-1], SPEED_MPS, rel_tol=1e-6)
