import subprocess
import sys
from itertools import combinations
from typing import NamedTuple

import pytest

from simconsole.hud.draw import DANGER, WARNING_LINE, DrawItem, bounds, luminance
from simconsole.hud.guidance import Ahead
from simconsole.hud.layout import check_screen, layout, places, sample_views
from simconsole.hud.screen import Screen
from simconsole.hud.view import HudView
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Mode
from tests.hud.pictures import GERMAN, LARGE, SCREEN, SCREENS, asked, by_role, in_mode, shape_of, texts

every_screen = pytest.mark.parametrize("screen", [*SCREENS.values(), *LARGE.values()], ids=[*SCREENS, *LARGE])


class Drawn(NamedTuple):
    """A screen, and what is drawn on it of every sample view, in both languages."""

    screen: Screen
    pictures: list[list[DrawItem]]


@pytest.fixture(scope="module", params=[*SCREENS.values(), *LARGE.values()], ids=[*SCREENS, *LARGE])
def drawn(request: pytest.FixtureRequest) -> Drawn:
    """One screen after the other: all at once are 160 MB."""
    screen = request.param
    return Drawn(screen, [list(layout(view, screen)) for view in [*sample_views(), *sample_views(GERMAN)]])


def test_nothing_is_within_five_percent_of_the_border(drawn: Drawn) -> None:
    screen = drawn.screen
    for items in drawn.pictures:
        for item in items:
            box = bounds(item)
            if item.role == "ground":
                continue
            assert box.x >= 0.05 * screen.width_px, item
            assert box.right <= 0.95 * screen.width_px, item
            assert box.y >= 0.05 * screen.height_px, item
            assert box.bottom <= 0.95 * screen.height_px, item


def test_every_text_is_large_enough_for_the_seat(drawn: Drawn) -> None:
    screen = drawn.screen
    check_screen(screen, "hud", GERMAN)
    for items in drawn.pictures:
        for item in texts(items):
            assert item.arcmin in (16.0, 20.0, 60.0)
            assert item.cap_px / screen.px_per_arcmin >= item.arcmin
            if item.role == "speed" and item.text.isdigit():
                assert item.arcmin == 60.0
            if (
                item.role.startswith(("mode", "reason", "alert", "gear", "turn", "link.label"))
                and "automatic" not in item.role
            ):
                assert item.arcmin >= 20.0


def test_no_two_texts_touch(drawn: Drawn) -> None:
    for items in drawn.pictures:
        placed = [(*bounds(item), item) for item in texts(items)]
        for (x, y, w, h, one), (other_x, other_y, other_w, other_h, other) in combinations(placed, 2):
            beside = x + w <= other_x or other_x + other_w <= x
            assert beside or y + h <= other_y or other_y + other_h <= y, (one, other)


def test_a_seat_too_far_away_fails_at_start_up() -> None:
    with pytest.raises(ProfileError, match=r"bench\.yaml: screen_width_m 1.6 at eye_distance_m 6 .*arc minutes"):
        check_screen(Screen(1400, 1050, 1.6, 6.0), "bench.yaml")


def test_the_cluster_stands_on_the_middle_screen() -> None:
    screen = SCREENS["triple"]
    for item in layout(in_mode(Mode.MANUAL), screen):
        box = bounds(item)
        assert item.role == "ground" or (box.x >= 1400 and box.right <= 2800)


@pytest.mark.parametrize("mode", [Mode.PARKED, Mode.MANUAL, Mode.SHARED, Mode.AUTONOMOUS, Mode.STOPPED])
def test_nothing_else_flashes(mode: Mode) -> None:
    pictures = set()
    for hundredth in range(100):
        items = layout(in_mode(mode, t_s=10.0 + 0.0099 * hundredth), SCREEN)
        pictures.add(tuple(items))
    assert len(pictures) == 1


def test_stale_data_shows_no_data_and_no_number_of_the_drive() -> None:
    shown = HudView(
        shown_kmh=37, rpm=3210.0, gear="2", throttle=0.42, distance_m=1234.0, t_s=65.0, link_age_s=0.02,
        hand_wheel_deg=90.0, mode=float(Mode.MANUAL), mode_label="MANUAL", wheel_validity=2.0, engine_running=True,
    )  # fmt: skip
    items = layout(shown._replace(stale=True), SCREEN)
    words = [item.text for item in texts(items) if item.role != "dial.number"]
    assert words.count("NO DATA") == 2
    assert "MANUAL" not in words
    assert not [text for text in words if any(c.isdigit() for c in text) and text != "x1000 rpm"]
    assert not by_role(items, "dial.needle")
    assert not by_role(items, "dial.band")
    assert "37" in [item.text for item in texts(layout(shown, SCREEN))]


def test_no_text_is_empty_or_pure_blue_or_red() -> None:
    for view in (HudView(), *sample_views()):
        for item in texts(layout(view, SCREEN)):
            assert item.text, item.role
            r, g, b = item.colour
            assert not (b > 128 and r < 64 and g < 64)
            assert item.colour is not WARNING_LINE
    assert luminance(DANGER) < 0.1


@every_screen
def test_panels_do_not_overlap(screen: Screen) -> None:
    for one, other in combinations([place for place in places(screen) if place is not None], 2):
        apart = one.right <= other.x or other.right <= one.x or one.bottom <= other.y or other.bottom <= one.y
        assert apart


@every_screen
@pytest.mark.parametrize("has_view", [False, True])
def test_large_text_is_a_quarter_larger(screen: Screen, has_view: bool) -> None:
    plain, large = screen._replace(has_view=has_view, text=1.0), screen._replace(has_view=has_view, text=1.25)
    for view in sample_views(GERMAN):
        for item in texts(layout(view, large)):
            assert item.cap_px >= 1.25 * item.arcmin * plain.px_per_arcmin - 1e-9, item


def test_large_text_keeps_what_a_driver_must_see() -> None:
    shown = in_mode(
        Mode.SHARED, shown_kmh=47, limit_kmh=50, gear="3", rpm=2300.0, remote_lateral=0.5, other_side="AUTOPILOT",
        ahead=Ahead(350.0, 1.5), link_age_s=0.02, can_up=False, link="lost",
    )  # fmt: skip
    for screen in (LARGE["4:3"], LARGE["4:3"]._replace(has_view=True)):
        words = {item.text for item in texts(layout(shown, screen))}
        assert {"47", "50", "3", "SHARED", "50 %", "350 m", "CAN", "down", "LINK", "lost"} <= words


def test_nothing_differs_in_colour_alone() -> None:
    """Two views that look different differ in words or shapes."""
    for screen in (SCREEN, SCREEN._replace(has_view=True)):
        drawn: dict[tuple[object, ...], set[tuple[DrawItem, ...]]] = {}
        for view in sample_views():
            items = tuple(item for item in layout(view, screen))
            drawn.setdefault(tuple(shape_of(item) for item in items), set()).add(items)
        assert [len(same) for same in drawn.values()] == [1] * len(drawn)


def test_layout_is_pure() -> None:
    view = asked(2, t_s=1.0)
    assert layout(view, SCREEN) == layout(view, SCREEN)


def test_the_core_loads_no_graphics_library() -> None:
    program = (
        "import sys; import simconsole.hud.layout, simconsole.hud.view; "
        "import simconsole.values.labels, simconsole.values.key_codes; "
        "sys.exit(any(m in sys.modules for m in ('pygame', 'rerun', 'numba', 'matplotlib')))"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
