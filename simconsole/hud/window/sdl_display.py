"""SDL's connection to the display that a person sees."""

import os
import sys
from typing import Final

UNSEEN: Final = ("dummy", "offscreen")
"""SDL's video drivers without a display."""


def has_display() -> bool:
    """Return whether a window would be seen by anybody."""
    if os.environ.get("SDL_VIDEODRIVER") in UNSEEN:
        return False
    return sys.platform != "linux" or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))


def choose_display() -> None:
    """Select SDL's `dummy` video driver where no desktop can be reached, unless the user names a driver.

    Call it before SDL starts. SDL would fall back to `dummy` by itself, but its Wayland probe prints an error first.
    """
    reachable = ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR")
    if sys.platform == "linux" and not any(os.environ.get(name) for name in reachable):
        os.environ.setdefault("SDL_VIDEODRIVER", "dummy")


def start_display() -> None:
    """Start SDL's video on the display that the environment names, if it names one.

    SDL alone would go on without a display where the named one does not answer: a person would wait for a window that
    nobody can see, and press keys that nobody hears.

    Raises:
        pygame.error: SDL cannot start, or the display does not answer.
    """
    import pygame

    pygame.display.init()
    if has_display() and pygame.display.get_driver() in UNSEEN:
        pygame.display.quit()
        named = os.environ.get("WAYLAND_DISPLAY") or os.environ.get("DISPLAY")
        raise pygame.error(f"display {named} does not answer")
