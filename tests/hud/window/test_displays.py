import pygame
import pytest

from simconsole.hud.draw import Box
from simconsole.hud.window.displays import display_places, named_displays, span_of
from simconsole.profiles.view import DriverViewProfile, ViewScreen
from simconsole.values.errors import WorkerError


def test_a_window_spans_displays_wherever_they_stand() -> None:
    places = {0: Box(1280, 100, 1920, 1080), 1: Box(0, 0, 1280, 1024), 3: Box(3200, 100, 1280, 1024)}
    span = span_of(places)
    assert span[:4] == (0, 0, 4480, 1180)
    assert span.displays == places
    beside = span_of({0: places[0], 3: places[3]})
    assert beside[:4] == (1280, 100, 3200, 1080)
    assert beside.displays == {0: Box(0, 0, 1920, 1080), 3: Box(1920, 0, 1280, 1024)}


def test_a_display_is_asked_for_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """SDL's dummy display has its own corner at 0, 0; nobody sees a window."""
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pygame.display.init()
    try:
        (size,) = pygame.display.get_desktop_sizes()
        assert display_places([0]) == {0: Box(0, 0, *size)}
        with pytest.raises(WorkerError, match="value 1: connected are 0 to 0"):
            display_places([0, 1])
    finally:
        pygame.display.quit()


def test_only_displays_that_are_named_count() -> None:
    assert named_displays(DriverViewProfile()) == set()
    screens = (ViewScreen(display=2), ViewScreen(), ViewScreen(display=0))
    assert named_displays(DriverViewProfile(screens=screens)) == {0, 2}
