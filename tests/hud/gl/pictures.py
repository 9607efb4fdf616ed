"""Real pictures by EGL, as arrays: rows from the top."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from simconsole.hud.gl.context import windowless_context

if TYPE_CHECKING:
    import moderngl

Pixels = NDArray[np.uint8]


_contexts: "list[moderngl.Context]" = []


def context() -> "moderngl.Context":
    """The context of all pictures, current; another one if SDL has closed the display that both drew on."""
    if not _contexts or not _is_alive(_contexts[-1]):
        _contexts.append(windowless_context())
        _contexts[-1].gc_mode = "auto"  # pictures of hundreds of tests are freed as Python frees what drew them
    return _contexts[-1]


def _is_alive(made: "moderngl.Context") -> bool:
    import moderngl

    made.mglo.__enter__()  # what `with context:` begins with: makes it current
    try:
        made.program(vertex_shader="#version 330\nvoid main() { gl_Position = vec4(0.0); }").release()
    except moderngl.Error:
        return False
    return True


def target(width_px: int, height_px: int) -> "moderngl.Framebuffer":
    return context().simple_framebuffer((width_px, height_px), components=3)


def pixels(framebuffer: "moderngl.Framebuffer") -> Pixels:
    """Return what was drawn, uint8 [height, width, 3]."""
    width, height = framebuffer.size
    data = np.frombuffer(framebuffer.read(components=3, alignment=1), np.uint8)
    return data.reshape(height, width, 3)[::-1]
