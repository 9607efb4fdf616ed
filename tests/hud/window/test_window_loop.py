"""The loop of a window: its own keys, keys held, the end; on SDL's dummy display and on a real X server."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from subprocess import PIPE

import numpy as np
import pygame
import pytest

from simconsole.hud.aids import Aids
from simconsole.hud.view import HudSettings
from simconsole.hud.window.habits import Habits, HabitsFile
from simconsole.hud.window.ports import Ports
from simconsole.hud.window.pygame_window import Window
from simconsole.hud.window.window_loop import run
from simconsole.profiles.view import HudProfile
from simconsole.values.key_codes import Key
from simconsole.values.state_vector import PLATFORM_AT, Snapshot
from tests.hud.window.x_server import SIZE, hands, x_server
from tests.patience import PATIENCE_S

pytestmark = pytest.mark.usefixtures("dummy_display")

PROFILE = HudProfile(width_px=700, height_px=525, screen_width_m=1.6, eye_distance_m=1.1, rate_hz=240)
SETTINGS = HudSettings(help_rows=(("Up, W", "throttle"), ("F1", "this help")))


@pytest.fixture
def display(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A desktop of 1366 x 768 pixels, without a window manager."""
    with x_server() as name:
        monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
        monkeypatch.delenv("SDL_FRAMEBUFFER_ACCELERATION", raising=False)
        monkeypatch.setenv("DISPLAY", name)
        yield name
        pygame.display.quit()


def snapshot(tick: int) -> Snapshot:
    return Snapshot(tick, 250, np.zeros(PLATFORM_AT))


def stop_after(frames: int) -> Iterator[bool]:
    yield from (False for _ in range(frames))
    while True:
        yield True


def own() -> str:
    return str(pygame.display.get_wm_info()["window"])


def press(name: str) -> None:
    pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=getattr(pygame, name)))


class Watched(Window):
    """A window that keeps what it was asked to show, and how it was opened."""

    opened: list[tuple[Habits, tuple[int, int]]]
    aids: list[Aids]

    def frame(self, *args: object, **more: object) -> None:
        self.aids.append(args[5])  # type: ignore[arg-type]
        super().frame(*args, **more)  # type: ignore[arg-type]


@pytest.fixture
def watched() -> type[Watched]:
    class Fresh(Watched):
        opened, aids = [], []

    return Fresh


def opener(kind: type[Watched]) -> Callable[[HudProfile, HudSettings, Habits], Window]:
    def opened(profile: HudProfile, settings: HudSettings, habits: Habits) -> Window:
        window = kind(profile, settings, habits)
        kind.opened.append((habits, pygame.display.get_window_size()))
        return window

    return opened


def drive(kind: type[Watched], memory: HabitsFile | None, *acts: Callable[[], object] | None) -> list[int]:
    """Run one frame for each act, which is done before it; return the keys that were told."""
    keys: list[int] = []
    waiting, ends = iter(acts), stop_after(len(acts))

    def stop() -> bool:
        act = next(waiting, None)
        if act is not None:
            act()
        return next(ends)

    run(Ports(lambda: snapshot(len(keys)), keys.append, stop), PROFILE, SETTINGS, opener(kind), memory)
    return keys


def test_the_window_runs_reports_keys_and_ends() -> None:
    keys: list[int] = []
    ticks, ends = iter(range(100)), stop_after(5)
    run(Ports(lambda: snapshot(next(ticks)), keys.append, lambda: next(ends)), PROFILE, HudSettings())
    assert keys == [0] * 6  # five frames, and the release at the end
    assert next(ticks) == 5
    assert not pygame.display.get_init()


@pytest.mark.parametrize(
    ("event", "asks"),
    [
        (pygame.event.Event(pygame.QUIT), True),
        (pygame.event.Event(pygame.KEYDOWN, key=pygame.K_END), True),
        (pygame.event.Event(pygame.KEYDOWN, key=pygame.K_F2), False),
    ],
)
def test_closing_the_window_asks_for_the_end_until_it_comes(event: pygame.event.Event, asks: bool) -> None:
    """A window that ended by itself was opened again by the supervisor."""
    posted = iter([True])

    def latest() -> None:
        if next(posted, False):
            pygame.event.post(event)

    keys: list[int] = []
    ends = stop_after(5)
    run(Ports(latest, keys.append, lambda: next(ends)), PROFILE, HudSettings())
    assert keys == [0, *[int(Key.END) if asks else 0] * 4, 0]


def test_a_tap_shorter_than_a_frame_is_told_once(watched: type[Watched]) -> None:
    keys = drive(watched, None, None, lambda: press("K_e"), None)
    assert keys == [0, int(Key.GEAR_UP), 0, 0]


def test_keys_are_released_when_the_ring_breaks() -> None:
    keys: list[int] = []

    def broken() -> Snapshot:
        raise OSError

    with pytest.raises(OSError):  # noqa: PT011 - any failure of the ring will do
        run(Ports(broken, keys.append, lambda: False), PROFILE, HudSettings())
    assert keys[-1] == 0
    assert not pygame.display.get_init()


def test_help_and_frame_times_come_and_go_by_their_keys(watched: type[Watched]) -> None:
    f1, f3 = (lambda: press("K_F1")), (lambda: press("K_F3"))
    drive(watched, None, None, f1, None, f1, f3, None, f3)
    assert [bool(aids.help) for aids in watched.aids] == [False, True, True, False, False, False, False]
    shown = [bool(aids.times) for aids in watched.aids]
    assert (shown[:4], shown[5], shown[6]) == ([False] * 4, True, False)
    assert watched.aids[5].times[-1] == "processor, no OpenGL"


def test_full_screen_and_vsync_go_by_key_and_are_remembered(watched: type[Watched], tmp_path: Path) -> None:
    memory = HabitsFile(tmp_path / "window.json")
    drive(watched, memory, None, lambda: press("K_F11"), lambda: press("K_F10"), lambda: press("K_F9"))
    assert [habits for habits, _ in watched.opened] == [
        Habits(),
        Habits(fullscreen=True),
        Habits(fullscreen=True, vsync=False),
        Habits(fullscreen=True, vsync=False),  # the only display there is
    ]
    drive(watched, memory, None)
    assert watched.opened[-1][0] == Habits(fullscreen=True, vsync=False)


def test_on_a_small_display_everything_is_on_it(watched: type[Watched], display: str) -> None:
    """Mode banner and lamps were below the lower edge at 1366 x 768."""
    whole = HudProfile()
    assert (whole.width_px, whole.height_px) == (1400, 1050)
    for habits in (Habits(), Habits(fullscreen=True), Habits(size_px=(3000, 400))):
        window = watched(whole, SETTINGS, habits)
        size = pygame.display.get_window_size()
        assert size[0] <= SIZE[0]
        assert size[1] <= SIZE[1]
        if habits.fullscreen:
            assert size == SIZE
        window.close()


def test_a_window_is_resized_by_hand_and_opens_as_large_again(
    watched: type[Watched], display: str, tmp_path: Path
) -> None:
    memory = HabitsFile(tmp_path / "window.json")
    pictures: list[tuple[int, int]] = []

    def look() -> None:
        surface = pygame.display.get_surface()
        assert surface is not None
        pictures.append(surface.get_size())

    def pull() -> None:
        hands(display, "windowsize", own(), "900", "420")

    drive(watched, memory, None, None, pull, None, None, look)
    assert pictures == [(900, 420)]
    assert memory.load(PROFILE).size_px == (900, 420)
    drive(watched, memory, None)
    assert watched.opened[-1][1] == (900, 420)


OTHER = """
import sys
import pygame
pygame.display.init()
pygame.display.set_mode((200, 100))
pygame.event.pump()
print(pygame.display.get_wm_info()["window"], flush=True)
sys.stdin.read()
"""


@pytest.fixture
def other_window(display: str) -> Iterator[str]:
    """The window of another program."""
    command = [sys.executable, "-W", "ignore", "-c", OTHER]
    environment = {**os.environ, "PYGAME_HIDE_SUPPORT_PROMPT": "1"}
    with subprocess.Popen(command, env=environment, stdin=PIPE, stdout=PIPE, text=True) as program:
        assert program.stdout is not None
        yield program.stdout.readline().strip()
        program.communicate(timeout=PATIENCE_S)


def test_keys_held_while_another_window_takes_the_keyboard_stay_held(
    watched: type[Watched], display: str, other_window: str
) -> None:
    focused: list[bool] = []

    def turn_to(window: str) -> None:
        hands(display, "windowfocus", "--sync", window)

    def look() -> None:
        focused.append(pygame.key.get_focused())

    keys = drive(
        watched, None, None, lambda: turn_to(own()), None, lambda: hands(display, "keydown", "w"), None, look,
        lambda: turn_to(other_window), None, look, lambda: hands(display, "keyup", "w"), None,
    )  # fmt: skip
    assert focused == [True, False]
    assert keys[0] == 0
    assert keys[4:] == [int(Key.THROTTLE)] * (len(keys) - 5) + [0]
