from collections.abc import Iterator
from functools import partial

import numpy as np
import pygame
import pytest
from msgspec.structs import replace

from simconsole.hud.aids import Aids
from simconsole.hud.driver_view.scene import view_scene
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.hud.gl.context import is_software, renderer_name
from simconsole.hud.gl.view_window import ViewWindow, open_window
from simconsole.hud.view import HudSettings
from simconsole.hud.window.habits import Habits
from simconsole.hud.window.ports import Motion, Ports
from simconsole.hud.window.pygame_window import Window
from simconsole.hud.window.window_loop import run
from simconsole.profiles.view import DriverViewProfile, HudProfile, ViewScreen
from simconsole.values.key_codes import Key
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot

PROFILE = HudProfile(width_px=640, height_px=480, rate_hz=240, view=DriverViewProfile())
SCENE = view_scene(None, (), Size(3.99, 1.75, 1.45, 0.75, 2.5))


@pytest.fixture(autouse=True)
def offscreen_display(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """SDL's own window system in memory, with real OpenGL."""
    monkeypatch.setenv("SDL_VIDEODRIVER", "offscreen")
    yield
    pygame.display.quit()


def snapshot(tick: int, x_m: float = 0.0) -> Snapshot:
    vector = np.zeros(PLATFORM_AT)
    vector[LAYOUT.vehicle.start + LAYOUT.vehicle.names.index("x_m")] = x_m
    return Snapshot(tick, 250, vector)


def opened() -> ViewWindow:
    window = open_window(PROFILE, HudSettings(), scene=SCENE)
    assert isinstance(window, ViewWindow)
    return window


def seen(window: ViewWindow) -> bytes:
    return window._context.screen.read(components=3)


def test_a_frame_is_drawn_between_the_two_newest_ticks() -> None:
    window = opened()
    pictures = []
    for age_s in (0.0, 0.002, 0.004):
        window.frame(snapshot(11, 2.0), 1.0, motion=Motion(snapshot(10, 0.0), snapshot(11, 2.0), age_s))
        pictures.append(seen(window))
    assert len(set(pictures)) == 3
    window.frame(snapshot(11, 2.0), 1.0)
    assert seen(window) == pictures[-1]
    window.close()


def test_a_display_that_was_opened_without_opengl_does_not_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process that read joysticks before has SDL's dummy display open."""
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pygame.display.init()
    monkeypatch.setenv("SDL_VIDEODRIVER", "offscreen")
    opened().close()


def test_a_processor_that_draws_is_told_of_once(capsys: pytest.CaptureFixture[str]) -> None:
    window = opened()
    for tick in range(3):
        window.frame(snapshot(tick), 0.01 * tick)
    name = renderer_name(window._context)
    assert capsys.readouterr().err.count(f"{name} draws, no graphics card") == is_software(window._context)
    window.close()


def test_the_window_runs_reports_keys_and_ends() -> None:
    keys: list[int] = []
    ticks, ends = iter(range(100)), iter([False] * 5 + [True])
    run(
        Ports(lambda: snapshot(next(ticks)), keys.append, lambda: next(ends)),
        PROFILE,
        HudSettings(),
        partial(open_window, scene=SCENE),
    )
    assert keys == [0] * 6
    assert not pygame.display.get_init()


def test_closing_the_window_asks_for_the_end_of_the_drive() -> None:
    keys: list[int] = []
    ends = iter([False] * 3 + [True])

    def latest() -> Snapshot:
        pygame.event.post(pygame.event.Event(pygame.QUIT))
        return snapshot(len(keys))

    run(Ports(latest, keys.append, lambda: next(ends)), PROFILE, HudSettings(), partial(open_window, scene=SCENE))
    assert keys[0] == 0
    assert keys[2] & Key.END


def test_without_opengl_the_instruments_are_there_and_why_is_said(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    window = open_window(PROFILE, HudSettings(), scene=SCENE)
    assert isinstance(window, Window)
    window.frame(snapshot(1), 1.0)
    window.close()
    assert "no OpenGL window can be opened" in capsys.readouterr().err


def test_a_window_of_another_shape_has_bars_and_the_same_picture() -> None:
    """Three screens in one picture keep their shape; what is beside them is black."""
    triple = replace(PROFILE, width_px=1920, height_px=480, screen_width_m=4.8)
    window = open_window(triple, HudSettings(), Habits(size_px=(800, 480)), scene=SCENE)
    assert isinstance(window, ViewWindow)
    for width, height in ((800, 480), (640, 300)):
        window.resized(width, height)
        window.frame(snapshot(1), 1.0)
        picture = np.frombuffer(window._target.read(components=3), np.uint8).reshape(height, width, 3)
        bar = (height - width * 480 // 1920) // 2
        assert not picture[: bar - 1].any()
        assert not picture[height - bar + 1 :].any()
        assert picture[height // 2].any(axis=1).all()
    window.close()


def test_screens_on_displays_of_their_own_share_one_window(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three displays, the middle one with the instruments; which of them a window was opened on tells its place."""
    places = {0: (640, 0), 1: (0, 0), 2: (1280, 0)}
    opened_on: list[int] = []
    plain = pygame.display.set_mode

    def set_mode(size: tuple[int, int], **options: int) -> pygame.Surface:
        opened_on.append(options.pop("display"))
        return plain(size, **options)

    monkeypatch.setattr(pygame.display, "get_desktop_sizes", lambda: [(640, 480)] * 3)
    monkeypatch.setattr(pygame.display, "set_mode", set_mode)
    monkeypatch.setattr(pygame.display, "get_window_position", lambda: places[opened_on[-1]])
    moved_to: list[tuple[int, int]] = []
    monkeypatch.setattr(pygame.display, "set_window_position", moved_to.append)
    screens = (
        ViewScreen(yaw_deg=60.0, display=1), ViewScreen(), ViewScreen(yaw_deg=-60.0, display=2),
    )  # fmt: skip
    view = DriverViewProfile(mirrors=False, screens=screens)
    window = open_window(replace(PROFILE, view=view), HudSettings(), scene=SCENE)
    assert isinstance(window, ViewWindow)
    assert moved_to == [(0, 0)]
    assert pygame.display.get_window_size() == (1920, 480)
    window.frame(snapshot(1), 1.0)
    picture = np.frombuffer(window._target.read(components=3), np.uint8).reshape(480, 1920, 3)[::-1]
    line = 240  # above the instruments
    assert all(picture[line, 640 * number : 640 * (number + 1)].any(axis=1).all() for number in range(3))
    assert not picture[470, :640].any()
    assert picture[440, 640:1280].any()
    assert not picture[470, 1280:].any()
    window.close()


def test_a_display_that_is_not_there_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    view = DriverViewProfile(screens=(ViewScreen(), ViewScreen(display=4)))
    window = open_window(replace(PROFILE, view=view), HudSettings(), scene=SCENE)
    assert isinstance(window, Window)
    window.close()
    assert "hud.view.screens.display: value 4: connected are 0 to 0" in capsys.readouterr().err


def test_help_is_laid_over_the_road() -> None:
    rows = (("Up, W", "throttle"), ("F1", "this help"))
    window = open_window(PROFILE, HudSettings(), scene=SCENE)
    assert isinstance(window, ViewWindow)
    window.frame(snapshot(1), 1.0)
    plain = seen(window)
    window.frame(snapshot(1), 1.0, aids=Aids(help=rows, times=("60 frames/s",)))
    assert seen(window) != plain
    window.frame(snapshot(1), 1.0)
    assert seen(window) == plain
    window.close()
