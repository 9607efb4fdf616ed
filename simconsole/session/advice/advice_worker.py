"""The worker that advises the driver: a client of the drive's own bridge, which knows what topics tell and no more."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Final

import msgspec

from simconsole.processes.byte_slot import ByteSlot, Piece
from simconsole.processes.worker import Worker
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.profiles.world import WorldProfile
from simconsole.recording.log_header import ADVICE
from simconsole.values.errors import BridgeError, OtherDriveError
from simconsole.values.units import NS_PER_S, tick_time_ns
from simconsole.world.rules.speed_advice import NO_ADVICE, Advice, from_bytes, to_bytes

if TYPE_CHECKING:
    from simconsole.drivers.autopilot.route_advice import RouteAdvice

ADVICE_BYTES: Final = 256
OLD_S: Final = 1.0
"""Advice that was not renewed for so long is not shown: who gives it has fallen silent."""
_RATE_HZ: Final = 10.0
_WAIT_S: Final = 0.1


class AdviceWorker(Worker, frozen=True, kw_only=True):
    """Hears odometry and traffic lights, and writes how fast to drive."""

    world: WorldProfile
    vehicle: VehicleProfile
    drive: str
    """The drive's nonce."""
    address: str
    """The file of the run folder with the bridge's address."""
    token: str | None = None
    certificate: str | None = None
    namespace: str = ""
    rename: dict[str, str] = msgspec.field(default_factory=dict)

    def run(self, folder: Path, stop: Callable[[], bool]) -> None:
        """Advise until `stop`."""
        slot = ByteSlot.open(folder / ADVICE, writable=True)
        while not (folder / self.address).exists():
            if stop():
                return
            time.sleep(_WAIT_S)
        advice = self._route_advice()
        while not stop():
            # A bridge that is started again may listen at another port.
            url = (folder / self.address).read_text("utf-8")
            try:
                self._advise(advice, url, slot, stop)
            except OtherDriveError:
                raise
            except BridgeError:
                time.sleep(_WAIT_S)

    def _route_advice(self) -> "RouteAdvice":
        from simconsole.drivers.autopilot.route_advice import RouteAdvice
        from simconsole.world.kinds.worlds import open_world

        return RouteAdvice(open_world(self.world), self.vehicle)

    def _advise(self, advice: "RouteAdvice", url: str, slot: ByteSlot, stop: Callable[[], bool]) -> None:
        """Advise as long as the connection holds.

        Raises:
            BridgeError: it does not.
        """
        from simconsole.bridge.client.bridge_client import BridgeClient
        from simconsole.bridge.transport.addresses import reached_here
        from simconsole.drivers.autopilot.lights import SIGNALS, SIGNALS_TYPE, lights_of
        from simconsole.drivers.autopilot.motion import Odometry, motion_of
        from simconsole.drivers.autopilot.rosbridge_autopilot import ODOMETRY

        odometry, signals = (self.rename.get(topic, self.namespace + topic) for topic in (ODOMETRY, SIGNALS))
        with BridgeClient(
            reached_here(url), token=self.token, certificate=self.certificate, drive=self.drive, comes_back=False
        ) as client:
            client.subscribe(odometry, "nav_msgs/Odometry", reads=Odometry, throttle_rate=round(1000.0 / _RATE_HZ))
            client.subscribe(signals, SIGNALS_TYPE)
            client.connect()
            while not stop():
                received = client.receive(_WAIT_S)
                if received is None:
                    continue
                topic, message = received
                if topic == signals:
                    advice.see(lights_of(message))
                elif (seen := motion_of(message)) is not None:
                    stamp = message.header.stamp
                    told = advice.advise(seen, stamp.sec + stamp.nanosec / NS_PER_S)
                    slot.write(stamp.sec * NS_PER_S + stamp.nanosec, to_bytes(told))


_NOTHING: Final = to_bytes(NO_ADVICE)


def _is_old(piece: Piece, now_ns: int) -> bool:
    return now_ns - piece.number > OLD_S * NS_PER_S


class NewestAdvice:
    """What the display shows: the newest advice, nothing where it is old."""

    def __init__(self, folder: Path) -> None:
        self._slot = ByteSlot.open(folder / ADVICE)
        self._piece: Piece | None = None
        self._advice = NO_ADVICE

    def __call__(self, now_ns: int) -> Advice:
        """Return what holds at a time of the drive."""
        piece = self._slot.newest()
        if piece is None or _is_old(piece, now_ns):
            return NO_ADVICE
        if piece is not self._piece:
            self._piece, self._advice = piece, from_bytes(piece.content)
        return self._advice


class AdviceSource:
    """What was advised, for the log: each advice when it is another, and none when it is old, as the display has it."""

    def __init__(self, slot: ByteSlot, tick_hz: int) -> None:
        self._slot, self._tick_hz = slot, tick_hz
        self._told = _NOTHING

    def take_messages(self, tick: int) -> list[tuple[str, bytes]]:
        """Return what holds at a tick, if it is not what held before."""
        piece = self._slot.newest()
        content = _NOTHING if piece is None or _is_old(piece, tick_time_ns(tick, self._tick_hz)) else piece.content
        if content == self._told:
            return []
        self._told = content
        return [(ADVICE, content)]


class ToldAdvice:
    """What a controller in lockstep says that it goes by, for the log: each advice when it is another."""

    def __init__(self) -> None:
        self._newest = self._told = _NOTHING

    def take(self, text: str) -> None:
        """Take an advice as JSON.

        Raises:
            ValueError: it is none.
        """
        self._newest = to_bytes(from_bytes(text.encode()))

    def take_messages(self, tick: int) -> list[tuple[str, bytes]]:
        """Return what holds at a tick, if it is not what held before."""
        if self._newest == self._told:
            return []
        self._told = self._newest
        return [(ADVICE, self._told)]


def gives_advice(session: SessionProfile) -> bool:
    """Return whether a drive advises its driver how to come to lights at green."""
    return session.mode.pacing == "realtime" and session.features.speed_advice


def hears_advice(session: SessionProfile) -> bool:
    """Return whether the log keeps what a controller in lockstep goes by: of one platform."""
    lockstep = session.mode.pacing == "lockstep" and session.outputs.bridge is not None
    return lockstep and session.features.speed_advice and not session.scenario.platforms


def share_advice(session: SessionProfile, folder: Path, tick_hz: int) -> AdviceSource | None:
    """Make the memory through which advice comes; None where none is given.

    Raises:
        WorkerError: it cannot be made.
    """
    return AdviceSource(ByteSlot.create(folder / ADVICE, ADVICE_BYTES), tick_hz) if gives_advice(session) else None
