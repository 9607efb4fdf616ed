"""OpenGL contexts: one without any window, and what is known of the one that draws."""

from typing import TYPE_CHECKING, Any, Final

from simconsole.values.errors import WorkerError

if TYPE_CHECKING:
    import moderngl

_EGL: Final[dict[str, Any]] = {"backend": "egl"}
SOFTWARE: Final = ("llvmpipe", "softpipe", "swiftshader", "software")
"""Names of renderers that run on the processor (Mesa, Chromium)."""


def windowless_context() -> "moderngl.Context":
    """Return a context that draws into memory, by EGL: needs no display and no window system.

    Raises:
        WorkerError: this machine has no EGL, or none that speaks OpenGL 3.3.
    """
    import moderngl

    try:
        return moderngl.create_context(standalone=True, require=330, **_EGL)
    except Exception as problem:  # noqa: BLE001 glcontext raises bare Exception
        raise WorkerError(f"driver's view: no OpenGL 3.3 without a window here: {problem}") from None


def renderer_name(context: "moderngl.Context") -> str:
    """Return what draws, as the driver names itself."""
    return str(context.info["GL_RENDERER"])


def is_software(context: "moderngl.Context") -> bool:
    """Return whether the processor draws: then pictures are kept cheap."""
    name = renderer_name(context).lower()
    return any(word in name for word in SOFTWARE)
