"""Texts with a few bytes cut, put in or turned over."""

import random
from typing import Final

WRECKS: Final = [
    b"",
    b"\x00",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"{",
    b"}",
    b"[",
    b'"',
    b"\\",
    b"NaN",
    b"1e999",
    b"\xed\xa0\x80",
    b",",
]


def wreck(chance: random.Random, valid: bytes, most: int) -> bytes:
    """Return a valid text after 1 to `most` such changes."""
    text = bytearray(valid)
    for _ in range(chance.randint(1, most)):
        at = chance.randrange(len(text) + 1)
        kind = chance.randrange(4)
        if kind == 0:
            del text[at:]
        elif kind == 1:
            text[at:at] = chance.choice(WRECKS)
        elif kind == 2:
            del text[at : at + chance.randint(1, 8)]
        elif text:
            text[min(at, len(text) - 1)] ^= 1 << chance.randrange(8)
    return bytes(text)
