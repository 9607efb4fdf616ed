"""The draw list: what a screen shows, as plain values in pixels (x right, y down), without any graphics library."""

import math
from typing import Final, NamedTuple

Colour = tuple[int, int, int]
Point = tuple[float, float]

BACKGROUND: Final[Colour] = (8, 11, 16)
PANEL: Final[Colour] = (18, 24, 33)
LINE: Final[Colour] = (52, 64, 80)
TEXT: Final[Colour] = (242, 245, 247)
MUTED: Final[Colour] = (182, 192, 203)
ACTIVE: Final[Colour] = (54, 217, 123)
CAUTION: Final[Colour] = (255, 176, 32)
DANGER: Final[Colour] = (142, 8, 20)
INK: Final[Colour] = (10, 12, 16)
WARNING_LINE: Final[Colour] = (255, 92, 92)  # red for thin shapes on the dark ground, never for text

PALETTE: Final = (BACKGROUND, PANEL, LINE, TEXT, MUTED, ACTIVE, CAUTION, DANGER, INK, WARNING_LINE)


class Box(NamedTuple):
    """A rectangle in pixels."""

    x: float
    y: float
    w: float
    h: float

    @property
    def right(self) -> float:
        """First pixel beyond the right edge."""
        return self.x + self.w

    @property
    def bottom(self) -> float:
        """First pixel below the lower edge."""
        return self.y + self.h

    @property
    def cx(self) -> float:
        """Middle from left to right."""
        return self.x + 0.5 * self.w

    @property
    def cy(self) -> float:
        """Middle from top to bottom."""
        return self.y + 0.5 * self.h

    def inset(self, margin: float) -> "Box":
        """Return the box without `margin` pixels on each side."""
        return Box(self.x + margin, self.y + margin, self.w - 2.0 * margin, self.h - 2.0 * margin)

    def row(self, start: float, end: float) -> "Box":
        """Return the part between two fractions of the height."""
        return Box(self.x, self.y + start * self.h, self.w, (end - start) * self.h)

    def column(self, start: float, end: float) -> "Box":
        """Return the part between two fractions of the width."""
        return Box(self.x + start * self.w, self.y, (end - start) * self.w, self.h)


class Rect(NamedTuple):
    """A rectangle, filled, or an outline `line` pixels wide; corners rounded by `radius`."""

    box: Box
    colour: Colour
    role: str
    radius: float = 0.0
    line: float = 0.0


class Polygon(NamedTuple):
    """A closed polygon, filled, or an outline `line` pixels wide."""

    points: tuple[Point, ...]
    colour: Colour
    role: str
    line: float = 0.0


class Arc(NamedTuple):
    """A ring section; degrees clockwise from twelve o'clock; `inner` 0 and 360 degrees is a disc."""

    cx: float
    cy: float
    outer: float
    inner: float
    start_deg: float
    end_deg: float
    colour: Colour
    role: str


class Text(NamedTuple):
    """One line of text: `y` is the middle of the capitals, `cap_px` their height; anchor l, c or r of `x`.

    `arcmin` is the smallest cap height, in minutes of arc at the driver's eye, that this text may have.
    """

    x: float
    y: float
    text: str
    cap_px: float
    colour: Colour
    role: str
    anchor: str = "c"
    arcmin: float = 20.0


DrawItem = Rect | Polygon | Arc | Text

_WIDTHS: Final = (
    "191 229 325 382 382 611 496 163 229 229 267 401 191 229 191 191 382 382 382 382 382 382 382 382 382 382 229 229 "
    "401 401 401 420 669 496 496 496 496 458 420 535 497 191 382 496 420 572 496 534 458 534 496 458 420 496 458 649 "
    "458 458 420 229 208 228 401 412 229 382 420 382 420 382 229 419 420 191 191 382 191 611 420 420 420 420 267 381 "
    "229 420 382 534 382 382 343 267 193 267 401"
)
_LATIN_WIDTHS: Final = (
    "297 228 382 381 382 382 193 382 229 506 254 381 401 297 506 228 416 401 242 241 229 420 382 191 229 241 251 382 "
    "597 597 597 420 496 496 496 496 496 497 686 496 458 458 458 458 191 191 191 192 496 496 534 534 534 534 534 401 "
    "534 496 496 496 496 458 458 420 382 382 382 382 382 382 611 382 382 382 382 382 191 191 191 192 420 420 420 420 "
    "420 420 420 401 420 420 420 420 420 382 420 383"
)
_CAP: Final = 501.0
_ADVANCES: Final = {
    chr(first + index): float(width) / _CAP
    for first, widths in ((32, _WIDTHS), (160, _LATIN_WIDTHS))
    for index, width in enumerate(widths.split())
}
"""Advance of the characters 32 to 126 and 160 to 255 of pygame's own font in cap heights (measured at 1000 px)."""


def text_width_px(text: str, cap_px: float) -> float:
    """Return the width of `text` in pixels; only printable Latin-1 has a width, so nothing else may be drawn."""
    return sum(_ADVANCES[character] for character in text) * cap_px


def fit_cap_px(text: str, cap_px: float, width_px: float) -> float:
    """Return `cap_px`, or the largest cap height with which `text` still fits into `width_px`."""
    natural = text_width_px(text, cap_px)
    return cap_px if natural <= width_px else cap_px * width_px / natural


def around(cx: float, cy: float, radius: float, corners: int, turn_deg: float = 0.0) -> tuple[Point, ...]:
    """Return a regular polygon; its first corner stands `turn_deg` clockwise from twelve o'clock."""
    return tuple(at_clock(cx, cy, radius, turn_deg + 360.0 * corner / corners) for corner in range(corners))


def at_clock(cx: float, cy: float, radius: float, clock_deg: float) -> Point:
    """Return the point `radius` away from the centre in a direction clockwise from twelve o'clock."""
    angle = math.radians(clock_deg)
    return cx + radius * math.sin(angle), cy - radius * math.cos(angle)


def bounds(item: DrawItem) -> Box:
    """Return the rectangle that an item stays inside."""
    if isinstance(item, Rect):
        return item.box
    if isinstance(item, Arc):
        return Box(item.cx - item.outer, item.cy - item.outer, 2.0 * item.outer, 2.0 * item.outer)
    if isinstance(item, Text):
        width = text_width_px(item.text, item.cap_px)
        left = {"l": item.x, "c": item.x - 0.5 * width, "r": item.x - width}[item.anchor]
        return Box(left, item.y - 0.5 * item.cap_px, width, item.cap_px)
    xs = [x for x, _ in item.points]
    ys = [y for _, y in item.points]
    return Box(min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys))


def luminance(colour: Colour) -> float:
    """Return the relative luminance 0 to 1 of an sRGB colour (WCAG 2.2, relative luminance)."""
    linear = [c / 3294.6 if c <= 10 else ((c / 255.0 + 0.055) / 1.055) ** 2.4 for c in colour]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: Colour, other: Colour) -> float:
    """Return the contrast ratio of two colours, 1 to 21 (WCAG 2.2, contrast ratio)."""
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)
