"""The screen in front of the driver: how many pixels a character needs to be read from the seat."""

import math
from collections.abc import Mapping
from typing import Final, NamedTuple

from simconsole.hud.draw import Box
from simconsole.profiles.view import HudProfile

DRIVING_ARCMIN: Final = 20.0
"""Cap height of text needed while driving, minutes of arc (20' is best, 16' the least; ISO 15008 practice)."""
SECONDARY_ARCMIN: Final = 16.0
"""Cap height of labels and units (rule 1: 16' at least)."""
SPEED_ARCMIN: Final = 60.0
"""Cap height of the speed digits (rule 1)."""
BORDER: Final = 0.05
"""Part of each side that stays empty: a beamer's keystone may cut it (rule 15)."""
NARROWEST_ASPECT: Final = 4.0 / 3.0
WIDEST_ASPECT: Final = 7.0 / 3.0
LARGE_TEXT: Final = 1.25
"""Factor of all sizes of text where the profile asks for large text."""
TITLE_BAR: Final = 0.08
"""Part of a display's height that a window's title and a panel of the desktop may take."""
TRIPLE_ASPECT: Final = 2.4
"""From this aspect ratio on, the picture is three screens side by side and the driver sits before the middle one."""


class Screen(NamedTuple):
    """A screen of `width_px` by `height_px` that is `screen_width_m` wide, seen from `eye_distance_m`."""

    width_px: int
    height_px: int
    screen_width_m: float
    eye_distance_m: float
    has_view: bool = False  # the road is above the instruments
    text: float = 1.0  # factor of all sizes of text

    @property
    def px_per_arcmin(self) -> float:
        """Pixels per minute of arc straight ahead of the eye, as text counts them: more of them where it is large."""
        angle_m = self.eye_distance_m * math.tan(math.radians(1.0 / 60.0))
        return self.text * self.width_px / self.screen_width_m * angle_m

    @property
    def has_large_text(self) -> bool:
        """Whether text is larger than it must be."""
        return self.text > 1.0

    @property
    def is_triple(self) -> bool:
        """Whether the picture spans three screens."""
        return self.width_px > TRIPLE_ASPECT * self.height_px

    def safe(self) -> Box:
        """Return what is left inside the border."""
        left, top = math.ceil(self.width_px * BORDER), math.ceil(self.height_px * BORDER)
        return Box(left, top, self.width_px - 2 * left, self.height_px - 2 * top)

    def panels(self) -> tuple[Box, ...]:
        """Return the safe area of each physical screen, left to right: one, or three."""
        safe = self.safe()
        if not self.is_triple:
            return (safe,)
        third = self.width_px / 3.0
        margin = third * BORDER
        left, right = safe.x, safe.right
        return (
            Box(left, safe.y, third - margin - left, safe.h),
            Box(third + margin, safe.y, third - 2.0 * margin, safe.h),
            Box(2.0 * third + margin, safe.y, right - 2.0 * third - margin, safe.h),
        )

    def content(self) -> Box:
        """Return where the cluster stands: before the driver."""
        panels = self.panels()
        return panels[len(panels) // 2]


class Fitted(NamedTuple):
    """A screen's picture in a window: as large as goes, in the middle of its display, bars beside it where need be."""

    screen: Screen
    window_width_px: int
    window_height_px: int
    left_px: int  # of the picture, from the window's left edge
    top_px: int
    display: int = 0  # which one the picture stands on
    others: tuple[tuple[int, Box], ...] = ()  # the other displays that the window spans, in its pixels

    @property
    def has_bars(self) -> bool:
        """Whether the window is larger than the picture."""
        return (self.screen.width_px, self.screen.height_px) != (self.window_width_px, self.window_height_px)

    def front(self) -> Box:
        """Return what of the window is before the driver: the picture, or the middle one of its three screens."""
        share = 3.0 if self.screen.is_triple else 1.0
        width = self.screen.width_px / share
        left = self.left_px + 0.5 * (self.screen.width_px - width)
        return Box(left, self.top_px, width, self.screen.height_px)


def fit(screen: Screen, width_px: int, height_px: int) -> Fitted:
    """Return `screen` in a window of this size.

    One screen takes any shape between its own, 4:3 and 21:9; of three side by side the seams must stay where they are.
    Characters keep their share of what is smaller, width or height.
    """
    own = screen.width_px / screen.height_px
    narrowest, widest = (own, own) if screen.is_triple else (min(own, NARROWEST_ASPECT), max(own, WIDEST_ASPECT))
    aspect = min(widest, max(narrowest, width_px / height_px))
    width = max(1, min(width_px, round(height_px * aspect)))
    height = max(1, min(height_px, round(width_px / aspect)))
    share = min(width / screen.width_px, height / screen.height_px)
    width_m = screen.screen_width_m * width / screen.width_px / share
    return Fitted(
        screen=screen._replace(width_px=width, height_px=height, screen_width_m=width_m),
        window_width_px=width_px,
        window_height_px=height_px,
        left_px=(width_px - width) // 2,
        top_px=(height_px - height) // 2,
    )


def fit_span(screen: Screen, displays: Mapping[int, Box], display: int) -> Fitted:
    """Return `screen` on one of the displays that a window spans.

    Args:
        screen: What the profile asks for.
        displays: Where each stands in the window, in pixels.
        display: Which of them has the picture.
    """
    place = displays[display]
    alone = fit(screen, int(place.w), int(place.h))
    return alone._replace(
        window_width_px=int(max(box.right for box in displays.values())),
        window_height_px=int(max(box.bottom for box in displays.values())),
        left_px=alone.left_px + int(place.x),
        top_px=alone.top_px + int(place.y),
        display=display,
        others=tuple((number, box) for number, box in sorted(displays.items()) if number != display),
    )


def window_size(screen: Screen, display: tuple[int, int]) -> tuple[int, int]:
    """Return the largest window of the screen's shape that a display holds with a title bar, never above the screen's.

    Args:
        screen: What the profile asks for.
        display: Width and height of the display in pixels.
    """
    width, height = display
    share = min(1.0, width / screen.width_px, height / screen.height_px)
    if share < 1.0:
        share = min(width / screen.width_px, (1.0 - TITLE_BAR) * height / screen.height_px)
    return int(screen.width_px * share), int(screen.height_px * share)


def screen_of(profile: HudProfile) -> Screen:
    """Return the screen that a profile describes."""
    return Screen(
        profile.width_px,
        profile.height_px,
        profile.screen_width_m,
        profile.eye_distance_m,
        has_view=profile.view is not None,
        text=text_factor(large=profile.large_text),
    )


def text_factor(*, large: bool) -> float:
    """Return the factor of all sizes of text."""
    return LARGE_TEXT if large else 1.0
