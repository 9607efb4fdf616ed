"""The worker's loop and a headless drive's node, on a virtual bus with an ECU beside them."""

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from simconsole.canbus.bus.port import CanPort
from simconsole.canbus.bus.worker import HeadlessCan, OnBus, log_paths, put_on_bus, serve
from simconsole.canbus.codec import Codec
from simconsole.canbus.ecu import Ecu, Wish
from simconsole.canbus.protection import Check
from simconsole.profiles.can import CanProfile
from simconsole.values.signals import NEVER_TICKS, Event, RemoteCommand
from simconsole.values.state_vector import Snapshot
from tests.patience import pause, stamp_ns, wait_until

Snapshots = Callable[[int], Snapshot]


@pytest.fixture
def on_bus(profile: CanProfile, tmp_path: Path) -> Iterator[OnBus]:
    opened = put_on_bus(profile, 250, wheels=None, folder=tmp_path)
    yield opened
    opened.port.close()


@pytest.fixture
def ecu_port(profile: CanProfile, codec: Codec) -> Iterator[CanPort]:
    ecu = Ecu(codec, Wish())
    port = CanPort(profile, ecu.transmit_ids, ecu.receive_ids)
    yield port
    port.close()


def test_logs_lie_in_the_bundle_once_each(tmp_path: Path) -> None:
    profile = CanProfile(log=("blf", "candump", "asc", "blf"))
    assert log_paths(profile, tmp_path) == [tmp_path / "can.blf", tmp_path / "can.log", tmp_path / "can.asc"]


def test_headless_command_ages_in_ticks(on_bus: OnBus, ecu_port: CanPort, codec: Codec, snapshot: Snapshots) -> None:
    can, ecu = HeadlessCan(on_bus), Ecu(codec, Wish(accel_mps2=1.0))
    assert can.take(1)[0].age_ticks == NEVER_TICKS
    for tick in range(1, 4):
        assert ecu_port.send(ecu.command())
        can.publish(snapshot(tick))
    command, _ = can.take(4)
    assert (command.sequence, command.age_ticks) == (2.0, 0.0)
    can.publish(snapshot(4))
    can.publish(snapshot(5))
    assert can.take(6)[0].age_ticks == 2.0
    assert can.summary()["can"]["node"]["accepted"] == 2


def test_headless_node_sends_at_the_drives_own_time(on_bus: OnBus, ecu_port: CanPort, snapshot: Snapshots) -> None:
    can = HeadlessCan(on_bus)
    for tick in range(250):
        can.publish(snapshot(tick))
    received = 0
    while ecu_port.receive(0.0) is not None:
        received += 1
    assert received == 510  # 4 x 100 + 2 x 50 + 10: no wheel speeds here


def test_headless_flood_takes_a_bounded_number_of_frames_a_tick(
    on_bus: OnBus, ecu_port: CanPort, codec: Codec, snapshot: Snapshots
) -> None:
    can, ecu = HeadlessCan(on_bus), Ecu(codec, Wish())
    for _ in range(200):
        ecu_port.send(ecu.command())
    can.publish(snapshot(1))
    assert on_bus.port.counters().received == 64


class Worker:
    """`serve` in a thread, fed by the test."""

    def __init__(self, on_bus: OnBus) -> None:
        self.snapshots: list[Snapshot] = []
        self.commands: list[tuple[RemoteCommand, int | None]] = []
        self.events = 0
        self.statuses: list[dict[str, Any]] = []
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._serve, args=(on_bus,))
        self._thread.start()

    def _serve(self, on_bus: OnBus) -> None:
        serve(
            on_bus,
            lambda: self.snapshots.pop(0) if self.snapshots else None,
            lambda command, receipt_ns: self.commands.append((command, receipt_ns)),
            self._raise,
            self.statuses.append,
            self._stop.is_set,
        )

    def _raise(self, events: int) -> None:
        self.events |= events

    def end(self) -> None:
        self._stop.set()
        self._thread.join()


def test_worker_sends_takes_commands_and_reports(
    on_bus: OnBus, ecu_port: CanPort, codec: Codec, snapshot: Snapshots
) -> None:
    worker, ecu = Worker(on_bus), Ecu(codec, Wish(accel_mps2=1.0, request=5))
    try:
        began_ns = stamp_ns()
        worker.snapshots.append(snapshot(0))
        wait_until(lambda: ecu_port.receive(0.0) is not None, "a frame")
        for _ in range(15):
            ecu_port.send(ecu.command())
        wait_until(lambda: len(worker.commands) == 14 and worker.events != 0, "every command")
    finally:
        worker.end()
    command, receipt_ns = worker.commands[-1]
    assert command.sequence == 14
    assert receipt_ns is not None
    assert began_ns < receipt_ns < stamp_ns()
    assert worker.events == Event.EMERGENCY_STOP
    assert worker.statuses[0]["up"] is True
    assert worker.statuses[-1]["node"]["accepted"] == 14
    assert worker.statuses[-1]["command_state"] in (Check.OK.name, Check.NO_NEW_DATA.name)


def test_worker_tells_at_once_when_the_bus_goes_off(
    on_bus: OnBus, snapshot: Snapshots, monkeypatch: pytest.MonkeyPatch
) -> None:
    worker = Worker(on_bus)
    try:
        worker.snapshots.append(snapshot(0))
        wait_until(lambda: len(worker.statuses) == 1, "the first status")
        monkeypatch.setattr("simconsole.canbus.bus.worker._STATUS_S", 1e6)  # never again by its turn
        on_bus.port._down("a test")
        wait_until(lambda: len(worker.statuses) == 2, "the second status")
    finally:
        worker.end()
    assert [status["up"] for status in worker.statuses[:2]] == [True, False]
    assert worker.statuses[1]["down_reason"] == "a test"


def test_worker_without_new_ticks_is_silent(on_bus: OnBus, ecu_port: CanPort, snapshot: Snapshots) -> None:
    worker = Worker(on_bus)
    try:
        worker.snapshots.append(snapshot(0))
        wait_until(lambda: on_bus.node.counters().sent == 7, "the frames of a tick")
        pause(0.1)
        assert on_bus.node.counters().sent == 7
    finally:
        worker.end()
