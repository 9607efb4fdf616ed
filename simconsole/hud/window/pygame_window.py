"""The cluster in a window, in a process of its own: reads the newest snapshot, draws, reports the keys held.

Everything from outside comes in as callables (`Ports`), so the loop runs the same on shared memory and in a test.
"""

import os
import sys
import time
from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from simconsole.hud.draw import DrawItem
from simconsole.hud.key_names import KEY_CODES
from simconsole.hud.layout import check_screen, layout, sample_views
from simconsole.hud.screen import Screen, screen_of
from simconsole.hud.view import HudSettings
from simconsole.hud.window.display_memory import DisplayMemory
from simconsole.hud.window.raster import Painter
from simconsole.profiles.view import HudProfile
from simconsole.values.errors import WorkerError
from simconsole.values.key_codes import Key
from simconsole.values.state_vector import Snapshot
from simconsole.world.traffic.road_users import RoadUsersAt


class Motion(NamedTuple):
    """The two newest ticks, and how long ago the newer one was published."""

    older: Snapshot
    newer: Snapshot
    age_s: float
    road_users: RoadUsersAt | None = None  # of the newest step of traffic; None: there is none


class Ports(NamedTuple):
    """What the window needs of the world outside."""

    latest: Callable[[], Snapshot | None]  # the newest tick, None before the first
    report_keys: Callable[[int], None]  # takes a `Key` mask at every frame: its silence means the keyboard is gone
    stop: Callable[[], bool]  # True ends the window
    can_up: Callable[[], bool | None] = lambda: None  # whether the CAN bus is up; None where there is none
    drawn: Callable[[], None] = lambda: None  # told after every frame
    link: Callable[[], str | None] = lambda: None  # how the rosbridge link stands; None where there is no bridge
    motion: Callable[[], Motion | None] = lambda: None  # for a picture that moves between two ticks


class DriverWindow(Protocol):
    """A window in front of the driver."""

    def frame(
        self,
        snapshot: Snapshot | None,
        now_s: float,
        can_up: bool | None = None,
        link: str | None = None,
        motion: Motion | None = None,
    ) -> None:
        """Draw one frame. `can_up`, `link`: None without CAN bus or bridge."""

    def close(self) -> None:
        """Close the window."""


class Window:
    """One window with one cluster."""

    def __init__(self, profile: HudProfile, settings: HudSettings) -> None:
        """Open the window.

        Raises:
            ProfileError: the screen is too small or too far away to be read.
            WorkerError: no window can be opened here.
        """
        self._screen: Screen = screen_of(profile)
        check_screen(self._screen, "hud")
        self._memory = DisplayMemory(settings)
        self._painter = Painter()
        self._drawn: list[DrawItem] = []
        choose_display()
        import pygame

        flags = pygame.FULLSCREEN | pygame.SCALED if profile.fullscreen else 0
        try:
            pygame.display.init()
            self._surface = pygame.display.set_mode((self._screen.width_px, self._screen.height_px), flags)
        except pygame.error as problem:
            raise WorkerError(f"hud: no window can be opened: {problem}") from None
        pygame.display.set_caption("simconsole")
        if profile.fullscreen:
            pygame.mouse.set_visible(False)
        # Never shown. They load the fonts, which takes longer than a keyboard may be silent before it counts as lost.
        before: list[DrawItem] = []
        for sample in sample_views():
            after = layout(sample, self._screen)
            self._painter.repaint(self._surface, before, after)
            before = after

    def frame(
        self,
        snapshot: Snapshot | None,
        now_s: float,
        can_up: bool | None = None,
        link: str | None = None,
        motion: Motion | None = None,
    ) -> None:
        """Draw one frame; one equal to the last costs nothing."""
        import pygame

        items = layout(self._memory.content(snapshot, now_s, can_up, link), self._screen)
        if items == self._drawn:
            return
        pygame.display.update(self._painter.repaint(self._surface, self._drawn, items))
        self._drawn = items

    def close(self) -> None:
        """Close the window."""
        import pygame

        pygame.display.quit()


def choose_display() -> None:
    """Select SDL's `dummy` video driver where no desktop can be reached, unless the user names a driver.

    Call it before SDL starts. SDL would fall back to `dummy` by itself, but its Wayland probe prints an error first.
    """
    reachable = ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR")
    if sys.platform == "linux" and not any(os.environ.get(name) for name in reachable):
        os.environ.setdefault("SDL_VIDEODRIVER", "dummy")


def held_keys() -> int:
    """Return the mask of all keys held now; call after the events were pumped."""
    import pygame

    pressed = pygame.key.get_pressed()
    mask = 0
    for name, key in KEY_CODES.items():
        if pressed[getattr(pygame, name)]:
            mask |= key
    return mask


def _asks_for_end(event: Any) -> bool:
    import pygame

    if event.type == pygame.KEYDOWN:
        return bool(event.key == pygame.K_END)
    return bool(event.type == pygame.QUIT)


def run(
    ports: Ports,
    profile: HudProfile,
    settings: HudSettings,
    opened: Callable[[HudProfile, HudSettings], DriverWindow] = Window,
) -> None:
    """Show what `opened` opens, the cluster alone if nothing else is said, until `ports.stop` says so.

    Closing the window, or its key for that, asks for the end of the drive as a key held from then on: whoever drives
    ends it and stops this window with everything else. A window that ended by itself would be opened again.
    """
    window = opened(profile, settings)
    import pygame

    clock = pygame.time.Clock()
    end = Key(0)
    try:
        while not ports.stop():
            if any(_asks_for_end(event) for event in pygame.event.get()):
                end = Key.END
            ports.report_keys(held_keys() | end)
            window.frame(ports.latest(), time.monotonic(), ports.can_up(), ports.link(), ports.motion())
            ports.drawn()
            clock.tick(profile.rate_hz)
    finally:
        ports.report_keys(0)
        window.close()
