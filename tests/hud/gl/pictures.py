"""Real pictures by EGL, as arrays: rows from the top."""

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from simconsole.hud.gl.context import windowless_context

if TYPE_CHECKING:
    import moderngl

Pixels = NDArray[np.uint8]


@cache
def _made() -> "moderngl.Context":
    return windowless_context()


def context() -> "moderngl.Context":
    """The one context of all pictures, current again if a window was opened since."""
    _made().mglo.__enter__()  # what `with context:` begins with: makes it current
    return _made()


def target(width_px: int, height_px: int) -> "moderngl.Framebuffer":
    return context().simple_framebuffer((width_px, height_px), components=3)


def pixels(framebuffer: "moderngl.Framebuffer") -> Pixels:
    """Return what was drawn, uint8 [height, width, 3]."""
    width, height = framebuffer.size
    data = np.frombuffer(framebuffer.read(components=3, alignment=1), np.uint8)
    return data.reshape(height, width, 3)[::-1]
