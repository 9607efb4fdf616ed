"""One unit: another file than the recorded one and a unit that cannot begin are refused."""

import hashlib
from pathlib import Path
from typing import Literal

import pytest

from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.vehicle import OwnProfile
from simconsole.values.errors import ProfileError, VehicleError
from simconsole.values.platform import Ground, Pose
from simconsole.vehicle.fmu.unit import Unit
from simconsole.vehicle.platforms import build as build_platform
from tests.vehicle.fmu.building import build

INPUTS, OUTPUTS = ("delta", "throttle", "brake"), ("v", "r")
Version = Literal[2, 3]


@pytest.mark.parametrize("version", [2, 3])
def test_a_unit_that_cannot_begin_or_go_on_says_when_and_begins_again(version: Version, tmp_path: Path) -> None:
    file = build(tmp_path, version).with_suffix(".fmu")
    unit = Unit(str(file), hashlib.sha256(file.read_bytes()).hexdigest(), INPUTS, OUTPUTS)
    with pytest.raises(VehicleError, match=rf"^{file}: at 0 ms: "):
        unit.begin({"v0": -1.0})
    assert unit.begin({"v0": 20.0}) == [20.0, 0.0]
    with pytest.raises(VehicleError, match=rf"^{file}: at 4 ms: v: value nan: a finite number$"):
        unit.step(0.0, 0.004, (0.0, 0.0, 4.0))
    assert unit.begin({"v0": 15.0}) == [15.0, 0.0]


def test_another_file_than_the_recorded_one_is_refused(tmp_path: Path) -> None:
    recorded = load_vehicle(str(build(tmp_path, 2)))
    assert isinstance(recorded, OwnProfile)
    pose, level = Pose(0.0, 0.0, 0.0), Ground(friction=1.0, slope_x=0.0, slope_y=0.0)
    file = tmp_path / "car2.fmu"
    with file.open("ab") as added:
        added.write(b"more")
    with pytest.raises(ProfileError, match="another file than when the drive was recorded"):
        build_platform(recorded, pose, level)
    file.unlink()
    with pytest.raises(ProfileError, match=f"{file}: No such file or directory"):
        build_platform(recorded, pose, level)
