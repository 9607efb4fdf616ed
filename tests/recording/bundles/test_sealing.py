import hashlib
from pathlib import Path

import pytest

from simconsole.recording.bundles.sealing import read_object, seal_problem, sealed
from simconsole.values.errors import RecordingError

HERE = Path("here.json")


def test_the_checksum_is_that_of_the_text_without_the_second_line() -> None:
    text = sealed({"name": "x", "figures": [1, 2.5]})
    lines = text.splitlines(keepends=True)
    rest = hashlib.sha256(b"".join((lines[0], *lines[2:]))).hexdigest()
    assert lines[1] == f'  "sha256": "{rest}",\n'.encode()
    assert read_object(HERE, text) == {"sha256": rest, "name": "x", "figures": [1, 2.5]}
    assert seal_problem(HERE, text) is None


def test_a_text_of_another_form_or_content_is_told() -> None:
    text = sealed({"name": "x"})
    assert str(seal_problem(HERE, text.replace(b'"x"', b'"y"'))).startswith("here.json: altered: sha256 without its")
    for other in (text + b" ", b" " + text, text.replace(b"\n", b"\r\n"), text.upper(), b"", b"{}\n"):
        assert str(seal_problem(HERE, other)).startswith("here.json: altered: ")


@pytest.mark.parametrize("text", [b"", b"[]", b"{", b"\xff", b"[" * 100_000])
def test_what_is_no_object_is_one_line(text: bytes) -> None:
    with pytest.raises(RecordingError, match=r"^here\.json: .*$"):
        read_object(HERE, text)
