import pytest

from simconsole.hud.draw import Box
from simconsole.hud.layout import check_screen
from simconsole.hud.screen import Screen, fit, fit_span, screen_of, window_size
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


@pytest.mark.parametrize(
    ("display", "size"), [((1366, 768), (942, 706)), ((1000, 2000), (1000, 750)), ((9000, 9000), (1400, 1050))]
)
def test_a_window_is_never_larger_than_its_display_less_a_title_bar(
    display: tuple[int, int], size: tuple[int, int]
) -> None:
    assert window_size(SCREEN, display) == size


@pytest.mark.parametrize("has_view", [False, True])
@pytest.mark.parametrize(
    "size", [(1366, 768), (1366, 706), (1280, 800), (1920, 1080), (3440, 1440), (640, 480), (400, 900), (2000, 300)]
)
def test_a_window_of_any_shape_has_a_legible_picture_in_its_middle(size: tuple[int, int], has_view: bool) -> None:
    fitted = fit(SCREEN._replace(has_view=has_view), *size)
    screen = fitted.screen
    check_screen(screen, "hud")
    assert not screen.is_triple
    assert abs(2 * fitted.left_px + screen.width_px - size[0]) <= 1
    assert abs(2 * fitted.top_px + screen.height_px - size[1]) <= 1
    assert screen.width_px == size[0] or screen.height_px == size[1]
    share = min(screen.width_px / SCREEN.width_px, screen.height_px / SCREEN.height_px)
    assert screen.px_per_arcmin == pytest.approx(share * SCREEN.px_per_arcmin)


def test_the_seams_of_three_screens_stay_where_they_are() -> None:
    fitted = fit(SCREENS["triple"], 1920, 1080)
    assert (fitted.screen.width_px, fitted.screen.height_px, fitted.top_px) == (1920, 480, 300)
    assert fitted.screen.is_triple
    assert fitted.has_bars
    assert not fit(SCREEN, 1400, 1050).has_bars


def test_of_several_displays_one_has_the_picture() -> None:
    displays = {0: Box(1280, 0, 1400, 1050), 1: Box(0, 0, 1280, 1024), 2: Box(2680, 0, 1280, 1024)}
    fitted = fit_span(SCREENS["4:3"], displays, 0)
    assert (fitted.window_width_px, fitted.window_height_px) == (3960, 1050)
    assert (fitted.left_px, fitted.top_px) == (1280, 0)
    assert fitted.screen == SCREENS["4:3"]
    assert fitted.front() == Box(1280, 0, 1400, 1050)
    assert fitted.display == 0
    assert fitted.others == ((1, displays[1]), (2, displays[2]))
    assert fitted.has_bars


def test_the_middle_of_three_screens_is_before_the_driver() -> None:
    assert fit(SCREENS["triple"], 4200, 1200).front() == Box(1400, 75, 1400, 1050)
    assert fit(SCREENS["4:3"], 1400, 1050).front() == Box(0, 0, 1400, 1050)
