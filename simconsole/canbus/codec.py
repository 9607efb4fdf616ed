"""Physical values to frames and back, as the DBC says. The caller gives the DBC's text; cantools parses it.

The bits are packed here (2 us a message with its range check; cantools takes 6 unchecked and 17 checked); the tests
hold them against cantools' own encoding.
"""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Final, NamedTuple

from simconsole.canbus.protection import LENGTH, protected
from simconsole.values.errors import CanError
from simconsole.values.kernels import is_finite

if TYPE_CHECKING:
    from cantools.database import Message

CONSOLE: Final = "CONSOLE"
ECU: Final = "ECU"
COMMAND: Final = "ECU_COMMAND"
PROTECTION: Final = ("CRC", "COUNTER")


class Frame(NamedTuple):
    """A classic CAN data frame."""

    can_id: int
    data: bytes
    extended: bool = False


class SignalInfo(NamedTuple):
    """One signal: its bounds in its unit, half of its resolution, and where its bits lie (little-endian)."""

    low: float
    high: float
    half_step: float
    unit: str
    start: int
    mask: int
    sign: int  # the sign bit's weight, 0 where unsigned
    scale: float
    offset: float


class MessageInfo(NamedTuple):
    """One message of the DBC, without CRC and counter."""

    name: str
    can_id: int
    period_ms: int
    sender: str
    signals: dict[str, SignalInfo]
    comment: str


class Codec:
    """The messages of one DBC.

    Attributes:
        messages: by name.
        by_id: their names by id.
    """

    def __init__(self, text: str) -> None:
        """Read a DBC.

        Raises:
            CanError: it is no DBC, or a message lacks what every message here has.
        """
        from cantools.database import Database, load_string
        from cantools.errors import Error

        try:
            database = load_string(text, database_format="dbc", strict=True)
        except Error as error:
            raise CanError(f"DBC: {' '.join(str(error).split())}") from None
        assert isinstance(database, Database)
        self.messages = {message.name: _info(message) for message in database.messages}
        self.by_id = {message.can_id: message.name for message in self.messages.values()}

    def sent_by(self, sender: str) -> list[MessageInfo]:
        """Return the messages that a node sends, by id."""
        return sorted((info for info in self.messages.values() if info.sender == sender), key=lambda info: info.can_id)

    def ids(self, sender: str) -> frozenset[int]:
        """Return the ids that a node sends: the whitelist of what it may send, and of what others accept from it."""
        return frozenset(info.can_id for info in self.sent_by(sender))

    def encode(self, name: str, values: Mapping[str, float], counter: int, *, clip: bool = False) -> Frame:
        """Return the frame of a message. With `clip`, finite values beyond a bound are sent as the bound.

        Raises:
            CanError: a signal is missing, not finite or (without `clip`) out of its range.
        """
        info = self.messages[name]
        word = 0
        for signal, (low, high, half_step, _, start, mask, _, scale, offset) in info.signals.items():
            value = values.get(signal, math.nan)
            if not low <= value <= high:
                if not is_finite(value) or not (clip or low - half_step <= value <= high + half_step):
                    raise CanError(f"{name}.{signal}: value {value}: {low:g} to {high:g}")
                value = low if value < low else high
            word |= (round((value - offset) / scale) & mask) << start
        return Frame(info.can_id, protected(info.can_id, word.to_bytes(LENGTH, "little"), counter))

    def decode(self, name: str, data: bytes) -> dict[str, float] | None:
        """Return the values of a message of 8 bytes without CRC and counter, None where one is out of its range."""
        word = int.from_bytes(data, "little")
        found = {}
        for signal, (low, high, half_step, _, start, mask, sign, scale, offset) in self.messages[name].signals.items():
            raw = word >> start & mask
            if raw & sign:
                raw -= mask + 1
            value = raw * scale + offset
            if not low - half_step <= value <= high + half_step:
                return None
            found[signal] = value
        return found


def _info(message: "Message") -> MessageInfo:
    names = {signal.name for signal in message.signals}
    if message.length != LENGTH or not names.issuperset(PROTECTION) or len(message.senders) != 1:
        raise CanError(f"DBC: {message.name}: {LENGTH} bytes, one sender and the signals {', '.join(PROTECTION)}")
    if message.is_extended_frame or not message.cycle_time:
        raise CanError(f"DBC: {message.name}: an 11-bit id and GenMsgCycleTime above 0")
    signals = {}
    for signal in message.signals:
        if signal.name in PROTECTION:
            continue
        if signal.minimum is None or signal.maximum is None:
            raise CanError(f"DBC: {message.name}.{signal.name}: a range [minimum|maximum]")
        if signal.byte_order != "little_endian" or signal.is_float or signal.is_multiplexer or not signal.scale:
            raise CanError(f"DBC: {message.name}.{signal.name}: a little-endian whole number, not multiplexed")
        signals[signal.name] = SignalInfo(
            low=float(signal.minimum),
            high=float(signal.maximum),
            half_step=0.5 * abs(float(signal.scale)),
            unit=signal.unit or "",
            start=signal.start,
            mask=(1 << signal.length) - 1,
            sign=1 << (signal.length - 1) if signal.is_signed else 0,
            scale=float(signal.scale),
            offset=float(signal.offset),
        )
    return MessageInfo(
        name=message.name,
        can_id=message.frame_id,
        period_ms=message.cycle_time,
        sender=message.senders[0],
        signals=signals,
        comment=message.comment or "",
    )
