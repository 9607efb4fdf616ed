"""JSON files that hold their own checksum: whichever byte of one changes, is added or goes, it is refused.

The second line is the checksum, and it is that of the text without the second line: `sed 2d FILE | sha256sum` gives it
too. It is taken over bytes, not over a text made again from the content, so that it will hold whatever later versions
write numbers or keys like.
"""

import re
from hashlib import sha256
from pathlib import Path
from typing import Any, Final

import msgspec

from simconsole.values.errors import RecordingError

KEY: Final = "sha256"
_START: Final = b"{\n"
_LINE: Final = re.compile(rb'\{\n  "sha256": "([0-9a-f]{64})",\n')


def sealed(content: msgspec.Struct | dict[str, Any]) -> bytes:
    """Return the text of a JSON object with at least one field, its own checksum in the second line."""
    text = msgspec.json.format(msgspec.json.encode(content), indent=2) + b"\n"
    return _START + b'  "%s": "%s",\n' % (KEY.encode(), sha256(text).hexdigest().encode()) + text[len(_START) :]


def read_object(path: Path, content: bytes) -> dict[str, Any]:
    """Return what a JSON object holds, sealed or not.

    Raises:
        RecordingError: not JSON, or no object.
    """
    try:
        return msgspec.json.decode(content, type=dict[str, Any])
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise RecordingError(f"{path}: {error}") from None


def seal_problem(path: Path, content: bytes) -> str | None:
    """Return one line if a text is not as it was sealed, else None."""
    line = _LINE.match(content)
    if line is None:
        return f"{path}: altered: its second line is not its own {KEY}"
    found, stated = sha256(_START + content[line.end() :]).hexdigest(), line[1].decode()
    return None if found == stated else f"{path}: altered: sha256 without its second line {found}, that says {stated}"
