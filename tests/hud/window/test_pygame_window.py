import os
import subprocess
import sys

import numpy as np
import pygame
import pytest

from simconsole.hud.draw import DrawItem
from simconsole.hud.view import HudSettings
from simconsole.hud.window.pygame_window import Window
from simconsole.profiles.view import HudProfile
from simconsole.values.errors import ProfileError
from simconsole.values.state_vector import PLATFORM_AT, Snapshot

pytestmark = pytest.mark.usefixtures("dummy_display")

PROFILE = HudProfile(width_px=700, height_px=525, screen_width_m=1.6, eye_distance_m=1.1, rate_hz=240)


def snapshot(tick: int) -> Snapshot:
    return Snapshot(tick, 250, np.zeros(PLATFORM_AT))


def picture(opened: Window) -> bytes:
    return pygame.image.tobytes(opened._surface, "RGB")


def test_an_open_window_has_its_fonts() -> None:
    """Loading them takes so long that a keyboard told of before would be lost meanwhile."""
    opened = Window(PROFILE, HudSettings())
    loaded = set(opened._painter._fonts)
    opened.frame(snapshot(1), 1.0)
    assert set(opened._painter._fonts) == loaded != set()


def test_a_ring_that_freezes_shows_no_data_and_recovers() -> None:
    opened = Window(PROFILE, HudSettings())
    opened.frame(None, 0.0)
    nothing = picture(opened)
    opened.frame(snapshot(1), 1.0)
    fresh = picture(opened)
    opened.frame(snapshot(1), 1.4)
    assert picture(opened) == fresh
    opened.frame(snapshot(1), 1.6)
    assert picture(opened) == nothing != fresh
    opened.frame(snapshot(2), 1.7)
    assert picture(opened) == fresh


def test_an_equal_picture_is_not_drawn_again(monkeypatch: pytest.MonkeyPatch) -> None:
    opened = Window(PROFILE, HudSettings())
    opened.frame(snapshot(1), 1.0)
    painted: list[int] = []

    def repaint(surface: pygame.Surface, before: list[DrawItem], after: list[DrawItem]) -> list[pygame.Rect]:
        painted.append(len(after))
        return []

    monkeypatch.setattr(pygame.display, "update", lambda areas: None)
    monkeypatch.setattr(opened._painter, "repaint", repaint)
    opened.frame(snapshot(2), 1.1)
    assert painted == []
    opened.frame(None, 1.2)
    assert len(painted) == 1


DESKTOP = ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR")


def test_without_a_desktop_it_draws_into_memory_and_says_nothing() -> None:
    program = (
        "import pygame; from simconsole.hud.window.pygame_window import Window; "
        "from simconsole.hud.view import HudSettings; "
        "from simconsole.profiles.view import HudProfile; Window(HudProfile(), HudSettings()); "
        "assert pygame.display.get_driver() == 'dummy'"
    )
    kept = {name: value for name, value in os.environ.items() if name not in (*DESKTOP, "SDL_VIDEODRIVER")}
    environment = {**kept, "PYGAME_HIDE_SUPPORT_PROMPT": "1", "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_an_illegible_seat_opens_no_window() -> None:
    with pytest.raises(ProfileError, match="eye_distance_m 9"):
        Window(HudProfile(eye_distance_m=9.0), HudSettings())
    assert not pygame.display.get_init()
