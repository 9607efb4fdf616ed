"""What differs between two drives, for a person and as JSON."""

import math
from pathlib import Path

import pytest

from simconsole.cli.differing import (
    SHOWN_FIELDS,
    columns_text,
    differences_text,
    plain_differences,
    read_tolerances,
)
from simconsole.recording.differences import FieldDifference
from simconsole.values.errors import ProfileError

NAMES = ("recorded", "replayed")
SPEED = FieldDifference(
    field="vehicle.vx_mps",
    unit="m/s",
    first_tick=20,
    largest=2.5,
    largest_tick=21,
    ticks=7,
    around=((19, 1.0, 1.0), (20, 1.5, 2.0), (21, 2.0, 4.5)),
)


def test_the_table_names_each_field_and_the_ticks_around_its_first_difference() -> None:
    lines = differences_text([SPEED], NAMES).splitlines()
    assert lines[0].split() == ["field", "unit", "first", "tick", "largest", "difference", "at", "tick", "ticks"]
    assert lines[1].split() == ["vehicle.vx_mps", "m/s", "20", "2.5", "21", "7"]
    assert lines[3] == "vehicle.vx_mps"
    assert lines[4].split() == ["19", ">20", "21"]
    assert lines[5].split() == ["recorded", "1", "1.5", "2"]
    assert lines[6].split() == ["replayed", "1", "2", "4.5"]
    assert lines[7].split() == ["change", "0", "0.5", "2.5"]


def test_many_fields_stand_in_the_table_and_the_first_of_them_with_their_ticks() -> None:
    many = [SPEED._replace(field=f"platform.field{number}") for number in range(SHOWN_FIELDS + 3)]
    text = differences_text(many, NAMES)
    assert all(one.field in text for one in many)
    assert text.count(">20") == SHOWN_FIELDS
    assert text.splitlines()[-1] == "the ticks around the first difference of 3 more fields: --json"


def test_plain_values_say_what_each_drive_had() -> None:
    (plain,) = plain_differences([SPEED], NAMES)
    assert (plain["field"], plain["recorded"], plain["replayed"], plain["largest"]) == ("vehicle.vx_mps", 1.5, 2.0, 2.5)
    assert plain["around"][2] == {"tick": 21, "recorded": 2.0, "replayed": 4.5}


def test_columns_of_one_side_are_one_line() -> None:
    assert columns_text(("a", "b"), "new") == ["new: a, b"]
    assert columns_text((), "new") == []


def test_tolerances_come_from_a_file(tmp_path: Path) -> None:
    (tmp_path / "tolerances.yaml").write_text(
        "platform.*: 1.0e-6\n# a comment\nmemory.mode_ticks: 2\ndriver.*: ignore\n"
    )
    found = read_tolerances(str(tmp_path / "tolerances.yaml"))
    assert found == {"platform.*": 1e-6, "memory.mode_ticks": 2.0, "driver.*": math.inf}
    assert list(found) == ["platform.*", "memory.mode_ticks", "driver.*"], "the last match counts"
    assert read_tolerances(None) == {}


@pytest.mark.parametrize("text", ["a: -1", "a: much", "- a", "a: .inf", "a: [1]"])
def test_a_file_that_holds_no_tolerances_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "tolerances.yaml"
    path.write_text(text)
    with pytest.raises(ProfileError) as caught:
        read_tolerances(str(path))
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match=r"tolerances profile: value .*: a file that exists"):
        read_tolerances(str(tmp_path / "gone.yaml"))
