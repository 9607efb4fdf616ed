"""What clients of rosbridge make of its messages."""

import base64
import json
import struct
import zlib
from typing import Any

import cbor2

from simconsole.bridge.protocol.message_decoding import Binary


def read_any(text: bytes) -> dict[str, Any]:
    """A message in any of its forms."""
    fields = cbor2.loads(text) if isinstance(text, Binary) else json.loads(text)
    if fields["op"] == "png":
        fields = json.loads(unpacked(text))
    assert isinstance(fields, dict)
    return fields


def unpacked(text: bytes) -> bytes:
    """The text inside of a PNG, as rosbridge_suite's clients read it."""
    data = base64.b64decode(json.loads(text)["data"])
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, lines, width = 8, b"", 0
    while at < len(data):
        (length,) = struct.unpack_from(">I", data, at)
        name, content = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        assert struct.unpack_from(">I", data, at + 8 + length)[0] == zlib.crc32(name + content)
        if name == b"IHDR":
            width = struct.unpack_from(">I", content)[0]
        if name == b"IDAT":
            lines = zlib.decompress(content)
        at += 12 + length
    row = 3 * width + 1
    return b"".join(lines[start + 1 : start + row] for start in range(0, len(lines), row))
