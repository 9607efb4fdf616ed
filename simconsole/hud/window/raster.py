"""Draw lists to pixels with pygame-ce: the only place where the cluster meets a graphics library.

Shapes are drawn larger than wanted and scaled down, which smooths their edges; the results are kept, so a frame
costs the few items that moved. Needs neither a display nor a video driver.
"""

from __future__ import annotations

import io
import math
import os
from collections import OrderedDict
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simconsole.hud.draw import Arc, Box, Colour, DrawItem, Polygon, Rect, Text, at_clock, bounds, text_width_px
from simconsole.hud.layout import layout
from simconsole.hud.screen import Screen, screen_of
from simconsole.hud.view import HudMemory, HudSettings, HudView, view
from simconsole.profiles.view import HudProfile
from simconsole.values.state_vector import Snapshot

if TYPE_CHECKING:
    import pygame

CAP_PER_SIZE: Final = 0.501
"""Height of a capital in pygame's own font at size 1."""
FONT_SCALE: Final = 0.6875
"""Factor by which pygame scales the size that is asked of its own font (`Font(None, size)`)."""
KEPT: Final = 600
"""Drawn shapes and texts kept for the next frame."""
LARGE_PX: Final = 200.0
"""Shapes above this size are smoothed two times instead of four."""
ARC_STEP_DEG: Final = 1.5
WORDS_SCALE: Final = 4
"""Factor by which texts are drawn larger before they are scaled down."""


class Painter:
    """Draws lists on surfaces and remembers what it has drawn."""

    def __init__(self) -> None:
        os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # standard output belongs to --json
        import pygame.font
        from pygame.pkgdata import getResource

        pygame.font.init()
        # Read once: otherwise pygame keeps the file open for each font size.
        with getResource(pygame.font.get_default_font()) as file:  # type: ignore[no-untyped-call]
            self._typeface: bytes = file.read()
        self._fonts: dict[int, pygame.font.Font] = {}
        self._kept: OrderedDict[DrawItem, tuple[pygame.Surface, tuple[int, int]]] = OrderedDict()

    def paint(self, surface: pygame.Surface, items: Sequence[DrawItem]) -> None:
        """Draw `items` in order."""
        for item in items:
            if isinstance(item, Rect) and item.line == 0.0:
                _rectangle(surface, item)
                continue
            sprite = self._kept.get(item)
            if sprite is None:
                sprite = self._kept[item] = self._sprite(item)
                if len(self._kept) > KEPT:
                    self._kept.popitem(last=False)
            else:
                self._kept.move_to_end(item)
            surface.blit(*sprite)

    def repaint(
        self, surface: pygame.Surface, before: Sequence[DrawItem], after: Sequence[DrawItem]
    ) -> list[pygame.Rect]:
        """Turn a surface that shows `before` into `after`, drawing only where they differ; return these areas."""
        areas = _joined([_area(item) for item in set(before) ^ set(after)])
        for area in areas:
            surface.set_clip(area)
            self.paint(surface, [item for item in after if _area(item).colliderect(area)])
        surface.set_clip(None)
        return areas

    def _sprite(self, item: DrawItem) -> tuple[pygame.Surface, tuple[int, int]]:
        return self._text(item) if isinstance(item, Text) else _shape(item)

    def _font(self, size: int) -> pygame.font.Font:
        """Return pygame's own font, as `Font(None, size)` does."""
        import pygame

        return pygame.font.Font(io.BytesIO(self._typeface), max(1, int(FONT_SCALE * size)))

    def _text(self, item: Text) -> tuple[pygame.Surface, tuple[int, int]]:
        import pygame

        size = max(1, math.ceil(WORDS_SCALE * item.cap_px / CAP_PER_SIZE - 1e-6))
        font = self._fonts.get(size) or self._fonts.setdefault(size, self._font(size))
        large = font.render(item.text, True, item.colour)
        # Drawn large and scaled to the width the layout counts on: hinting would space small letters unevenly.
        width = round(text_width_px(item.text, item.cap_px))
        height = round(large.get_height() / WORDS_SCALE)
        drawn = pygame.transform.smoothscale(large, (max(1, width), max(1, height)))
        shift = {"l": 0.0, "c": 0.5, "r": 1.0}[item.anchor] * width
        # The line's top is one ascent above the baseline, or the dots of a capital Ä, which are higher than that; the
        # baseline is half a capital below the middle.
        highest = max((metrics[3] for metrics in font.metrics(item.text) if metrics), default=0)
        top = item.y + 0.5 * item.cap_px - max(font.get_ascent(), highest) / WORDS_SCALE
        return drawn, (round(item.x - shift), round(top))


@lru_cache(maxsize=4 * KEPT)
def _area(item: DrawItem) -> pygame.Rect:
    """Return the pixels that an item may touch, smoothed edges and letters below the line included."""
    import pygame

    box = bounds(item) if isinstance(item, Rect | Text) else _extent(item)
    margin = 3 + (math.ceil(0.5 * item.cap_px) if isinstance(item, Text) else 0)
    left, top = math.floor(box.x) - margin, math.floor(box.y) - margin
    return pygame.Rect(left, top, math.ceil(box.right) + margin - left, math.ceil(box.bottom) + margin - top)


def _joined(areas: Sequence[pygame.Rect]) -> list[pygame.Rect]:
    """Return areas that do not overlap and cover all the given ones."""
    apart: list[pygame.Rect] = []
    for area in areas:
        whole = area
        while (hit := whole.collidelist(apart)) >= 0:
            whole = whole.union(apart.pop(hit))
        apart.append(whole)
    return apart


def _rectangle(surface: pygame.Surface, item: Rect) -> None:
    import pygame

    left, top = round(item.box.x), round(item.box.y)
    area = pygame.Rect(left, top, round(item.box.right) - left, round(item.box.bottom) - top)
    radius = min(round(item.radius), area.w // 2, area.h // 2)
    if radius < 1:
        surface.fill(item.colour, area)
        return
    surface.fill(item.colour, area.inflate(-2 * radius, 0))
    surface.fill(item.colour, area.inflate(0, -2 * radius))
    disc = _disc(radius, item.colour)
    for column, x in enumerate((area.left, area.right - radius)):
        for row, y in enumerate((area.top, area.bottom - radius)):
            surface.blit(disc, (x, y), (column * radius, row * radius, radius, radius))


@lru_cache(maxsize=64)
def _disc(radius: int, colour: Colour) -> pygame.Surface:
    """Return a smooth disc, the source of rounded corners."""
    import pygame

    large = pygame.Surface((8 * radius, 8 * radius), pygame.SRCALPHA)
    large.fill((*colour, 0))
    pygame.draw.circle(large, colour, (4 * radius, 4 * radius), 4 * radius)
    return pygame.transform.smoothscale(large, (2 * radius, 2 * radius))


def _shape(item: Rect | Polygon | Arc) -> tuple[pygame.Surface, tuple[int, int]]:
    """Return a smooth picture of one shape and where it goes."""
    import pygame

    box = _extent(item)
    left, top = math.floor(box.x) - 1, math.floor(box.y) - 1
    width, height = math.ceil(box.right) + 2 - left, math.ceil(box.bottom) + 2 - top
    scale = 2 if max(width, height) > LARGE_PX else 4
    # Transparent pixels carry the shape's own colour, so that scaling down never darkens its edge.
    large = pygame.Surface((width * scale, height * scale), pygame.SRCALPHA)
    large.fill((*item.colour, 0))
    if isinstance(item, Rect):
        corner = Box((item.box.x - left) * scale, (item.box.y - top) * scale, item.box.w * scale, item.box.h * scale)
        line = max(1, round(item.line * scale))
        pygame.draw.rect(large, item.colour, tuple(round(value) for value in corner), line, round(item.radius * scale))
    else:
        points = item.points if isinstance(item, Polygon) else _arc_points(item)
        line = round(item.line * scale) if isinstance(item, Polygon) else 0
        pygame.draw.polygon(large, item.colour, [((x - left) * scale, (y - top) * scale) for x, y in points], line)
    return pygame.transform.smoothscale(large, (width, height)), (left, top)


def _extent(item: Rect | Polygon | Arc) -> Box:
    if isinstance(item, Arc):
        return bounds(Polygon(_arc_points(item), item.colour, item.role))
    return bounds(item)


def _arc_points(arc: Arc) -> tuple[tuple[float, float], ...]:
    steps = max(2, math.ceil((arc.end_deg - arc.start_deg) / ARC_STEP_DEG))
    clock = [arc.start_deg + (arc.end_deg - arc.start_deg) * step / steps for step in range(steps + 1)]
    rim = [at_clock(arc.cx, arc.cy, arc.outer, degrees) for degrees in clock]
    if arc.inner <= 0.0:
        return (*rim, (arc.cx, arc.cy)) if arc.end_deg - arc.start_deg < 360.0 else tuple(rim)
    return (*rim, *(at_clock(arc.cx, arc.cy, arc.inner, degrees) for degrees in reversed(clock)))


def render(shown: HudView, screen: Screen, painter: Painter | None = None) -> pygame.Surface:
    """Return a picture of `shown` on a surface of its own."""
    painter = painter or Painter()
    import pygame

    surface = pygame.Surface((screen.width_px, screen.height_px))
    painter.paint(surface, layout(shown, screen))
    return surface


def render_png(shown: HudView, path: Path, screen: Screen) -> None:
    """Write a picture of `shown` as PNG."""
    picture = render(shown, screen)
    import pygame

    pygame.image.save(picture, str(path))


def snapshot_png(
    snapshot: Snapshot,
    path: Path,
    profile: HudProfile | None = None,
    settings: HudSettings | None = None,
    age_s: float = 0.0,
) -> None:
    """Write the cluster as it shows `snapshot`, `age_s` old, as PNG."""
    shown, _ = view(snapshot, age_s, HudMemory(), settings or HudSettings())
    render_png(shown, path, screen_of(profile or HudProfile()))
