"""Ticks made at once: the same to the bit as one by one, and never beyond what somebody must look at."""

import numpy as np
import pytest

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.drivers.scripted_controller import ScriptedCommands
from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.profiles.files.loader import parse
from simconsole.profiles.parts.script import ScriptProfile
from simconsole.profiles.scenario import EventStep
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.resolution import load_scenario, resolve
from simconsole.tick.advance import advance_block, advance_vector
from simconsole.tick.assembly import assemble
from simconsole.tick.foresight import BLOCK_TICKS
from simconsole.tick.isolation import isolated
from simconsole.tick.loop import Components, run
from simconsole.values.host.jit import compiled, plain
from simconsole.values.kernels import Row
from simconsole.values.latency import Hop, LatencyStatistics
from simconsole.values.protocols import NobodyCommands
from simconsole.values.signals import Event
from simconsole.values.state_vector import INPUT_WIDTH, LAYOUT, Snapshot, columns
from simconsole.vehicle.car.state import CarState
from tests.bits import difference

HZ = 250
TICKS = 5000
PRESSED_S = 2.0
NAMES = columns(CarState)


class EachTick:
    """A pace that lets no tick be left out."""

    def wait(self) -> int:
        return 0


class Blocks(MemoryRecorder):
    """A recorder that notes how many ticks it is given at once, and keeps no more than told of one block."""

    def __init__(self, width: int, fails_at: int | None = None) -> None:
        super().__init__(2 * TICKS, width)
        self.sizes: list[int] = []
        self._fails_at = fails_at

    def write(self, snapshot: Snapshot) -> int:
        self._keep(snapshot.tick, snapshot.vector[np.newaxis])
        return self._events()

    def write_block(self, tick: int, vectors: Row) -> tuple[int, int]:
        if self._fails_at is not None and tick <= self._fails_at < tick + len(vectors):
            vectors = vectors[: self._fails_at - tick + 1]
        self._keep(tick, vectors)
        return len(vectors), self._events()

    def _keep(self, tick: int, vectors: Row) -> None:
        self.sizes.append(len(vectors))
        super().write_block(tick, vectors)

    def _events(self) -> int:
        failed = self._fails_at is not None and self.ticks >= self._fails_at
        return int(Event.RECORDING_FAILED) if failed else 0


class Seen:
    """An output that looks at every seventh tick."""

    def __init__(self) -> None:
        self.ticks: list[int] = []

    def publish(self, snapshot: Snapshot) -> None:
        if snapshot.tick % 7 == 0:
            self.ticks.append(snapshot.tick)

    def unseen(self, tick: int) -> int:
        return -tick % 7


class Drives:
    """The scenario hand_over, with what a test changes in it."""

    def __init__(self) -> None:
        self.scenario, _ = load_scenario("hand_over")
        self.resolved = resolve(self.scenario.session)
        self.console, self.start = assemble(self.resolved, compiled)

    def components(self, recorder: Blocks, *, at_once: bool, events: str = "") -> Components:
        assert self.scenario.script is not None
        more = tuple(parse(f"{{{line}}}", EventStep, "event") for line in events.splitlines())
        devices = ScriptSource(self.scenario.script, cockpit_settings(self.resolved.cockpit, HZ), tick_hz=HZ)
        commands = ScriptedCommands(self.scenario.remote, (*self.scenario.events, *more), HZ)
        return Components(devices, commands, recorder, (), UnpacedPacer() if at_once else EachTick())

    def driven(self, *, at_once: bool, events: str = "", fails_at: int | None = None, ticks: int = TICKS) -> Blocks:
        recorder = Blocks(self.console.width, fails_at)
        components = self.components(recorder, at_once=at_once, events=events)
        run(self.console, self.start, components, ticks, lambda snapshot: snapshot.tick >= TICKS)
        return recorder


@pytest.fixture(scope="module")
def drives() -> Drives:
    return Drives()


@pytest.mark.parametrize("events", ["", "at_s: 6.1, event: request_takeover\nat_s: 9.0, event: emergency_stop"])
def test_at_once_is_one_by_one_to_the_bit(drives: Drives, events: str) -> None:
    one_by_one, at_once = (drives.driven(at_once=at_once, events=events) for at_once in (False, True))
    assert not difference(at_once.vectors, one_by_one.vectors, NAMES)
    assert at_once.digest == one_by_one.digest
    assert max(one_by_one.sizes) == 1
    assert max(at_once.sizes) == BLOCK_TICKS
    assert len(at_once.sizes) < TICKS / 20


def test_isolated_parts_foresee_as_much(drives: Drives) -> None:
    recorder = Blocks(drives.console.width)
    run(drives.console, drives.start, isolated(drives.components(recorder, at_once=True), UnpacedPacer), TICKS)
    assert recorder.digest == drives.driven(at_once=False).digest
    assert max(recorder.sizes) == BLOCK_TICKS


def test_a_drive_ends_with_its_last_tick(drives: Drives) -> None:
    assert drives.driven(at_once=True, ticks=101).ticks == 101


def test_ticks_after_a_failed_recording_are_made_again_with_the_alarm(drives: Drives) -> None:
    one_by_one, at_once = (drives.driven(at_once=at_once, fails_at=777) for at_once in (False, True))
    assert not difference(at_once.vectors, one_by_one.vectors, NAMES)
    events = at_once.vectors[:, LAYOUT.events.start]
    assert not events[776]
    assert (events[777:].astype(int) & Event.RECORDING_FAILED).all()


def test_an_output_sees_the_ticks_that_it_looks_at(drives: Drives) -> None:
    recorder, output = Blocks(drives.console.width), Seen()
    run(drives.console, drives.start, drives.components(recorder, at_once=True)._replace(outputs=(output,)), 1000)
    assert output.ticks == list(range(7, 1001, 7))
    assert not difference(recorder.vectors, drives.driven(at_once=False, ticks=1000).vectors, NAMES)
    assert max(recorder.sizes) == 7


def test_a_tick_that_is_timed_is_made_alone(drives: Drives) -> None:
    recorder, latencies = Blocks(drives.console.width), LatencyStatistics(lambda: 0, HZ, every=50)
    components = drives.components(recorder, at_once=True)._replace(latencies=latencies)
    run(drives.console, drives.start, components, 1000)
    assert not difference(recorder.vectors, drives.driven(at_once=False, ticks=1000).vectors, NAMES)
    assert latencies.summary_us()[Hop.STEP]["count"] == 20


@pytest.mark.parametrize("at_once", [False, True])
def test_a_pause_by_button_stands_after_the_tick_that_follows_it(drives: Drives, at_once: bool) -> None:
    script = parse(
        f"points:\n  - {{time_s: 0.0, brake: 0}}\n  - {{time_s: {PRESSED_S}, press: [pause]}}\n", ScriptProfile, ""
    )
    recorder, stood = Blocks(drives.console.width), list[int]()
    components = drives.components(recorder, at_once=at_once)._replace(
        devices=ScriptSource(script, cockpit_settings(drives.resolved.cockpit, HZ), tick_hz=HZ),
        commands=NobodyCommands(),
        standby=(lambda snapshot: stood.append(snapshot.tick),),
    )
    run(drives.console, drives.start, components, TICKS, lambda snapshot: len(stood) > 20)
    assert set(stood) == {recorder.ticks}
    assert recorder.ticks == round(PRESSED_S * HZ) + 1
    assert int(recorder.vectors[-1, LAYOUT.events.start]) & Event.PAUSE


def test_a_block_under_plain_python_is_that_of_compiled_code(drives: Drives) -> None:
    rows = drives.driven(at_once=False, ticks=40).vectors.copy()
    again = rows.copy()
    again[:, INPUT_WIDTH:] = np.nan
    console, start = assemble(drives.resolved, plain)
    advance_block(start.vector, again, console)
    assert not difference(again, rows, NAMES)


def test_a_drive_begins_anew_within_a_block(drives: Drives) -> None:
    rows = drives.driven(at_once=False).vectors.copy()
    rows[[700, 1900], LAYOUT.events.start] = float(Event.RESTART)
    one_by_one, row = np.empty_like(rows), drives.start.vector
    for at, recorded in enumerate(rows):
        row = one_by_one[at] = advance_vector(row, recorded[:INPUT_WIDTH], drives.console)
    advance_block(drives.start.vector, rows, drives.console)
    assert not difference(rows, one_by_one, NAMES)
    assert rows[:, LAYOUT.arbitration.at("restarted")].sum() == 2.0
