"""What protects every message: a CRC-8 in byte 0 and a 4-bit counter in the low half of byte 1.

The CRC is AUTOSAR's Crc_CalculateCRC8 (SAE J1850: polynomial 0x1D, start 0xFF, result inverted; "123456789" gives
0x4B). It covers the message's id, as AUTOSAR's data id does, so that a frame under a wrong id fails. This finds faults;
it is no signature: whoever can write to the bus can also compute CRC and counter.

::

    NO_NEW_DATA --first good CRC: counter learnt--> NO_NEW_DATA --counter in sequence--> OK
    OK --same counter--> REPEATED;  --step too large--> WRONG_SEQUENCE;  --...--> WRONG_CRC, WRONG_LENGTH
    any --no OK frame for the time-out--> NO_NEW_DATA, counter forgotten
    any --`invalid_max` bad frames in a row--> counter learnt anew from the last
"""

from enum import IntEnum
from typing import Final

LENGTH: Final = 8
COUNTERS: Final = 16
_POLYNOMIAL: Final = 0x1D


class Check(IntEnum):
    """What became of the newest frame of a message; only OK frames are used."""

    NO_NEW_DATA = 0
    OK = 1
    REPEATED = 2
    WRONG_SEQUENCE = 3
    WRONG_CRC = 4
    WRONG_LENGTH = 5
    OUT_OF_RANGE = 6


def _table() -> bytes:
    entries = []
    for byte in range(256):
        value = byte
        for _ in range(8):
            value = (value << 1) ^ _POLYNOMIAL if value & 0x80 else value << 1
            value &= 0xFF
        entries.append(value)
    return bytes(entries)


_TABLE: Final = _table()


def crc8(data: bytes) -> int:
    """Return the CRC-8 of `data` (SAE J1850)."""
    value = 0xFF
    for byte in data:
        value = _TABLE[value ^ byte]
    return value ^ 0xFF


def checksum(can_id: int, data: bytes | bytearray) -> int:
    """Return what byte 0 of a message must be: the CRC over its id (low, high byte) and its bytes from 1 on."""
    value = _TABLE[_TABLE[0xFF ^ (can_id & 0xFF)] ^ (can_id >> 8)]
    for byte in data[1:]:
        value = _TABLE[value ^ byte]
    return value ^ 0xFF


def protected(can_id: int, data: bytes, counter: int) -> bytes:
    """Return `data` (8 bytes) with counter and CRC put in."""
    found = bytearray(data)
    found[1] = (found[1] & 0xF0) | (counter % COUNTERS)
    found[0] = checksum(can_id, found)
    return bytes(found)


class Receiver:
    """Watches one message: is it whole, new, in sequence, in time? Times are ns of whatever clock the caller has.

    Attributes:
        state: of the newest frame.
        lost: frames that the counter says were sent and never came.
        refused: frames that came and were not used.
    """

    def __init__(self, can_id: int, timeout_ns: int, step_max: int = 2, invalid_max: int = 5) -> None:
        """Watch message `can_id`; for the limits see profiles/can.py."""
        self._id = can_id
        self._timeout_ns = timeout_ns
        self._step_max = step_max
        self._invalid_max = invalid_max
        self._counter: int | None = None
        self._run = 0
        self._since_ns: int | None = None  # of the last good frame, or of the first one
        self.state = Check.NO_NEW_DATA
        self.lost = 0
        self.refused = 0

    def take(self, data: bytes, now_ns: int) -> Check:
        """Judge a frame that came at `now_ns`."""
        self.look(now_ns)
        if len(data) != LENGTH:
            return self._refuse(Check.WRONG_LENGTH)
        if data[0] != checksum(self._id, data):
            return self._refuse(Check.WRONG_CRC)
        counter = data[1] & 0x0F
        if self._counter is None:
            self._counter, self._since_ns = counter, now_ns
            return self.state
        step = (counter - self._counter) % COUNTERS
        if 1 <= step <= self._step_max:
            self._counter, self._since_ns, self._run = counter, now_ns, 0
            self.lost += step - 1
            self.state = Check.OK
            return self.state
        if self._run + 1 >= self._invalid_max:
            self._counter, self._since_ns = counter, now_ns
        return self._refuse(Check.REPEATED if step == 0 else Check.WRONG_SEQUENCE)

    def look(self, now_ns: int) -> Check:
        """Return the state at `now_ns`: NO_NEW_DATA once the time-out has passed since the last good frame."""
        if self._since_ns is not None and now_ns - self._since_ns >= self._timeout_ns:
            self.state, self._counter, self._since_ns = Check.NO_NEW_DATA, None, None
        return self.state

    def _refuse(self, why: Check) -> Check:
        self._run += 1
        self.refused += 1
        self.state = why
        return why
