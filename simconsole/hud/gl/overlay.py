"""Lays parts of a pygame surface over the scene: instruments and messages, opaque, pixel for pixel."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from simconsole.hud.draw import Box
from simconsole.hud.gl.programs import OVERLAY_FRAGMENT, OVERLAY_VERTEX

if TYPE_CHECKING:
    import moderngl
    import pygame


class Overlay:
    """A picture as large as the window, of which chosen rectangles hide the scene."""

    def __init__(self, context: "moderngl.Context", surface: "pygame.Surface") -> None:
        """Take a 32-bit surface; what is painted on it later is sent by `update`."""
        import moderngl

        self._context, self._surface = context, surface
        program = context.program(vertex_shader=OVERLAY_VERTEX, fragment_shader=OVERLAY_FRAGMENT)
        corners = np.array(((-1.0, -1.0), (3.0, -1.0), (-1.0, 3.0)), dtype="<f4")
        self._whole = context.vertex_array(program, [(context.buffer(corners.tobytes()), "2f4", "in_place")])
        self._texture = context.texture(surface.get_size(), 4)
        self._texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._texture.swizzle = "BGRA"  # the byte order of pygame's 32-bit surfaces on little-endian machines
        self.update([surface.get_rect()])

    def update(self, areas: "Sequence[pygame.Rect]") -> None:
        """Send the parts of the surface that were painted anew."""
        bounds = self._surface.get_rect()
        for area in areas:
            part = area.clip(bounds)
            if part.w and part.h:
                pixels = self._surface.subsurface(part).copy().get_buffer().raw
                self._texture.write(pixels, viewport=(part.x, part.y, part.w, part.h))

    def draw(self, target: "moderngl.Framebuffer", boxes: Sequence[Box]) -> None:
        """Lay these rectangles of the surface over `target`."""
        import moderngl

        width, height = target.size
        target.use()
        self._context.disable(moderngl.DEPTH_TEST)
        self._texture.use(0)
        for box in boxes:
            left, top = max(0, round(box.x)), max(0, round(box.y))
            right, bottom = min(width, round(box.right)), min(height, round(box.bottom))
            if right > left and bottom > top:
                target.scissor = (left, height - bottom, right - left, bottom - top)
                self._whole.render(vertices=3)
        target.scissor = (0, 0, width, height)

    def release(self) -> None:
        """Give its memory on the card back."""
        self._texture.release()
