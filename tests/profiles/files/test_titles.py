"""Names and titles of what is shipped."""

from simconsole.profiles.files.titles import listed, shipped


def test_every_row_has_name_and_title_and_worlds_their_kind() -> None:
    rows = {row["name"]: row for row in listed("worlds")}
    assert list(rows) == shipped("worlds")
    assert rows["urban_signals"] == {
        "name": "urban_signals",
        "title": "Urban course with signals, 2.6 km",
        "kind": "roads",
    }
    assert "kind" not in listed("vehicles")[0]


def test_a_plan_of_a_course_is_no_world() -> None:
    assert not [name for name in shipped("worlds") if name.endswith(".plan")]
