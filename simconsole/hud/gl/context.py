"""OpenGL contexts: one without any window, and what is known of the one that draws."""

from typing import TYPE_CHECKING, Any, Final

from simconsole.values.errors import WorkerError

if TYPE_CHECKING:
    import moderngl

_EGL: Final[dict[str, Any]] = {"backend": "egl"}
OPENGL: Final = 330
SOFTWARE: Final = ("llvmpipe", "softpipe", "swiftshader", "software")
"""Names of renderers that run on the processor (Mesa, Chromium)."""


def windowless_context() -> "moderngl.Context":
    """Return a context that draws into memory, by EGL: needs no display and no window system.

    Raises:
        WorkerError: this machine has no EGL, or none that speaks OpenGL 3.3.
    """
    import moderngl

    try:
        return moderngl.create_context(standalone=True, require=OPENGL, **_EGL)
    except Exception as problem:  # noqa: BLE001 glcontext raises bare Exception
        raise WorkerError(f"driver's view: no OpenGL 3.3 without a window here: {problem}") from None


def context_of_window() -> "moderngl.Context":
    """Return the context that a window has just made current, by EGL, GLX or whatever it uses.

    Raises:
        RuntimeError: none is current.
        ValueError: it does not speak OpenGL 3.3.
    """
    import moderngl

    moderngl.init_context()  # anew: moderngl keeps the first one it meets, and that window may be gone
    context = moderngl.get_context()
    if context.version_code < OPENGL:
        raise ValueError(f"OpenGL {context.version_code / 100:.1f}, at least {OPENGL / 100:.1f} is needed")
    return context


def renderer_name(context: "moderngl.Context") -> str:
    """Return what draws, as the driver names itself."""
    return str(context.info["GL_RENDERER"])


def is_software(context: "moderngl.Context") -> bool:
    """Return whether the processor draws: then pictures are kept cheap."""
    name = renderer_name(context).lower()
    return any(word in name for word in SOFTWARE)
