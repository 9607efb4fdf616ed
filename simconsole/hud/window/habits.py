"""How the driver's window was last left: display, full screen, vsync and size, remembered from drive to drive.

The profile says how a window first opens. What a person then changes by key or mouse wins, until the profile itself is
changed.
"""

import os
import sys
from pathlib import Path
from typing import Annotated, Final

import msgspec
from msgspec import Meta, Struct

from simconsole.profiles.view import HudProfile
from simconsole.values.host.files import write_atomically

STATE_FILE: Final = Path("simconsole") / "window.json"
Pixels = Annotated[int, Meta(ge=1, le=16384)]


class Habits(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How a window stands."""

    display: Annotated[int, Meta(ge=0, le=15)] = 0
    fullscreen: bool = False
    vsync: bool = True
    size_px: tuple[Pixels, Pixels] | None = None
    """Of the window when it is not full screen; None: as the profile and the display allow."""


class _State(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The state file: what the profile said then, and how the window was left."""

    profile: str
    habits: Habits


def state_folder() -> Path:
    """Return where programs of this user keep their state (XDG base directories: `XDG_STATE_HOME`)."""
    return Path(os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state")


def habits_of(profile: HudProfile) -> Habits:
    """Return how a window of a profile first opens."""
    return Habits(display=profile.display, fullscreen=profile.fullscreen, vsync=profile.vsync)


class HabitsFile:
    """Keeps how the window was left. A file that cannot be read or written only costs the memory of it."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def load(self, profile: HudProfile) -> Habits:
        """Return how a window of this profile was left, or how it first opens."""
        try:
            state = msgspec.json.decode(self._path.read_bytes(), type=_State)
        except (OSError, msgspec.DecodeError):
            return habits_of(profile)
        return state.habits if state.profile == _said(profile) else habits_of(profile)

    def save(self, profile: HudProfile, habits: Habits) -> None:
        """Remember how the window stands now."""
        state = _State(profile=_said(profile), habits=habits)
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            write_atomically(self._path, msgspec.json.encode(state), durable=False)
        except OSError as problem:
            print(f"hud: {self._path}: not remembered: {problem.strerror}", file=sys.stderr)


def _said(profile: HudProfile) -> str:
    """Return what of a profile a person can change at the window."""
    return f"{profile.width_px}x{profile.height_px} {profile.display} {profile.fullscreen} {profile.vsync}"
