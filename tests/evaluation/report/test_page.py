import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.report.metric_rows import METRICS
from simconsole.evaluation.report.page import page, write_report
from simconsole.values.errors import RecordingError
from simconsole.values.signals import Button, Event
from simconsole.world.course import Course


class Outside(HTMLParser):
    """Collects everything a page would have to fetch, and its elements."""

    def __init__(self) -> None:
        super().__init__()
        self.fetched: list[str] = []
        self.elements: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append(tag)
        for key, value in attrs:
            if key in ("src", "href", "xlink:href", "data") and value and not value.startswith("#"):
                self.fetched.append(value)


def written(path: Path, known: Any, course: Course | None, title: str, *more: Any, **options: Any) -> dict[str, Any]:
    return write_report(path, drive_of(*known), course, title, *more, **options)


def test_latency_of_each_hop_stands_in_the_page_only(tmp_path: Path, known: Any) -> None:
    hops = {"read": {"p50": 35.5, "p99": 56.25, "max": 113.0, "count": 1000}}
    found = written(tmp_path / "r.html", known, None, "title", latency_us=hops)
    row = "<tr><td>read</td><td class=n>35.5</td><td class=n>56.2</td><td class=n>113</td><td class=n>1000</td></tr>"
    assert row in (tmp_path / "r.html").read_text("utf-8")
    assert "latency_us" not in found


def test_speed_advice_is_told_where_it_was_given(known: Any, course: Course) -> None:
    found = metrics(drive_of(*known), course)
    assert "Speed advice" not in page("title", found, ("", ""), {}, {})
    followed = {"lights": 3, "stops": 0.0, "waiting_s": 0.0, "time_loss_s": 4.25, "energy_jpkg": 12.0}
    others = {"lights": 1, "stops": 1.0, "waiting_s": 12.5, "time_loss_s": None, "energy_jpkg": 100.0}
    advice = {"lights": 4, "advised": 3, "compliance": 0.914, "followed": followed, "not_followed": others}
    text = page("title", {**found, "speed_advice": advice}, ("", ""), {}, {})
    assert "Advised before 3 of 4 lights; driven as advised: 91 % of the time." in text
    assert "<tr><th>Waiting</th><td class=n>0 s</td><td class=n>12.5 s</td></tr>" in text
    assert "<tr><th>Time lost against the limit</th><td class=n>4.25 s</td><td class=n>-</td></tr>" in text


def test_page_is_whole_and_needs_nothing_else(tmp_path: Path, known: Any, course: Course) -> None:
    path = tmp_path / "report.html"
    found = written(path, known, course, "Drive <1> & more", {"Vehicle": "hatchback", "Note": "a < b"})
    text = path.read_text()
    page = Outside()
    page.feed(text)
    assert page.fetched == []
    assert page.elements.count("svg") == 2
    assert "script" not in page.elements
    assert "Drive &lt;1&gt; &amp; more" in text
    assert "a &lt; b" in text
    assert "driver turned the wheel" in text
    assert f"{found['autonomous']['lateral_rms_m'] * 100:.2f} cm" in text
    assert len(text) < 400_000


def test_same_drive_same_bytes(tmp_path: Path, known: Any, course: Course) -> None:
    first, second = tmp_path / "a.html", tmp_path / "b.html"
    assert written(first, known, course, "Drive") == written(second, known, course, "Drive")
    assert first.read_bytes() == second.read_bytes()


def test_drive_without_course_is_reported_too(tmp_path: Path, known: Any) -> None:
    found = written(tmp_path / "ball.html", known, None, "Ball")
    assert found["autonomous"]["lateral_rms_m"] is None
    assert "no course in this world" in (tmp_path / "ball.html").read_text()


def test_unwritable_file_is_one_line(tmp_path: Path, known: Any) -> None:
    with pytest.raises(RecordingError, match="cannot be written") as caught:
        written(tmp_path / "no" / "report.html", known, None, "Drive")
    assert "\n" not in str(caught.value)


def test_importing_the_report_loads_no_matplotlib() -> None:
    code = "import simconsole.evaluation.report.page, sys; raise SystemExit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_take_overs_are_listed(known: Any, course: Course) -> None:
    drive = drive_of(known.vectors, known.columns, known.tick_hz)
    html = page("t", metrics(drive, course), (), {}, {})
    assert "<h2>Take-overs</h2>" in html
    row = html.partition("<h2>Take-overs</h2>")[2].partition("</table>")[0]
    assert "<td>driver turned the wheel</td><td>no</td><td class=n>1251</td>" in row
    assert "first steering, s" in row


def test_every_figure_has_a_name_and_words_and_every_number_a_meaning(
    tmp_path: Path, known: Any, course: Course
) -> None:
    found = written(tmp_path / "r.html", known, course, "t")
    text = (tmp_path / "r.html").read_text("utf-8")
    assert text.count('<svg role="img" aria-label="') == text.count("<svg") == text.count("<figcaption>") == 2
    rms, most = (f"{100.0 * found['autonomous'][key]:.2f} cm" for key in ("lateral_rms_m", "lateral_max_m"))
    assert f"the autopilot was beside the path by {rms} RMS and at most {most}" in text
    table = text.partition("<h2>Metrics</h2>")[2].partition("</table>")[0]
    head, *labels = re.findall(r"<tr><th>([^<]+)</th>", table)
    assert (head, len(labels)) == ("figure", len(METRICS))
    for label in labels:
        assert f"<dt>{label}</dt><dd>" in text


def test_head_says_who_drove_when_and_the_latencies_come_last(tmp_path: Path, known: Any) -> None:
    hops = {"read": {"p50": 1.0, "p99": 2.0, "max": 3.0, "count": 4}}
    facts = {"world": "none", "machine": "a computer", "started": "2026-01-02", "participant": "P<7>"}
    written(tmp_path / "r.html", known, None, "t", facts, latency_us=hops)
    text = (tmp_path / "r.html").read_text("utf-8")
    assert "started 2026-01-02; participant P&lt;7&gt;; machine a computer</p>" in text
    heads = re.findall(r"<h2>(.+?)</h2>", text)
    assert (heads[0], heads[-2:]) == ("Metrics", ["Drive", "Latency"])
    assert "@media print" in text


def test_marks_and_notes_are_listed_in_the_order_of_time(tmp_path: Path, known: Any) -> None:
    plain = page("t", metrics(drive_of(*known), None), (), {}, {})
    assert "Marks and notes" not in plain
    vectors = known.vectors.copy()
    vectors[99, known.columns.index("driver.edges")] = float(Button.MARK | Button.RESET)
    vectors[49, known.columns.index("events.events")] = float(Event.MARK)
    acts = [{"tick": 75, "act": "mark", "note": "a <deer>", "trial": "2"}, {"tick": 80, "act": "reset"}]
    written(tmp_path / "r.html", known._replace(vectors=vectors), None, "t", acts=acts)
    part = (tmp_path / "r.html").read_text("utf-8").partition("<h2>Marks and notes</h2>")[2].partition("</table>")[0]
    rows = re.findall(r"<tr><td>(.*?)</td><td>(.*?)</td><td class=n>(.*?)</td>", part)
    assert rows == [
        ("operator or ROS side", "", "1.00 s"),
        ("operator: mark", "trial 2, a &lt;deer&gt;", "1.50 s"),
        ("driver", "", "2.00 s"),
    ]
