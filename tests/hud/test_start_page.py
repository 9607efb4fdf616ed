"""The page before a drive: choices go over what is not possible, and everything on it can be read."""

import pytest

from simconsole.hud.draw import Polygon, Text, bounds, contrast
from simconsole.hud.screen import Screen, fit
from simconsole.hud.start_page import Act, Offer, StartPage, moved, opened, start_page
from tests.hud.pictures import SCREENS, by_role, texts

COCKPITS = (
    Offer("A wheel", "not connected", possible=False),
    Offer("Keyboard"),
    Offer("B", possible=False),
    Offer("C"),
)
PLACES = (Offer("as in the session"), Offer("a road"), Offer("another road, with a long name " * 4))
PAGE = opened(COCKPITS, PLACES, "the wheel is not connected: " + "nothing is, " * 20)


def after(*acts: Act) -> StartPage:
    page = PAGE
    for act in acts:
        page = moved(page, act)
    return page


def test_the_page_opens_at_what_is_there() -> None:
    assert (PAGE.cockpit, PAGE.place, PAGE.column) == (1, 0, 0)


@pytest.mark.parametrize(
    ("acts", "cockpit", "place"),
    [
        ((Act.DOWN,), 3, 0),
        ((Act.DOWN, Act.DOWN), 3, 0),
        ((Act.UP,), 1, 0),
        ((Act.DOWN, Act.UP), 1, 0),
        ((Act.RIGHT, Act.DOWN), 1, 1),
        ((Act.RIGHT, Act.DOWN, Act.LEFT, Act.DOWN), 3, 1),
        ((Act.RIGHT, Act.UP), 1, 0),
    ],
)
def test_what_is_not_possible_is_passed_over(acts: tuple[Act, ...], cockpit: int, place: int) -> None:
    page = after(*acts)
    assert (page.cockpit, page.place) == (cockpit, place)


@pytest.mark.parametrize("screen", [SCREENS["4:3"], SCREENS["16:9"], fit(SCREENS["4:3"], 640, 480).screen])
def test_everything_is_legible_and_on_the_screen(screen: Screen) -> None:
    items = start_page(PAGE, screen)
    safe = screen.safe()
    for item in texts(items):
        assert item.cap_px >= item.arcmin * screen.px_per_arcmin - 1e-9
        assert contrast(item.colour, (18, 24, 33)) >= 7.0
        box = bounds(item)
        assert safe.x <= box.x
        assert box.right <= safe.right + 0.01
        assert safe.y <= box.y
        assert box.bottom <= safe.bottom + 0.01


def test_the_choice_is_shown_by_a_mark_and_not_by_colour_alone() -> None:
    items = start_page(PAGE, SCREENS["4:3"])
    marks = by_role(items, "chosen.mark")
    assert len(marks) == 2
    lines = {item.text: item.y for item in items if isinstance(item, Text)}
    for mark, label in zip(marks, ("Keyboard", "as in the session"), strict=True):
        assert isinstance(mark, Polygon)
        assert mark.points[1][1] == pytest.approx(lines[label])
