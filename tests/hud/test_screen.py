import pytest

from simconsole.hud.screen import Screen, screen_of
from simconsole.profiles.view import HudProfile
from tests.hud.pictures import SCREEN, SCREENS


def test_pixels_per_degree_are_those_of_the_reference_seat() -> None:
    # 1400 px on 1.6 m at 2.2 m are 34 px per degree.
    assert SCREEN.px_per_arcmin * 60.0 == pytest.approx(34.0, abs=0.5)


def test_border_is_empty_on_every_side() -> None:
    safe = SCREENS["16:9"].safe()
    assert (safe.x, safe.y) == (96, 54)
    assert (safe.right, safe.bottom) == (1920 - 96, 1080 - 54)
    assert SCREENS["16:9"].panels() == (safe,)
    odd = Screen(1001, 999, 1.6, 2.0).safe()
    assert odd.x >= 0.05 * 1001
    assert odd.bottom <= 0.95 * 999 + 1e-9


def test_one_wide_picture_is_three_screens_each_with_its_border() -> None:
    screen = SCREENS["triple"]
    assert screen.is_triple
    panels = screen.panels()
    assert len(panels) == 3
    for number, panel in enumerate(panels):
        assert panel.x >= 1400 * number + 70 - 1e-9
        assert panel.right <= 1400 * (number + 1) - 70 + 1e-9
    assert screen.content() == panels[1]


def test_a_wide_single_screen_is_not_three() -> None:
    assert not Screen(2400, 1000, 2.0, 2.0).is_triple
    assert Screen(2401, 1000, 2.0, 2.0).is_triple


def test_nearer_eyes_need_fewer_pixels() -> None:
    assert Screen(1400, 1050, 1.6, 1.1).px_per_arcmin == pytest.approx(0.5 * SCREEN.px_per_arcmin)
    assert screen_of(HudProfile(width_px=800, height_px=600)).width_px == 800
