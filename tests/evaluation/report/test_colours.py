"""Colours that must be told apart on one page."""

from simconsole.evaluation.report.colours import END, LIMIT, MODES, NOTE, PERSON, REMOTE, START, THEORY
from simconsole.values.signals import Mode


def apart(one: str, other: str) -> int:
    """Return by how much the most different of red, green and blue differ, of 255."""
    return max(abs(int(one[at : at + 2], 16) - int(other[at : at + 2], 16)) for at in (1, 3, 5))


def test_every_mode_has_a_colour_and_no_two_look_alike() -> None:
    assert set(MODES) == set(Mode)
    modes = list(MODES.values())
    assert min(apart(one, other) for at, one in enumerate(modes) for other in modes[:at]) >= 32


def test_what_lies_on_the_map_together_is_told_apart() -> None:
    shown = [THEORY, PERSON, REMOTE, START, END]
    assert min(apart(one, other) for at, one in enumerate(shown) for other in shown[:at]) >= 32
    assert all(apart(colour, "#ffffff") >= 16 for colour in (*shown, LIMIT, NOTE)), "on white paper"
