"""Which keys the driver holds, also for the moment in which something else on the desktop takes the keyboard."""

from typing import Final

from simconsole.hud.key_names import KEY_CODES
from simconsole.values.key_codes import Key

KEPT_S: Final = 2.0
"""How long keys count as held after the window lost the keyboard.

A message that pops up must not take a foot off the pedals; but a key that is let go of elsewhere is never told of, so
nothing may stay pressed for good.
"""


class HeldKeys:
    """Remembers what was held when the window lost the keyboard."""

    def __init__(self) -> None:
        self._kept = 0
        self._focused_s = -KEPT_S

    def mask(self, pressed: int, focused: bool, now_s: float) -> int:
        """Return the mask of keys that count as held.

        Args:
            pressed: What the window system tells: nothing while the window has no keyboard.
            focused: Whether it has the keyboard.
            now_s: Of any steady clock.
        """
        if focused:
            self._kept, self._focused_s = pressed, now_s
            return pressed
        return pressed | (self._kept if now_s - self._focused_s <= KEPT_S else 0)


def meaning_of(code: int) -> Key:
    """Return what a key of pygame's code means to the drive; nothing: `Key(0)`."""
    import pygame

    return next((key for name, key in KEY_CODES.items() if getattr(pygame, name) == code), Key(0))


def pressed_keys() -> int:
    """Return the mask of all keys that SDL knows pressed; call after the events were pumped."""
    import pygame

    pressed = pygame.key.get_pressed()
    mask = 0
    for name, key in KEY_CODES.items():
        if pressed[getattr(pygame, name)]:
            mask |= key
    return mask
