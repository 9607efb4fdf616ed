"""Read a vehicle's profile with the tyre file that it names."""

import msgspec

from simconsole.profiles.files.loader import find, load, read_beside
from simconsole.profiles.tyre import parse_tir
from simconsole.profiles.vehicle import CarProfile, VehicleProfile


def load_vehicle(name_or_path: str) -> VehicleProfile:
    """Return the profile, its tyre's coefficients filled in: so a recorded profile contains the tyre.

    Raises:
        ProfileError: the profile or its tyre file cannot be used; names file and key.
    """
    profile: VehicleProfile = load("vehicles", name_or_path, VehicleProfile)  # type: ignore[arg-type]  # a union
    if not isinstance(profile, CarProfile) or profile.tyre is None or profile.tyre.coefficients:
        return profile
    path = find("vehicles", name_or_path)
    name = profile.tyre.tir
    values = parse_tir(read_beside("tyre", name, path), str(path.parent / name))
    return msgspec.structs.replace(profile, tyre=msgspec.structs.replace(profile.tyre, coefficients=values))
