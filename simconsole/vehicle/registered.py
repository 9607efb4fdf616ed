"""Vehicles of other packages: found by the entry points `simconsole.vehicles`, their parameters inside bounds."""

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

from simconsole.profiles.vehicle import OwnProfile
from simconsole.values.platform import Ground, Platform, Pose
from simconsole.values.registered import Bounded as Bounded
from simconsole.values.registered import bounded_values, load, made
from simconsole.vehicle.contract import shape

GROUP: Final = "simconsole.vehicles"


class OwnSettings(NamedTuple):
    """What a vehicle is built from."""

    profile: OwnProfile
    parameters: Mapping[str, float]  # all of them, inside their bounds
    pose: Pose
    ground: Ground


class OwnVehicle(NamedTuple):
    """What an entry point names: a kind of vehicle."""

    parameters: Mapping[str, Bounded] | None  # None: it checks its own
    build: Callable[[OwnSettings], Platform]


def registered(kind: str) -> OwnVehicle:
    """Return the vehicle that is registered by that name.

    Raises:
        ProfileError: there is none, it cannot be loaded, or is no `OwnVehicle`.
    """
    return load(GROUP, kind, OwnVehicle, "vehicle: kind")


def build_own(profile: OwnProfile, pose: Pose, ground: Ground, vehicle: OwnVehicle | None = None) -> Platform:
    """Return a vehicle of another package, or `vehicle`, at rest at `pose`.

    Raises:
        ProfileError: there is none, a parameter is unknown or out of its bounds, or what is built is no platform.
    """
    own = registered(profile.kind) if vehicle is None else vehicle
    values = dict(profile.parameters)
    if own.parameters is not None:
        values = bounded_values(own.parameters, values, "vehicle: parameters")
    settings = OwnSettings(profile, values, pose, ground)
    return made(lambda: own.build(settings), shape, f"vehicle: kind: value {profile.kind}")
