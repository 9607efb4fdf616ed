"""A display that is named is the one that is opened: never another that nobody sees."""

import os
from collections.abc import Callable, Iterator

import pygame
import pytest

from simconsole.hud.driver_view.scene import view_scene
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.hud.gl.view_window import open_window
from simconsole.hud.start_page import Offer, opened
from simconsole.hud.view import HudSettings
from simconsole.hud.window.sdl_display import choose_display, has_display, start_display
from simconsole.hud.window.start_window import choose
from simconsole.profiles.view import DriverViewProfile, HudProfile
from simconsole.values.errors import WorkerError
from tests.hud.window.x_server import x_server

NOBODY = {"DISPLAY": ":59999"}
PROFILE = HudProfile(view=DriverViewProfile())
SCENE = view_scene(None, (), Size(3.99, 1.75, 1.45, 0.75, 2.5))
Desktop = Callable[[dict[str, str]], None]


@pytest.fixture
def desktop(monkeypatch: pytest.MonkeyPatch) -> Iterator[Desktop]:
    """Return what sets the variables by which programs find their desktop; close what is opened there."""
    pygame.display.quit()

    def become(found: dict[str, str]) -> None:
        for name in ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR", "SDL_VIDEODRIVER"):
            monkeypatch.delenv(name, raising=False)
        for name, value in found.items():
            monkeypatch.setenv(name, value)

    monkeypatch.delenv("SDL_FRAMEBUFFER_ACCELERATION", raising=False)
    yield become
    pygame.display.quit()


def test_no_window_that_nobody_sees_takes_the_place_of_one_on_a_display_that_does_not_answer(
    desktop: Desktop, capsys: pytest.CaptureFixture[str]
) -> None:
    desktop(NOBODY)
    for scene in (None, SCENE):
        with pytest.raises(WorkerError, match="hud: no window can be opened: display :59999 does not answer"):
            open_window(PROFILE, HudSettings(), scene=scene)
    assert "driver's view: no OpenGL window can be opened: display :59999" in capsys.readouterr().err
    assert not pygame.display.get_init()


def test_no_page_waits_for_a_choice_on_a_display_that_does_not_answer(desktop: Desktop) -> None:
    desktop(NOBODY)
    with pytest.raises(WorkerError, match="start page: no window can be opened: display :59999 does not answer"):
        choose(opened([Offer("keys")], [Offer("here")], ""), HudProfile())


def test_a_display_that_answers_is_the_one_that_is_used(desktop: Desktop) -> None:
    with x_server() as name:
        desktop({"DISPLAY": name})
        start_display()
        assert pygame.display.get_driver() == "x11"
        pygame.display.quit()


def test_a_window_in_memory_that_the_user_asks_for_is_no_failure(desktop: Desktop) -> None:
    desktop({"SDL_VIDEODRIVER": "offscreen", **NOBODY})
    start_display()
    assert pygame.display.get_driver() == "offscreen"


@pytest.mark.parametrize("found", [{"SDL_VIDEODRIVER": "x11"}, {"DISPLAY": ":0"}, {"XDG_RUNTIME_DIR": "/run/user/1"}])
def test_a_desktop_or_a_driver_that_the_user_names_is_left_to_sdl(found: dict[str, str], desktop: Desktop) -> None:
    desktop(found)
    choose_display()
    assert os.environ.get("SDL_VIDEODRIVER") == found.get("SDL_VIDEODRIVER")


@pytest.mark.parametrize(
    ("found", "seen"),
    [
        ({}, False),
        ({"DISPLAY": ":0"}, True),
        ({"WAYLAND_DISPLAY": "w"}, True),
        ({"DISPLAY": ":0", "SDL_VIDEODRIVER": "dummy"}, False),
    ],
)
def test_a_display_is_where_somebody_sees_it(found: dict[str, str], seen: bool, desktop: Desktop) -> None:
    desktop(found)
    assert has_display() == seen
