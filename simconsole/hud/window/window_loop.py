"""The loop of the driver's window, in a process of its own: reads the newest snapshot, draws, reports the keys held.

Everything from outside comes in as callables (`Ports`), so the loop runs the same on shared memory and in a test.
"""

import time
from collections.abc import Callable
from typing import Any

from msgspec.structs import replace

from simconsole.hud.aids import Aids
from simconsole.hud.frame_times import FrameTimes
from simconsole.hud.key_names import WindowKey
from simconsole.hud.view import HudSettings
from simconsole.hud.window.display_memory import Freshness
from simconsole.hud.window.habits import Habits, HabitsFile, habits_of
from simconsole.hud.window.held_keys import HeldKeys, meaning_of, pressed_keys
from simconsole.hud.window.ports import DriverWindow, Ports
from simconsole.hud.window.pygame_window import open_cluster
from simconsole.profiles.view import HudProfile
from simconsole.values.key_codes import Key

Opened = Callable[[HudProfile, HudSettings, Habits], DriverWindow]


def run(
    ports: Ports,
    profile: HudProfile,
    settings: HudSettings,
    opened: Opened = open_cluster,
    memory: HabitsFile | None = None,
) -> None:
    """Show what `opened` opens, the cluster alone if nothing else is said, until `ports.stop` says so.

    Closing the window, or its key for that, asks for the end of the drive as a key held from then on: whoever drives
    ends it and stops this window with everything else. A window that ended by itself would be opened again.

    Args:
        ports: The world outside.
        profile: The screen.
        settings: What the display must know of the drive.
        opened: Opens the window.
        memory: Where it is remembered how the window was left; None: nowhere.
    """
    loop = _Loop(ports, profile, settings, opened, memory)
    import pygame

    clock = pygame.time.Clock()
    try:
        while not ports.stop():
            loop.turn()
            clock.tick(profile.rate_hz)
    finally:
        ports.report_keys(0)
        loop.window.close()


class _Loop:
    """One window and what its keys have changed."""

    def __init__(
        self, ports: Ports, profile: HudProfile, settings: HudSettings, opened: Opened, memory: HabitsFile | None
    ) -> None:
        self._ports, self._profile, self._settings, self._opened = ports, profile, settings, opened
        self._memory = memory
        self._habits = habits_of(profile) if memory is None else memory.load(profile)
        self.window = opened(profile, settings, self._habits)
        self._keys, self._end = HeldKeys(), Key(0)
        self._tapped, self._mask = Key(0), 0
        self._help = self._shows_times = False
        self._times, self._freshness = FrameTimes(self.window.drawer, settings.language), Freshness()
        self._drawn_s = time.monotonic()

    def turn(self) -> None:
        """Take the events, report the keys, draw one frame."""
        import pygame

        ports = self._ports
        self._tapped = Key(0)
        for event in pygame.event.get():
            self._take(event)
        now_s = time.monotonic()
        self._mask = self._keys.mask(pressed_keys() | self._tapped, pygame.key.get_focused(), now_s) | self._end
        ports.report_keys(self._mask)
        snapshot = ports.latest()
        age_s = None if snapshot is None else self._freshness.age_s(snapshot.tick, now_s)
        aids = Aids(
            self._settings.help_rows if self._help else (), self._times.lines(age_s) if self._shows_times else ()
        )
        before_s = time.monotonic()
        self.window.frame(snapshot, before_s, ports.can_up(), ports.link(), ports.motion(), aids, ports.advice())
        after_s = time.monotonic()
        self._times.add(after_s - self._drawn_s, after_s - before_s)
        self._drawn_s = after_s
        ports.drawn()

    def _take(self, event: Any) -> None:
        import pygame

        if event.type == pygame.QUIT or (event.type == pygame.KEYDOWN and event.key == pygame.K_END):
            self._end = Key.END
        elif event.type == pygame.WINDOWSIZECHANGED:
            self._resize(event.x, event.y)
        elif event.type == pygame.KEYDOWN:
            self._tapped |= meaning_of(event.key)  # it may be up again before a slow frame is over
            self._press(event.key)

    def _press(self, code: int) -> None:
        import pygame

        key = next((key for key in WindowKey if getattr(pygame, key) == code), None)
        habits = self._habits
        if key is WindowKey.HELP:
            self._help = not self._help
        elif key is WindowKey.FRAME_TIMES:
            self._shows_times = not self._shows_times
        elif key is WindowKey.FULL_SCREEN:
            self._reopen(replace(habits, fullscreen=not habits.fullscreen))
        elif key is WindowKey.VSYNC:
            self._reopen(replace(habits, vsync=not habits.vsync))
        elif key is WindowKey.NEXT_DISPLAY:
            self._reopen(replace(habits, display=(habits.display + 1) % max(1, pygame.display.get_num_displays())))

    def _reopen(self, habits: Habits) -> None:
        """Open the window anew; keys held count as held meanwhile, for a keyboard that falls silent is lost."""
        self._ports.report_keys(self._mask)
        self.window.close()
        self.window = self._opened(self._profile, self._settings, habits)
        self._ports.report_keys(self._mask)
        self._remember(habits)

    def _resize(self, width_px: int, height_px: int) -> None:
        self.window.resized(width_px, height_px)
        if not self._habits.fullscreen:
            self._remember(replace(self._habits, size_px=(width_px, height_px)))

    def _remember(self, habits: Habits) -> None:
        if habits != self._habits:
            self._habits = habits
            if self._memory is not None:
                self._memory.save(self._profile, habits)
