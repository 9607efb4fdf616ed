"""The C cases of the fault catalogue: what may go wrong on the CAN bus while an ECU drives, in whole drives.

The drives are headless and in simulated time; only C03's flood and C02's reopening touch a real (virtual) bus.
"""

import errno
import itertools
import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import can
import msgspec
import numpy as np
import pytest

from simconsole.canbus.bus.port import CanPort
from simconsole.canbus.bus.worker import HeadlessCan, OnBus, load_codec
from simconsole.canbus.codec import COMMAND, Codec, Frame
from simconsole.canbus.node import CanNode
from simconsole.canbus.protection import Check, protected
from simconsole.hud.draw import Text
from simconsole.hud.layout import layout
from simconsole.hud.screen import Screen
from simconsole.hud.view import HudView
from simconsole.profiles.can import CanProfile
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.resolution import load_session, override, resolve
from simconsole.session.worker_programs import CanWatch
from simconsole.tick.assembly import assemble
from simconsole.tick.loop import Components, run
from simconsole.values.errors import CanError
from simconsole.values.host.jit import plain
from simconsole.values.kernels import Row
from simconsole.values.protocols import NobodyCommands, NobodySeated
from simconsole.values.signals import Mode, Reason
from simconsole.values.state_vector import LAYOUT, Snapshot
from tests.paths import ROOT

TICK_HZ = 250
STALE_TICKS = 50  # 200 ms
PERIOD_TICKS = 5  # the ECU's 50 Hz
FAULT = 150
TICKS = 400
MODE = LAYOUT.arbitration.at("mode")
REASON = LAYOUT.arbitration.at("reason")
SEQUENCE = LAYOUT.ecu.at("sequence")
REFUSED = LAYOUT.ecu.at("refused")
AGE = LAYOUT.ecu.at("age_ticks")

_channels = itertools.count()
Fault = Callable[[int, Frame], list[Frame]]
"""What the bus makes of the ECU's frame number n after the fault began."""


@pytest.fixture(scope="module")
def codec() -> Codec:
    return load_codec()


@pytest.fixture
def profile() -> CanProfile:
    return CanProfile(interface="virtual", channel=f"faults-{os.getpid()}-{next(_channels)}", log=())


class EcuSeat:
    """An ECU that engages, then drives straight on; from tick FAULT on, `fault` stands between it and the bus."""

    def __init__(self, codec: Codec, port: CanPort, fault: Fault) -> None:
        self._codec, self._port, self._fault = codec, port, fault
        self._count = self._faulty = 0

    def publish(self, snapshot: Snapshot) -> None:
        if snapshot.tick % PERIOD_TICKS:
            return
        engage = float(snapshot.tick > 60 and snapshot.vector[MODE] != Mode.AUTONOMOUS and self._count % 2)
        values = {"REQUEST": engage, "ROAD_WHEEL": 0.0, "ACCEL": 1.0, "DIRECTION": 1.0}
        values |= {"TURN_INDICATORS": 0.0, "HAZARD_LIGHTS": 0.0}
        frame = self._codec.encode(COMMAND, values, self._count)
        self._count += 1
        frames = [frame]
        if snapshot.tick >= FAULT:
            frames = self._fault(self._faulty, frame)
            self._faulty += 1
        for sent in frames:
            self._port.send(sent)


class Recorded:
    """Keeps every state vector."""

    def __init__(self) -> None:
        self.vectors: list[Row] = []

    def write(self, snapshot: Snapshot) -> int:
        self.vectors.append(snapshot.vector)
        return 0


class Driven(NamedTuple):
    """A drive that is over."""

    vectors: Any  # one a tick
    on_bus: OnBus

    def mode(self, tick: int) -> Mode:
        return Mode(int(self.vectors[tick - 1, MODE]))

    def left(self) -> int:
        """The tick in which the ECU lost the car: nobody sits in it, so a safe stop begins in the same tick."""
        tick = FAULT + int(np.flatnonzero(self.vectors[FAULT - 1 :, MODE] != Mode.AUTONOMOUS)[0])
        assert self.mode(tick) is Mode.MINIMAL_RISK
        return tick


@pytest.fixture
def drive(codec: Codec, profile: CanProfile) -> Iterator[Callable[..., Driven]]:
    with ExitStack() as stack:

        def go(fault: Fault, opener: Any = None, clock: Any = None) -> Driven:
            resolved = resolve(override(load_session("can"), mode={"pacing": "free"}))
            console, state = assemble(resolved, plain)
            node = CanNode(codec, profile, TICK_HZ)
            options = {} if opener is None else {"opener": opener, "clock_s": clock}
            port = CanPort(profile, node.transmit_ids, node.receive_ids, **options)
            ecu_port = CanPort(profile, codec.ids("ECU"), frozenset())
            stack.callback(port.close)
            stack.callback(ecu_port.close)
            on_bus, recorded = OnBus(node, port), Recorded()
            link = HeadlessCan(on_bus)
            outputs = (link, EcuSeat(codec, ecu_port, fault))
            components = Components(NobodySeated(), NobodyCommands(), recorded, outputs, UnpacedPacer(), ecu=link)
            run(console, state, components, TICKS)
            return Driven(np.array(recorded.vectors), on_bus)

        yield go


def good(number: int, frame: Frame) -> list[Frame]:
    return [frame]


def bad_crc(number: int, frame: Frame) -> list[Frame]:
    return [Frame(frame.can_id, bytes((frame.data[0] ^ 0x5A,)) + frame.data[1:])]


def frozen_counter(number: int, frame: Frame) -> list[Frame]:
    return [Frame(frame.can_id, protected(frame.can_id, frame.data, 3))]


def jumping_counter(number: int, frame: Frame) -> list[Frame]:
    return [Frame(frame.can_id, protected(frame.can_id, frame.data, frame.data[1] + (5 if number % 2 else 10)))]


def short(number: int, frame: Frame) -> list[Frame]:
    return [Frame(frame.can_id, frame.data[:5])]


def too_much(number: int, frame: Frame) -> list[Frame]:
    word = int.from_bytes(frame.data, "little") | 0x7FFF << 32  # 32.8 m/s^2
    return [Frame(frame.can_id, protected(frame.can_id, word.to_bytes(8, "little"), frame.data[1] & 15))]


def nothing(number: int, frame: Frame) -> list[Frame]:
    return []


def test_c00_without_a_fault_the_ecu_drives(drive: Callable[..., Driven]) -> None:
    driven = drive(good)
    assert driven.mode(FAULT) is driven.mode(TICKS) is Mode.AUTONOMOUS
    assert driven.vectors[-1, REFUSED] == 0
    assert driven.vectors[FAULT:, AGE].max() <= PERIOD_TICKS


@pytest.mark.fault("C01")
@pytest.mark.parametrize("fault", [bad_crc, frozen_counter, jumping_counter, short, too_much])
def test_c01_five_bad_frames_in_a_row_end_the_commands(drive: Callable[..., Driven], fault: Fault) -> None:
    """Dropped each; the fifth is at the console 4 periods after the first, and the mode changes in that tick."""
    driven = drive(fault)
    assert driven.mode(FAULT) is Mode.AUTONOMOUS
    left = driven.left()
    assert FAULT + 4 * PERIOD_TICKS < left <= FAULT + 5 * PERIOD_TICKS + 2
    assert driven.vectors[left - 1, REASON] == Reason.COMMAND_INVALID
    assert driven.vectors[left - 1, REFUSED] >= 5
    if fault is not jumping_counter:  # that one is in step by chance now and then, once its counter was learnt anew
        assert driven.vectors[-1, SEQUENCE] == driven.vectors[FAULT, SEQUENCE]


@pytest.mark.fault("C01")
@pytest.mark.parametrize("fault", [bad_crc, frozen_counter, short])
def test_c01_one_bad_frame_is_dropped_and_no_more(drive: Callable[..., Driven], fault: Fault) -> None:
    driven = drive(lambda number, frame: fault(number, frame) if number == 0 else [frame])
    assert driven.mode(TICKS) is Mode.AUTONOMOUS
    assert driven.vectors[-1, REFUSED] == 1


@pytest.mark.fault("C01")
def test_c01_silence_is_stale_within_200_ms(drive: Callable[..., Driven]) -> None:
    driven = drive(nothing)
    left = driven.left()
    assert driven.vectors[left - 1, REASON] == Reason.COMMAND_STALE
    assert left - FAULT <= STALE_TICKS + 1
    assert driven.on_bus.node.state(TICKS * 4_000_000) is Check.NO_NEW_DATA


class FallingBus:
    """The virtual bus until it falls."""

    def __init__(self, bus: can.BusABC, yard: "FallingYard") -> None:
        self._bus, self._yard = bus, yard

    def send(self, message: can.Message, timeout: float | None = None) -> None:
        self._yard.look("send")
        self._bus.send(message, timeout)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        found = self._yard.look("recv")
        return found or self._bus.recv(timeout)

    def shutdown(self) -> None:
        self._bus.shutdown()


class FallingYard:
    """Opens buses. After `calls` of them one falls in the way that is asked for; it can be opened after `down_s`."""

    def __init__(self, how: str, calls: int, down_s: float) -> None:
        self._how, self._calls, self._down_s = how, calls, down_s
        self.now_s = 0.0
        self.fell_s: float | None = None
        self.tries: list[float] = []

    def open(self, profile: CanProfile, ids: frozenset[int]) -> Any:
        if self.fell_s is not None:
            self.tries.append(self.now_s - self.fell_s)
            if self.now_s - self.fell_s < self._down_s:
                raise CanError("network is down")
        return FallingBus(can.Bus(interface="virtual", channel=profile.channel), self)

    def clock_s(self) -> float:
        self.now_s += 0.0002  # every look at the clock: about 4 ms a tick
        return self.now_s

    def look(self, call: str) -> can.Message | None:
        self._calls -= 1
        if self._calls > 0 or self.fell_s is not None:
            return None
        if self._how == "bus-off" and call == "recv":
            self.fell_s = self.now_s
            return can.Message(is_error_frame=True, arbitration_id=0x40, data=bytes(8))
        if self._how == "send" and call == "send":
            self.fell_s = self.now_s
            raise can.CanOperationError("bus error")
        if self._how == "netdown":
            self.fell_s = self.now_s
            raise OSError(errno.ENETDOWN, "Network is down")
        return None


@pytest.mark.fault("C02")
@pytest.mark.parametrize("how", ["bus-off", "send", "netdown"])
def test_c02_bus_off_is_reported_and_the_drive_goes_on(drive: Callable[..., Driven], how: str) -> None:
    yard = FallingYard(how, 800, down_s=1e9)
    driven = drive(good, yard.open, yard.clock_s)
    assert len(driven.vectors) == TICKS
    assert yard.fell_s is not None
    assert not driven.on_bus.port.recovery.up
    assert driven.on_bus.port.counters().downs == 1
    reasons = set(driven.vectors[:, REASON].tolist())
    assert Reason.COMMANDER_LOST in reasons, "the person is told at once, not after the commands have grown stale"
    assert driven.mode(TICKS) in (Mode.MINIMAL_RISK, Mode.STOPPED)


@pytest.mark.fault("C02")
def test_c02_state_of_the_bus_stands_on_the_drivers_cluster(profile: CanProfile, codec: Codec, tmp_path: Path) -> None:
    """From the worker's own word over its file to the lamp in the draw list: up, off, up again."""
    yard = FallingYard("send", 1, down_s=20.0)
    port = CanPort(profile, codec.ids("CONSOLE"), codec.ids("ECU"), clock_s=lambda: yard.now_s, opener=yard.open)
    on_bus = OnBus(CanNode(codec, profile, 250), port)
    file, now = tmp_path / "can.json", [1.8e9]
    watch = CanWatch(file, lambda: now[0], lambda: now[0])

    def lamp() -> str:
        file.write_bytes(msgspec.json.encode(on_bus.status(0)))
        os.utime(file, (now[0], now[0]))
        now[0] += 1.0
        items = layout(HudView(can_up=watch()), Screen(1400, 1050, 1.6, 2.2))
        return next(item.text for item in items if isinstance(item, Text) and item.role == "status.can.label")

    shown = [lamp()]
    port.send(Frame(0x100, bytes(8)))
    shown.append(lamp())
    for _ in range(400):
        yard.now_s += 0.1
        port.send(Frame(0x100, bytes(8)))
    shown.append(lamp())
    port.close()
    assert shown == ["on", "down", "on"]


@pytest.mark.fault("C02")
def test_c02_tries_again_with_growing_waits_and_sends_again(profile: CanProfile) -> None:
    yard = FallingYard("send", 1, down_s=20.0)
    port = CanPort(profile, frozenset({0x100}), frozenset({0x200}), clock_s=lambda: yard.now_s, opener=yard.open)
    other = CanPort(profile, frozenset(), frozenset({0x100}))
    frame = Frame(0x100, bytes(8))
    assert not port.send(frame)
    for _ in range(400):
        yard.now_s += 0.1
        port.send(frame)
    assert yard.tries == pytest.approx([1, 3, 7, 15, 31], abs=0.51)
    assert port.up
    assert port.counters().sent == len(list(iter(lambda: other.receive(0.0), None)))
    port.close()
    other.close()


@pytest.mark.fault("C03")
def test_c03_flood_of_unknown_ids_is_filtered(drive: Callable[..., Driven], profile: CanProfile) -> None:
    """40 foreign frames a tick: 10,000 a second, above what 1 Mbit/s carries (about 8,000)."""
    with can.Bus(interface="virtual", channel=profile.channel) as flood:

        def flooded(number: int, frame: Frame) -> list[Frame]:
            for index in range(40 * PERIOD_TICKS):
                can_id = 0x300 + index % 0x100
                flood.send(can.Message(arbitration_id=can_id, data=bytes(8), is_extended_id=index % 2 == 0))
            return [frame]

        driven = drive(flooded)
    assert driven.mode(TICKS) is Mode.AUTONOMOUS
    assert driven.vectors[-1, REFUSED] == 0
    assert driven.vectors[FAULT:, AGE].max() <= PERIOD_TICKS
    assert driven.on_bus.port.counters().filtered >= 9_000


@pytest.mark.fault("C04")
def test_c04_replayed_old_frames_are_refused(drive: Callable[..., Driven]) -> None:
    """Beside the ECU somebody sends its frame of 5 periods ago again: each is refused, the ECU's own all count."""
    old: list[Frame] = []

    def replayed(number: int, frame: Frame) -> list[Frame]:
        old.append(frame)
        return [frame] if number < 5 or number % 3 else [frame, old[number - 5]]

    driven = drive(replayed)
    assert driven.mode(TICKS) is Mode.AUTONOMOUS
    replays = sum(number >= 5 and number % 3 == 0 for number in range(len(old)))
    assert replays > 10
    assert driven.vectors[-1, REFUSED] in (replays, replays - 1)  # the last may not have been read
    assert driven.vectors[FAULT:, AGE].max() <= PERIOD_TICKS


@pytest.mark.fault("C04")
def test_c04_one_old_frame_after_a_silence_commands_nothing(drive: Callable[..., Driven]) -> None:
    kept: list[Frame] = []

    def once(number: int, frame: Frame) -> list[Frame]:
        kept.append(frame)
        return [kept[0]] if number == 20 else []

    driven = drive(once)
    assert driven.vectors[-1, SEQUENCE] == driven.vectors[FAULT, SEQUENCE]


@pytest.mark.fault("C05")
def test_c05_no_frame_off_the_whitelist_can_leave(profile: CanProfile, codec: Codec) -> None:
    """Every id there is, standard and (a sample of) extended, on the console's own port."""
    node = CanNode(codec, profile, TICK_HZ)
    port = CanPort(profile, node.transmit_ids, node.receive_ids)
    with can.Bus(interface="virtual", channel=profile.channel) as listener:
        for can_id in (*range(0x800), *range(0, 0x2000_0000, 0x40_0001)):
            for extended in (False, True):
                if can_id in node.transmit_ids and not extended:
                    continue
                with pytest.raises(CanError):
                    port.send(Frame(can_id, bytes(8), extended))
        assert listener.recv(0.0) is None
        assert port.send(Frame(0x100, bytes(8)))
        assert listener.recv(0.0) is not None
    port.close()


@pytest.mark.fault("C05")
def test_c05_only_one_line_of_the_package_sends(codec: Codec) -> None:
    package = ROOT / "simconsole"
    importers = [path.name for path in package.rglob("*.py") if "import can\n" in path.read_text()]
    assert importers == ["port.py"]
    assert (package / "canbus" / "bus" / "port.py").read_text().count(".send(") == 1
