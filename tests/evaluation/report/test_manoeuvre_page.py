"""The report of test manoeuvres as one file."""

from pathlib import Path

import pytest

from simconsole.evaluation.manoeuvres.attempt import Result
from simconsole.evaluation.report.manoeuvre_page import Chapter, write_handling_report
from simconsole.profiles.manoeuvre import Limit
from simconsole.values.errors import RecordingError

LIMITS = (Limit(value="roll_deg", max=5.0), Limit(value="share", min=0.9), Limit(value="gain", min=1.0, max=2.0))
RESULT = Result({"roll_deg": 4.25, "share": 0.95, "gain": 1.5, "free_m": 12345.678}, ())


def written(path: Path, *chapters: Chapter) -> str:
    write_handling_report(path, chapters)
    return path.read_text(encoding="utf-8")


def test_each_value_stands_beside_its_limits(tmp_path: Path) -> None:
    text = written(tmp_path / "r.html", Chapter("circle", "Circle", RESULT, LIMITS, ()))
    for name, value, limits in (
        ("roll_deg", "4.25", "at most 5"),
        ("share", "0.95", "at least 0.9"),
        ("gain", "1.5", "1 to 2"),
        ("free_m", "1.235e+04", ""),
    ):
        assert f"<tr><td>{name}</td><td class=n>{value}</td><td class=n>{limits}</td></tr>" in text
    assert "circle: inside its limits" in text
    assert "<svg" not in text, "a manoeuvre without plots has none"


def test_a_chapter_with_a_problem_says_so_and_the_next_one_does_not(tmp_path: Path) -> None:
    bad = Chapter("sine", "Sine <dwell>", RESULT, (), ("ratio: 0.4 not in -inf to 0.35 & more",))
    text = written(tmp_path / "r.html", bad, Chapter("circle", "Circle", RESULT, (), ()))
    assert "sine: NOT inside its limits</p><p>ratio: 0.4 not in -inf to 0.35 &amp; more</p>" in text
    assert "<h2>Sine &lt;dwell&gt;</h2>" in text
    assert "circle: inside its limits</p>\n" in text


def test_a_file_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"none/r\.html: cannot be written: No such file or directory$"):
        write_handling_report(tmp_path / "none" / "r.html", [])
