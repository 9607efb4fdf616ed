"""`simconsole autopilot`: what a user can do wrong."""

from tests.drives.console import complaint, simconsole


def test_autopilot_against_nobody_is_one_line() -> None:
    line = complaint(simconsole("autopilot", "--url", "ws://127.0.0.1:9", "--wait", 0.1))
    assert "ws://127.0.0.1:9: cannot connect: " in line


def test_autopilot_on_an_unknown_course_is_one_line() -> None:
    line = complaint(simconsole("autopilot", "--url", "ws://127.0.0.1:9", "--course", "moon"))
    assert "worlds profile: value 'moon'" in line
