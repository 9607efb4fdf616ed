"""Tyre files: what is refused, and by which key."""

import pytest

from simconsole.profiles.files.loader import profiles_folder
from simconsole.profiles.tyre import parse_tir
from simconsole.values.errors import ProfileError
from tests.paths import ROOT

FOLDER = profiles_folder() / "vehicles"
TEXT = (FOLDER / "tyres" / "example.tir").read_text()
ADAMS = (ROOT / "tests" / "vehicle" / "car" / "adams_205_60r15.tir").read_text()


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ("LENGTH = 'meter'", "LENGTH = 'mm'", "LENGTH"),
        ("ANGLE = 'radians'", "", "ANGLE"),
        ("'PAC2002'", "'FTIRE'", "PROPERTY_FILE_FORMAT"),
        ("PKX1 = 17.5", "", "PKX1"),
        ("PKX1 = 17.5", "PKX1 = nan", "PKX1"),
        ("PKX1 = 17.5", "PKX1 = inf", "PKX1"),
        ("PKX1 = 17.5", "PKX1 = much", "PKX1"),
        ("PKX1 = 17.5", "PKX1 = 0", "PKX1"),
        ("PKY1 = -16.0", "PKY1 = 16.0", "PKY1"),
        ("PCX1 = 1.6", "PCX1 = 1.6\nPCX1 = 1.7", "PCX1"),
        ("PCX1 = 1.6", "what is this", "line 18"),
    ],
)
def test_a_bad_file_is_refused_by_name_and_key(old: str, new: str, key: str) -> None:
    assert old in TEXT
    with pytest.raises(ProfileError, match=rf"^mine.tir: {key}: value "):
        parse_tir(TEXT.replace(old, new), "mine.tir")


def test_a_file_gives_all_of_combined_slip_or_none() -> None:
    without = "\n".join(line for line in ADAMS.splitlines() if line[:3] not in {"RBX", "RCX", "RBY", "RCY"})
    assert "RBX1" not in parse_tir(without, "mine.tir")
    with pytest.raises(ProfileError, match=r"^mine.tir: RBX1: value .*RCY1 all given"):
        parse_tir(ADAMS.replace("RCY1", "!"), "mine.tir")
