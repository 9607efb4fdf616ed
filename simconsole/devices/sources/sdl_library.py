"""The one SDL that pygame has loaded, for ctypes: loading a library by name would give a second, separate SDL."""

import ctypes
import sys
from functools import cache
from pathlib import Path
from typing import Any

from simconsole.values.errors import DeviceError


def loaded_sdl() -> str:
    """Return the path of the SDL that this process has loaded: pygame's own.

    Linux says itself what is mapped. Elsewhere it is where the wheels of pygame-ce carry it; loading a library again
    by the same path gives the same one there.

    Raises:
        DeviceError: there is none.
    """
    maps = Path("/proc/self/maps")
    if sys.platform == "linux" and maps.exists():
        found = (line.split(maxsplit=5)[-1] for line in maps.read_text().splitlines())
        pattern = "libSDL2-2"
    else:
        import pygame

        folder = Path(pygame.__file__).parent
        found = (
            str(path) for path in (folder / "SDL2.dll", *sorted(folder.glob(".dylibs/libSDL2-2*"))) if path.exists()
        )
        pattern = "SDL2.dll" if sys.platform == "win32" else "libSDL2-2"
    for path in found:
        if Path(path).name.startswith(pattern):
            return path
    raise DeviceError("SDL: library: value not found: a pygame-ce that carries SDL 2")


def joystick_path(instance_id: int) -> str:
    """Return how the system calls an open joystick; empty where SDL does not tell. Never raises.

    Linux: its device file. Windows: its device interface, which holds the port.
    """
    library = _library()
    if library is None:
        return ""
    path = library.SDL_JoystickPath(library.SDL_JoystickFromInstanceID(instance_id))
    return "" if path is None else str(path.decode(errors="replace"))


@cache
def _library() -> Any | None:
    try:
        library = ctypes.CDLL(loaded_sdl())
        library.SDL_JoystickFromInstanceID.argtypes = (ctypes.c_int32,)
        library.SDL_JoystickFromInstanceID.restype = ctypes.c_void_p
        library.SDL_JoystickPath.argtypes = (ctypes.c_void_p,)
        library.SDL_JoystickPath.restype = ctypes.c_char_p
    except (DeviceError, OSError, AttributeError):  # no SDL of pygame's, or one before 2.24
        return None
    return library
