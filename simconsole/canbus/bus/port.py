"""The bus itself: the only module that imports python-can, and the only way to it. See docs/can.md.

Only ids on the whitelists are sent and received, whatever the caller asks for. A bus that goes off (error
frame, failed send, interface down) is closed, reported and opened again with growing waits; meanwhile sending does
nothing and receiving returns nothing, so no loop stands still for it.
"""

import logging
import struct
import time
import zlib
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple, cast

from simconsole.canbus.bus.multicast import LoopbackBus
from simconsole.canbus.codec import Frame
from simconsole.canbus.recovery import BUS_OFF, Recovery, Seldom, error_label
from simconsole.profiles.can import CanProfile
from simconsole.values.errors import CanError

if TYPE_CHECKING:
    from pathlib import Path

    import can
    from can.io.generic import MessageWriter

LOG_FILES: Final = {"blf": "can.blf", "candump": "can.log", "asc": "can.asc"}
_TOLD_S: Final = 10.0
"""Error frames come in floods: they are counted, and logged at most once in this time."""
_FULL: Final = (11, 105)  # EAGAIN, ENOBUFS: the send queue is full, which is no fault of the bus
_UNDERWAY_MAX: Final = 256
"""Most frames read in one call: a flood of foreign frames must end the call, not delay the caller's cycle."""

_logger = logging.getLogger("simconsole.canbus.bus.port")

Opener = Callable[[CanProfile, frozenset[int]], "can.BusABC"]
"""Opens a bus that receives only these ids (where its back end can filter)."""


class PortCounters(NamedTuple):
    """What a port has seen since it was opened."""

    sent: int
    received: int
    filtered: int
    dropped: int
    error_frames: int
    downs: int


class CanPort:
    """One open bus.

    Attributes:
        recovery: whether it is up, and why it went down last.
    """

    def __init__(
        self,
        profile: CanProfile,
        transmit_ids: frozenset[int],
        receive_ids: frozenset[int],
        *,
        logs: "Sequence[Path]" = (),
        clock_s: Callable[[], float] = time.monotonic,
        opener: "Opener | None" = None,
    ) -> None:
        """Open the bus. `logs` are files to make, their kind by suffix (.blf, .asc, .log).

        Raises:
            CanError: the back end is missing or the bus cannot be opened.
        """
        self._profile = profile
        self._transmit_ids = transmit_ids
        self._receive_ids = receive_ids
        self._clock_s = clock_s
        self._opener = opener or open_bus
        self._bus: can.BusABC | None = self._opener(profile, receive_ids)
        self._writers = open_logs(logs)
        self._may_tell = Seldom(_TOLD_S)
        self.recovery = Recovery(profile.retry_first_s, profile.retry_last_s)
        self._sent = self._received = self._filtered = self._dropped = self._error_frames = 0

    @property
    def up(self) -> bool:
        """Whether frames can be sent; opens a bus that went off again once its wait has passed."""
        if self.recovery.is_due(self._clock_s()):
            self._try_again()
        return self.recovery.up

    def send(self, frame: Frame) -> bool:
        """Send a frame; return whether the bus took it.

        Raises:
            CanError: its id is not on the whitelist. Nothing was sent.
        """
        if frame.extended or frame.can_id not in self._transmit_ids:
            raise CanError(f"id {frame.can_id:#x}: not one that this program may send")
        if not self.up or self._bus is None:
            return False
        import can

        message = can.Message(
            timestamp=time.time(), arbitration_id=frame.can_id, data=frame.data, is_extended_id=False, is_rx=False
        )
        try:
            self._bus.send(message, timeout=0.0)
        except (can.CanError, OSError) as error:
            if _error_number(error) in _FULL:
                self._dropped += 1
            else:
                self._down(f"cannot send: {error}")
            return False
        self._sent += 1
        self._log(message)
        return True

    def receive(self, timeout_s: float) -> Frame | None:
        """Return the next frame on the whitelist, None when none came within `timeout_s` or the bus is down.

        A port that is down sleeps for the time-out, so that a caller's cycle stays as long as it was.
        """
        deadline_s = self._clock_s() + timeout_s
        for _ in range(_UNDERWAY_MAX):
            left_s = deadline_s - self._clock_s()
            if not self.up or self._bus is None:
                if left_s > 0.0:
                    time.sleep(left_s)
                return None
            message = self._take(max(0.0, left_s))
            if message is None:
                return None
            frame = self._frame(message)
            if frame is not None:
                return frame
            if left_s <= 0.0 < timeout_s:
                return None
        return None

    def counters(self) -> PortCounters:
        """Return what this port has seen."""
        return PortCounters(
            sent=self._sent,
            received=self._received,
            filtered=self._filtered,
            dropped=self._dropped,
            error_frames=self._error_frames,
            downs=self.recovery.downs,
        )

    def close(self) -> None:
        """Close logs and bus; twice is harmless."""
        for writer in self._writers:
            _stop(writer)
        self._writers = []
        self._shut()

    def _take(self, timeout_s: float) -> "can.Message | None":
        import can

        assert self._bus is not None
        try:
            return self._bus.recv(timeout_s)
        except (can.CanError, OSError) as error:
            self._down(f"cannot receive: {error}")
            return None

    def _frame(self, message: "can.Message") -> Frame | None:
        if message.is_error_frame:
            self._error_frames += 1
            if self._may_tell(self._clock_s()):
                said = error_label(message.arbitration_id)
                _logger.warning("CAN %s: error frame: %s (%d so far)", self._profile.channel, said, self._error_frames)
            if message.arbitration_id & BUS_OFF:
                self._down("bus-off")
            return None
        plain = not (message.is_extended_id or message.is_remote_frame or message.is_fd)
        if not plain or message.arbitration_id not in self._receive_ids:
            self._filtered += 1
            return None
        self._received += 1
        self._log(message)
        return Frame(message.arbitration_id, bytes(message.data))

    def _down(self, reason: str) -> None:
        _logger.warning("CAN %s: %s; nothing is sent until it is open again", self._profile.channel, reason)
        self._shut()
        self.recovery.went_down(reason, self._clock_s())

    def _try_again(self) -> None:
        try:
            self._bus = self._opener(self._profile, self._receive_ids)
        except CanError as error:
            self.recovery.went_down(str(error), self._clock_s())
            return
        self.recovery.came_up(self._clock_s())
        _logger.warning("CAN %s: open again", self._profile.channel)

    def _shut(self) -> None:
        bus, self._bus = self._bus, None
        if bus is None:
            return
        import can

        try:
            bus.shutdown()
        except (can.CanError, OSError) as error:
            _logger.warning("CAN %s: closing: %s", self._profile.channel, error)

    def _log(self, message: "can.Message") -> None:
        for writer in list(self._writers):
            try:
                writer.on_message_received(message)
            except OSError as error:
                _logger.warning("CAN log: %s; this log ends here", error)
                self._writers.remove(writer)
                _stop(writer)


def open_bus(profile: CanProfile, receive_ids: frozenset[int]) -> "can.BusABC":
    """Open the bus that a profile names.

    Raises:
        CanError: the back end's driver is missing, or it cannot be opened.
    """
    import can

    options: dict[str, Any] = {}
    if profile.bitrate_bps is not None:
        options["bitrate"] = profile.bitrate_bps
    filters: list[Any] | None = None
    if profile.interface == "socketcan":  # the kernel filters, error frames pass; else `receive` filters
        filters = [{"can_id": number, "can_mask": 0x7FF, "extended": False} for number in sorted(receive_ids)]
    try:
        if profile.interface == "udp_multicast":
            return _loopback(profile)
        bus = can.Bus(channel=profile.channel, interface=profile.interface, can_filters=filters, **options)
    except (can.CanError, OSError, ValueError, NotImplementedError, ImportError) as error:
        where = f"{profile.interface} {profile.channel}"
        raise CanError(f"CAN {where}: cannot be opened: {' '.join(str(error).split())}") from None
    return bus


def open_logs(paths: "Sequence[Path]") -> "list[MessageWriter]":
    """Make logs, by suffix: BLF (.blf), Vector ASCII (.asc), candump (.log); they become whole when they are closed.

    Raises:
        CanError: one cannot be made.
    """
    if not paths:
        return []
    import can

    kinds: dict[str, Any] = {".blf": can.BLFWriter, ".asc": can.ASCWriter}
    writers: list[Any] = []
    for path in paths:
        try:
            writers.append(kinds.get(path.suffix, can.CanutilsLogWriter)(path))
        except OSError as error:
            raise CanError(f"{path}: cannot be written: {error.strerror}") from None
    return writers


def read_log(path: "Path") -> list[tuple[float, Frame]]:
    """Return the data frames of a log (.blf, .log of candump, .asc) with their times in s from the first.

    Raises:
        CanError: it cannot be read.
    """
    import can
    from can.io.blf import BLFParseError

    broken = (can.CanError, BLFParseError, OSError, ValueError, LookupError, EOFError, struct.error, zlib.error)
    readers: dict[str, tuple[str, Callable[[Any], Any]]] = {
        ".blf": ("rb", can.BLFReader),
        ".log": ("r", can.CanutilsLogReader),
        ".asc": ("r", can.ASCReader),
    }
    mode, reader = readers.get(path.suffix, ("", None))
    if reader is None:
        raise CanError(f"{path}: not a CAN log: {', '.join(readers)}")
    try:
        with path.open(mode) as file:
            messages = [found for found in reader(file) if not (found.is_error_frame or found.is_remote_frame)]
    except broken as error:
        raise CanError(f"{path}: not a CAN log: {' '.join(str(error).split())}") from None
    start_s = messages[0].timestamp if messages else 0.0
    return [
        (message.timestamp - start_s, Frame(message.arbitration_id, bytes(message.data), message.is_extended_id))
        for message in messages
    ]


def _loopback(profile: CanProfile) -> "can.BusABC":
    from can.interfaces.udp_multicast import utils

    utils.is_msgpack_installed()

    def unpack(data: bytes, now_s: float) -> "can.Message":
        return utils.unpack_message(data, replace={"timestamp": now_s}, check=True)

    return cast("can.BusABC", LoopbackBus(profile.channel, profile.port, utils.pack_message, unpack))


def _error_number(error: Exception) -> int | None:
    number = getattr(error, "error_code", None) or getattr(error, "errno", None)
    if number is None and isinstance(error.__cause__, OSError):
        number = error.__cause__.errno
    return number


def _stop(writer: Any) -> None:
    try:
        writer.stop()
    except OSError as error:
        _logger.warning("CAN log: %s; its end is missing", error)
