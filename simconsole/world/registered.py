"""Worlds of other packages: found by the entry points `simconsole.worlds`, their parameters inside bounds."""

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

from simconsole.profiles.world import OwnWorldProfile
from simconsole.values.registered import Bounded, bounded_values, load, made
from simconsole.world.contract import shape
from simconsole.world.world import World

GROUP: Final = "simconsole.worlds"


class WorldSettings(NamedTuple):
    """What a world is made from."""

    profile: OwnWorldProfile
    parameters: Mapping[str, float]  # all of them, inside their bounds


class OwnWorld(NamedTuple):
    """What an entry point names. Equal settings must make equal worlds, or recorded drives do not replay."""

    parameters: Mapping[str, Bounded]
    make: Callable[[WorldSettings], World]


def make_own(profile: OwnWorldProfile, own: OwnWorld | None = None) -> World:
    """Return a world of another package, or of `own`.

    Raises:
        ProfileError: there is none, a parameter is unknown or out of its bounds, or what is made is no world.
    """
    made_by = load(GROUP, profile.name, OwnWorld, "world: name") if own is None else own
    values = bounded_values(made_by.parameters, profile.parameters, "world: parameters")
    settings = WorldSettings(profile, values)
    return made(lambda: made_by.make(settings), shape, f"world: name: value {profile.name}")
