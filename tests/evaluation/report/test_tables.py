"""Tables of a report: their words are escaped, and each figure is written for people."""

from typing import Any

from simconsole.evaluation.report.tables import (
    changes_table,
    facts_table,
    faults_table,
    own_table,
    rules_table,
    table,
    wheel_table,
)


def test_words_are_escaped_and_numbers_are_on_the_right() -> None:
    assert table(("a&b", "n"), [("<x>", "1")]) == (
        "<table><tr><th>a&amp;b</th><th class=n>n</th></tr>\n<tr><td>&lt;x&gt;</td><td class=n>1</td></tr>\n</table>"
    )
    assert facts_table({"a&b": "<x>"}) == "<table>\n<tr><th>a&amp;b</th><td>&lt;x&gt;</td></tr>\n</table>"


def test_a_refusal_is_a_mode_that_stays() -> None:
    change: dict[str, Any] = {"mode": "MANUAL", "reason": "brake", "t_s": 4.0, "distance_m": 23.04, "tick": 200}
    found = changes_table({"mode_changes": [{**change, "refused": True}, {**change, "refused": False}]})
    row = "<td>brake</td><td class=n>4.00 s</td><td class=n>23.0 m</td><td class=n>200</td></tr>"
    assert f"<tr><td>stays MANUAL</td>{row}\n<tr><td>MANUAL</td>{row}" in found


def test_a_broken_rule_names_the_limit_where_there_is_one() -> None:
    event = {"rule": "speeding", "first_s": 1.0, "last_s": 2.5, "distance_m": 9.996, "top_speed_kmh": 57.46}
    found = rules_table({"rules": [{**event, "limit_kmh": 50.0}, {**event, "rule": "off_road", "limit_kmh": None}]})
    assert "<td class=n>10.0 m</td><td class=n>57.5 km/h</td><td class=n>50 km/h</td>" in found
    assert "<td class=n>57.5 km/h</td><td class=n>-</td>" in found


def test_faults_and_figures_of_other_packages_are_listed_by_their_names() -> None:
    fault = {"fault": "raw 1", "first_s": 1.0004, "last_s": 2.0}
    assert "<td>raw 1</td><td class=n>1.000 s</td><td class=n>2.000 s</td>" in faults_table({"faults": [fault]})
    found = own_table({"quick": {"standing_s": 2.0, "accel_mps2": None}})
    assert "<td>quick</td><td>standing_s</td><td class=n>2</td>" in found
    assert "<td>quick</td><td>accel_mps2</td><td class=n>-</td>" in found


def test_a_wheel_that_was_never_eased_has_one_line() -> None:
    wheel = {"least_share": 0.755, "least_at_kmh": 98.6, "eased_from_s": None, "eased_s": 0.0}
    assert wheel_table(wheel).count("<tr>") == 1
    assert "76 % at 99 km/h" in wheel_table(wheel)
    assert "1.5 s, from 12.25 s" in wheel_table({**wheel, "eased_from_s": 12.25, "eased_s": 1.5})
