from itertools import pairwise

import pytest

from simconsole.hud.draw import WARNING_LINE, Polygon, bounds
from simconsole.hud.layout import layout, places
from simconsole.values.signals import Mode
from tests.hud.pictures import SCREEN, by_role, colours, in_mode


def test_the_needle_follows_the_engine_over_the_whole_dial() -> None:
    tops = []
    for rpm in (0.0, 3500.0, 7000.0, 9000.0):
        (needle,) = by_role(layout(in_mode(Mode.MANUAL, rpm=rpm), SCREEN), "dial.needle")
        assert isinstance(needle, Polygon)
        tops.append(bounds(needle).cx)
    dial = places(SCREEN).dial
    assert tops[0] < dial.cx - 100
    assert tops[1] == pytest.approx(dial.cx, abs=1.0)
    assert tops[2] > dial.cx + 100
    assert tops[3] == tops[2]


def test_the_red_zone_asks_for_a_shift_in_words_and_shape() -> None:
    items = layout(in_mode(Mode.MANUAL, rpm=6200.0, gear="2"), SCREEN)
    assert by_role(items, "shift")
    assert by_role(items, "shift.arrow")
    assert colours(items, "dial.needle") == {WARNING_LINE}
    assert not by_role(layout(in_mode(Mode.MANUAL, rpm=5900.0), SCREEN), "shift")
    assert not by_role(layout(in_mode(Mode.AUTONOMOUS, rpm=6200.0, automatic=True), SCREEN), "shift")


@pytest.mark.parametrize(
    ("shown", "lit"),
    [
        ({"turn_indicators": 1.0}, {"indicator.left"}),
        ({"turn_indicators": -1.0}, {"indicator.right"}),
        ({"hazard_lights": 1.0}, {"indicator.left", "indicator.right"}),
        ({"turn_indicators": 1.0, "hazard_lights": 1.0}, {"indicator.left", "indicator.right"}),
        ({}, set()),
        ({"turn_indicators": 1.0, "stale": True}, set()),
    ],
)
def test_indicators_flash_ninety_times_a_minute_on_their_side(shown: dict[str, float], lit: set[str]) -> None:
    frames = []
    for tick in range(200):
        items = layout(in_mode(Mode.MANUAL, t_s=0.03125 * tick, **shown), SCREEN)
        frames.append({item.role for item in items if item.role.startswith("indicator")})
        for item in by_role(items, "indicator.left"):
            assert bounds(item).right < SCREEN.width_px / 2.0
    assert {frozenset(frame) for frame in frames} == {frozenset(), frozenset(lit)}
    assert sum(before == set() and now != set() for before, now in pairwise(frames)) == (9 if lit else 0)
