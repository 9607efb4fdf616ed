"""The templates as a person reads them."""

import pytest

from simconsole.cli.new.new_command import KINDS

TEXTS = {(kind, file): text for kind, files in KINDS.items() for file, text in files.items()}


@pytest.mark.parametrize("key", sorted(TEXTS), ids=" ".join)
def test_lines_are_short_enough_and_end_as_a_file_should(key: tuple[str, str]) -> None:
    text = TEXTS[key]
    assert max(len(line) for line in text.splitlines()) <= 120
    assert text.endswith("\n")
    assert not text.endswith("\n\n")


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_a_test_stands_beside_each(kind: str) -> None:
    assert "test_$name.py" in KINDS[kind]
    assert "def test_" in KINDS[kind]["test_$name.py"]
