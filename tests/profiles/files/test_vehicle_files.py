"""A vehicle and the tyre file that it names."""

import shutil
from pathlib import Path

import msgspec
import pytest

from simconsole.profiles.files.loader import profiles_folder
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.tyre import parse_tir
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.errors import ProfileError

FOLDER = profiles_folder() / "vehicles"
TEXT = (FOLDER / "tyres" / "example.tir").read_text()
EXAMPLE = parse_tir(TEXT, "example.tir")


def test_a_vehicle_names_its_tyre_and_keeps_it_when_recorded(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    shutil.copy(FOLDER / "tyres" / "example.tir", tmp_path / "mine.tir")
    shipped = (FOLDER / "hatchback.yaml").read_text()
    path.write_text(shipped + "tyre: {tir: mine.tir}\n")
    profile = load_vehicle(str(path))
    assert isinstance(profile, CarProfile)
    assert profile.tyre is not None
    assert profile.tyre.coefficients == EXAMPLE
    assert msgspec.convert(msgspec.to_builtins(profile), CarProfile) == profile
    (tmp_path / "mine.tir").unlink()
    for name in ("mine.tir", "../mine.tir"):
        path.write_text(shipped + f"tyre: {{tir: {name}}}\n")
        with pytest.raises(ProfileError, match=r"tyre profile: value '.*mine.tir'"):
            load_vehicle(str(path))
