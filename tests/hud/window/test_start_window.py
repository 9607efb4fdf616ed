"""The page before a drive in a real window: keys choose, Return drives, Escape and closing leave."""

import threading
from collections.abc import Iterator

import pygame
import pytest

from simconsole.hud.start_page import Offer, StartPage, opened
from simconsole.hud.window.start_window import choose, has_display
from simconsole.profiles.view import HudProfile
from tests.hud.window.x_server import hands, x_server
from tests.patience import wait_until

PAGE = opened((Offer("wheel", "not connected", possible=False), Offer("keyboard")), (Offer("here"), Offer("there")))


@pytest.fixture(scope="module")
def server() -> Iterator[str]:
    with x_server() as name:
        yield name


@pytest.fixture
def display(server: str, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
    monkeypatch.setenv("DISPLAY", server)
    return server


def has_keyboard() -> bool:
    return pygame.display.get_init() and pygame.key.get_focused()


def pressed(display: str, *keys: str) -> StartPage | None:
    """Choose with these keys pressed as soon as the window has the keyboard."""

    def press() -> None:
        hands(display, "search", "--sync", "--onlyvisible", "--class", ".", "windowfocus", "--sync")
        wait_until(has_keyboard, "the window knows that it has the keyboard")
        hands(display, "key", "--delay", "60", *keys)

    person = threading.Thread(target=press)
    person.start()
    try:
        return choose(PAGE, HudProfile())
    finally:
        person.join(20.0)
        assert not pygame.display.get_init()


def test_keys_choose_and_return_drives(display: str) -> None:
    page = pressed(display, "Down", "Right", "Down", "Return")
    assert page is not None
    assert (page.cockpit, page.place) == (1, 1)


def test_escape_leaves(display: str) -> None:
    assert pressed(display, "Escape") is None


@pytest.mark.parametrize(
    ("found", "seen"),
    [
        ({}, False),
        ({"DISPLAY": ":0"}, True),
        ({"WAYLAND_DISPLAY": "w"}, True),
        ({"DISPLAY": ":0", "SDL_VIDEODRIVER": "dummy"}, False),
    ],
)
def test_a_display_is_where_somebody_sees_it(
    found: dict[str, str], seen: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)
    for name, value in found.items():
        monkeypatch.setenv(name, value)
    assert has_display() == seen
