"""Worlds that tests make."""

from typing import Any

from simconsole.profiles.files.world_files import load_world
from simconsole.world.kinds.worlds import open_world
from simconsole.world.world import World


def world(**changes: Any) -> World:
    """Return the arena, made anew, with something changed."""
    found = World("quick", open_world(load_world("arena")).route, lambda: open_world(load_world("arena")).drawing)
    for name, value in changes.items():
        setattr(found, name, value)
    return found
