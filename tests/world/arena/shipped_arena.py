"""The arena that is shipped, as its profile."""

from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import ArenaProfile


def arena() -> ArenaProfile:
    profile = load_world("arena")
    assert isinstance(profile, ArenaProfile)
    return profile
