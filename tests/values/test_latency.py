"""The latency statistics: an injected delay is found at its own hop and nowhere else. Every clock here is made up."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.processes.receipts import latencies_of
from simconsole.processes.shared_memory import Record, Ring
from simconsole.profiles.session import Devices, ModeSection, Scenario, SessionProfile
from simconsole.session.lockstep import LockstepLink
from simconsole.session.paced import RingOutput
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.resolution import resolve
from simconsole.session.worker_programs import LATENCY, NewestOnce
from simconsole.tick.advance import Console, ConsoleState
from simconsole.tick.assembly import assemble
from simconsole.tick.loop import Components, run
from simconsole.values.host.jit import plain
from simconsole.values.latency import Histogram, Hop, LatencyStatistics
from simconsole.values.protocols import NobodyCommands, NobodySeated
from simconsole.values.signals import NO_SAMPLE, DeviceSample, EventInput, RemoteCommand
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot

TICKS = 40
USUAL_NS = {
    Hop.READ: 20_000,
    Hop.TAKE: 3_000,
    Hop.DECIDE: 5_000,
    Hop.STEP: 9_000,
    Hop.FORCE_FEEDBACK: 2_000,
    Hop.RECORD: 4_000,
    Hop.TORQUE: 50_000,
    Hop.PUBLISH: 1_000,
    Hop.OTHERS: 700,
}
DELAY_NS = 7_000_000


class Clock:
    """Time passes only where a hop spends it."""

    def __init__(self, spent_ns: dict[Hop, int]) -> None:
        self.now_ns = 12_345
        self._spent_ns = spent_ns

    def spend(self, hop: Hop) -> None:
        self.now_ns += self._spent_ns.get(hop, 0)

    def read(self) -> int:
        return self.now_ns


class Wheel(NobodySeated):
    def __init__(self, clock: Clock, age_ticks: float = 0.0) -> None:
        self._clock, self._sample = clock, NO_SAMPLE._replace(wheel_age_ticks=age_ticks)

    def poll(self, tick: int) -> DeviceSample:
        self._clock.spend(Hop.READ)
        return self._sample


class Commands(NobodyCommands):
    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        self._clock.spend(Hop.TAKE)
        return super().take(tick)


class Recorder:
    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self.vectors: list[bytes] = []

    def write(self, snapshot: Snapshot) -> int:
        self._clock.spend(Hop.RECORD)
        self.vectors.append(snapshot.vector.tobytes())
        return 0


class Reader:
    """A worker; one of the class below has a hop of its own."""

    def __init__(self, clock: Clock, hop: Hop) -> None:
        self._clock, self._hop = clock, hop

    def publish(self, snapshot: Snapshot) -> None:
        self._clock.spend(self._hop)


class Named(Reader):
    def __init__(self, clock: Clock, hop: Hop) -> None:
        super().__init__(clock, hop)
        self.hop = hop


@pytest.fixture(scope="module")
def built() -> tuple[Console, ConsoleState]:
    session = SessionProfile(
        schema=1, scenario=Scenario(vehicle="ball"), devices=Devices(driver="none"), mode=ModeSection(tick_hz=100)
    )
    return assemble(resolve(session), plain)


def driven(
    built: tuple[Console, ConsoleState], spent_ns: dict[Hop, int], age_ticks: float = 0.0, every: int = 1
) -> tuple[LatencyStatistics, list[bytes]]:
    console, state = built
    clock = Clock(spent_ns)

    def late(function: Callable[..., None], hop: Hop) -> Callable[..., None]:
        def run_late(*arguments: Any) -> None:
            clock.spend(hop)
            function(*arguments)

        return run_late

    console = console._replace(
        decide=late(console.decide, Hop.DECIDE),
        step=late(console.step, Hop.STEP),
        force_feedback=late(
            lambda previous, row, settings, tick_s: row[LAYOUT.torque.start : PLATFORM_AT].fill(0.0), Hop.FORCE_FEEDBACK
        ),
    )
    latencies = LatencyStatistics(clock.read, console.tick_hz, every)
    readers = (Named(clock, Hop.TORQUE), Named(clock, Hop.PUBLISH), Reader(clock, Hop.OTHERS))
    recorder = Recorder(clock)
    components = Components(
        Wheel(clock, age_ticks), Commands(clock), recorder, readers, UnpacedPacer(), latencies=latencies
    )
    run(console, state, components, TICKS)
    return latencies, recorder.vectors


def test_every_hop_of_a_tick_is_counted_by_itself(built: tuple[Console, ConsoleState]) -> None:
    summary = driven(built, USUAL_NS)[0].summary_us()
    assert list(summary) == ["device", *map(str, USUAL_NS)], "in the order of a tick"
    for hop, spent_ns in USUAL_NS.items():
        assert summary[hop]["max"] == spent_ns / 1e3
        assert summary[hop]["count"] == TICKS


@pytest.mark.parametrize("hop", list(USUAL_NS))
def test_an_injected_delay_is_found_at_its_own_hop(built: tuple[Console, ConsoleState], hop: Hop) -> None:
    usual = driven(built, USUAL_NS)[0].summary_us()
    delayed = driven(built, {**USUAL_NS, hop: USUAL_NS[hop] + DELAY_NS})[0].summary_us()
    later = {name: delayed[name]["p50"] - usual[name]["p50"] for name in usual}
    assert later.pop(hop) == pytest.approx(DELAY_NS / 1e3, rel=0.15), "to a bin of the histogram"
    assert set(later.values()) == {0.0}


def test_a_device_that_is_late_is_found_at_the_device(built: tuple[Console, ConsoleState]) -> None:
    summary = driven(built, USUAL_NS, age_ticks=3.0)[0].summary_us()
    assert summary[Hop.DEVICE]["p50"] == pytest.approx(30_000.0)
    assert summary[Hop.READ]["max"] == USUAL_NS[Hop.READ] / 1e3


def test_a_cockpit_that_is_not_there_has_no_age() -> None:
    latencies = LatencyStatistics(lambda: 0)
    latencies.sample(NO_SAMPLE)
    assert latencies.summary_us() == {}
    latencies.sample(NO_SAMPLE._replace(pedals_age_ticks=2.0))
    assert list(latencies.summary_us()) == ["device"]


def test_the_clock_leaves_no_trace_in_the_rows(built: tuple[Console, ConsoleState]) -> None:
    slow, quick = driven(built, {**USUAL_NS, Hop.STEP: DELAY_NS})[1], driven(built, {})[1]
    assert slow == quick


def test_a_drive_that_is_not_paced_is_looked_at_now_and_then(built: tuple[Console, ConsoleState]) -> None:
    summary = driven(built, USUAL_NS, every=16)[0].summary_us()
    assert {hop["count"] for hop in summary.values()} == {TICKS // 16}


def test_in_lockstep_the_answer_is_waited_for_at_the_exchange() -> None:
    assert LockstepLink.hop is Hop.EXCHANGE


def test_workers_that_said_nothing_have_no_statistics(tmp_path: Path) -> None:
    (tmp_path / f"{LATENCY}.bridge.json").write_text("{")
    assert latencies_of(tmp_path, "latency") == {}


def test_the_ring_tells_a_worker_when_it_was_published(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("simconsole.session.paced.time.monotonic_ns", lambda: 987_654_321)
    ring = Ring.create(tmp_path / "ring", 3, 4)
    RingOutput(ring).publish(Snapshot(7, 250, np.array([1.0, 2.0, 3.0])))
    seen: list[Record] = []
    newest = NewestOnce(Ring.open(tmp_path / "ring"), 250, seen.append)
    snapshot = newest()
    assert snapshot is not None
    assert (snapshot.tick, seen[0].second_stamp) == (7, 987_654_321)
    assert newest() is None
    assert len(seen) == 1


def test_percentiles_hold_to_one_bin() -> None:
    seed = 20261121
    print("seed", seed)
    times_ns = np.random.default_rng(seed).lognormal(10.0, 2.0, 5000).astype(np.int64) + 200
    histogram = Histogram()
    for time_ns in times_ns.tolist():
        histogram.add(time_ns)
    for percent in (1.0, 50.0, 99.0, 99.9):
        true = float(np.percentile(times_ns, percent, method="inverted_cdf"))
        assert true * 0.999 <= histogram.percentile_ns(percent) <= true * 10 ** (1 / 20) * 1.001
    assert histogram.percentile_ns(100.0) == histogram.max_ns == times_ns.max()


@pytest.mark.parametrize("time_ns", [-5, 0, 1, 99, 100, 101, 999_999_999, 1_000_000_000, 60_000_000_000])
def test_any_time_can_be_counted(time_ns: int) -> None:
    histogram = Histogram()
    assert histogram.percentile_ns(50.0) == 0.0
    histogram.add(time_ns)
    assert histogram.count == 1
    assert histogram.percentile_ns(99.0) == pytest.approx(max(0, time_ns))
