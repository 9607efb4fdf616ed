"""The cockpit as text: bars that never leave their brackets, and always as many lines."""

import math

import pytest

from simconsole.devices.calibration.cockpit_settings import NOBODY
from simconsole.devices.calibration.cockpit_text import WIDTH, bar, cockpit_lines, needle
from simconsole.values.signals import Button, Validity


@pytest.mark.parametrize(("share", "full"), [(-3.0, 0), (0.0, 0), (0.5, 5), (0.96, 10), (1.0, 10), (9.0, 10)])
def test_bar_is_filled_from_the_left(share: float, full: int) -> None:
    assert bar(share, 10) == f"[{'#' * full}{'.' * (10 - full)}]"


def test_needle_stands_left_for_left_and_keeps_inside() -> None:
    assert needle(1.0, 5) == "[#.|..]"
    assert needle(0.0, 5) == "[..#..]"
    assert needle(-1.0, 5) == "[..|.#]"
    assert needle(7.0, 5) == needle(1.0, 5)
    assert all(len(needle(share / 50.0)) == WIDTH + 2 for share in range(-60, 60))


def test_person_is_told_in_words() -> None:
    driver = NOBODY._replace(
        hand_wheel_rad=math.radians(-90.0), wheel_validity=float(Validity.LIVE), brake=0.25, gear=3.0,
        pressed=float(Button.AUTONOMOUS | Button.MARK),
    )  # fmt: skip
    lines = cockpit_lines(driver, math.radians(540.0))
    assert "-90.0 deg  live" in lines[0]
    assert "25%" in lines[2]
    assert lines[2].endswith("unknown")
    assert lines[5].startswith("gear 3  ")
    assert lines[5].endswith("held: autonomous mark")


@pytest.mark.parametrize(("gear", "word"), [(-1.0, "R"), (0.0, "N"), (7.0, "7")])
def test_lines_are_as_many_whatever_is_shown(gear: float, word: str) -> None:
    lines = cockpit_lines(NOBODY._replace(gear=gear), 9.0)
    assert len(lines) == 6
    assert lines[5] == f"gear {word}  unknown  held: -"
