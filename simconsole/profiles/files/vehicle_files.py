"""Read a vehicle's profile with the tyre file that it names."""

import hashlib

import msgspec

from simconsole.profiles.files.loader import MAX_DATA_BYTES, find, load, read_beside, read_bytes
from simconsole.profiles.tyre import parse_tir
from simconsole.profiles.vehicle import CarProfile, OwnProfile, VehicleProfile


def load_vehicle(name_or_path: str) -> VehicleProfile:
    """Return the profile, its tyre's coefficients filled in: so a recorded profile contains the tyre.

    Of an FMU it contains where it lies, and its checksum.

    Raises:
        ProfileError: the profile or its tyre file cannot be used; names file and key.
    """
    profile: VehicleProfile = load("vehicles", name_or_path, VehicleProfile)  # type: ignore[arg-type]  # a union
    if isinstance(profile, OwnProfile) and profile.file is not None:
        file = (find("vehicles", name_or_path).parent / profile.file).resolve()
        digest = hashlib.sha256(read_bytes(file, MAX_DATA_BYTES)).hexdigest()
        return msgspec.structs.replace(profile, file=str(file), file_sha256=digest)
    if not isinstance(profile, CarProfile) or profile.tyre is None or profile.tyre.coefficients:
        return profile
    path = find("vehicles", name_or_path)
    name = profile.tyre.tir
    values = parse_tir(read_beside("tyre", name, path), str(path.parent / name))
    return msgspec.structs.replace(profile, tyre=msgspec.structs.replace(profile.tyre, coefficients=values))
