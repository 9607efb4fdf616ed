"""The frames that nearly all traffic consists of, without the general parser: whole messages of moderate length.

A message in one final text or binary frame needs none of a protocol's state. Taking it off the front of what arrived
costs a tenth of what the library's generators do; everything else, and every mistake, is left to the library.
"""

import os
from typing import Final

from websockets.frames import apply_mask  # type: ignore[attr-defined]  # its compiled form where there is one
from websockets.protocol import Protocol, Side, State

from simconsole.bridge.protocol.frames import BINARY, TEXT
from simconsole.bridge.protocol.message_decoding import Binary

_FINAL: Final = 0x80
_MASKED: Final = 0x80
_OPCODES: Final = {_FINAL | TEXT: TEXT, _FINAL | BINARY: BINARY}
_TWO_BYTES: Final = 126
"""In the place of a length: it follows in two bytes. Longer messages are left to the library."""
_LONGEST: Final = 65_535


def take_whole(web: Protocol, data: bytes) -> tuple[list[tuple[int, bytes]], bytes]:
    """Return the whole messages with which `data` begins, each with its opcode, and the rest for `web.receive_data`.

    None are returned while the library is inside a frame or a message, or the connection is not open.
    """
    frames: list[tuple[int, bytes]] = []
    if web.state is not State.OPEN or web.current_size is not None or web.reader.buffer:
        return frames, data
    masked = web.side is Side.SERVER  # what a server gets is masked
    longest = min(_LONGEST, web.max_message_size or _LONGEST)
    at, size = 0, len(data)
    while at + 2 <= size:
        opcode, length, start = _OPCODES.get(data[at]), data[at + 1], at + 2
        if masked:
            length -= _MASKED  # without the bit it is negative
        if opcode is None or not 0 <= length <= _TWO_BYTES:
            break
        if length == _TWO_BYTES:
            length, start = int.from_bytes(data[start : start + 2]), start + 2
        end = start + length + (4 if masked else 0)
        if end > size or length > longest:
            break
        content = apply_mask(data[start + 4 : end], data[start : start + 4]) if masked else data[start:end]
        frames.append((opcode, content))
        at = end
    return frames, data[at:] if at else data


def masked_frame(message: bytes) -> bytes | None:
    """Return a client's frame for a whole message, text or `Binary`; None if it is left to the library."""
    length = len(message)
    if length > _LONGEST:
        return None
    head = _FINAL | (BINARY if isinstance(message, Binary) else TEXT)
    mask = os.urandom(4)
    if length < _TWO_BYTES:
        return bytes((head, _MASKED | length)) + mask + apply_mask(message, mask)
    return bytes((head, _MASKED | _TWO_BYTES)) + length.to_bytes(2) + mask + apply_mask(message, mask)
