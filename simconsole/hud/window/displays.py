"""Displays side by side: where they stand, and one window without a frame over several of them."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from simconsole.hud.draw import Box
from simconsole.hud.window.sdl_display import start_display
from simconsole.profiles.view import DriverViewProfile
from simconsole.values.errors import WorkerError


class Span(NamedTuple):
    """A window over several displays, in pixels."""

    left_px: int  # on the desktop
    top_px: int
    width_px: int
    height_px: int
    displays: Mapping[int, Box]  # by number, in the window


def named_displays(view: DriverViewProfile) -> set[int]:
    """Return the displays that the screens of a view name."""
    return {screen.display for screen in view.screens if screen.display is not None}


def span_of(places: Mapping[int, Box]) -> Span:
    """Return the smallest window over displays at these places of the desktop."""
    left, top = min(box.x for box in places.values()), min(box.y for box in places.values())
    return Span(
        left_px=int(left),
        top_px=int(top),
        width_px=int(max(box.right for box in places.values()) - left),
        height_px=int(max(box.bottom for box in places.values()) - top),
        displays={number: box._replace(x=box.x - left, y=box.y - top) for number, box in places.items()},
    )


def display_places(numbers: Iterable[int]) -> dict[int, Box]:
    """Return where displays stand on the desktop. Begins SDL's display anew: no window is left open.

    pygame tells no display's place: so a hidden window of each display's own size is opened on it and asked for its.

    Raises:
        WorkerError: one of them is not there.
    """
    import pygame

    sizes = pygame.display.get_desktop_sizes()
    places = {}
    for number in sorted(numbers):
        if number >= len(sizes):
            raise WorkerError(f"hud.view.screens.display: value {number}: connected are 0 to {len(sizes) - 1}")
        pygame.display.set_mode(sizes[number], flags=pygame.HIDDEN | pygame.NOFRAME, display=number)
        places[number] = Box(*pygame.display.get_window_position(), *sizes[number])
    pygame.display.quit()  # else the next window would be the hidden one, its OpenGL as large as that was
    start_display()
    return places
