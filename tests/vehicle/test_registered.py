"""A vehicle of another package: installed beside us, driven, replayed, and refused where it is wrong."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.vehicle import OwnProfile
from simconsole.values.errors import ProfileError
from simconsole.values.platform import Ground, Platform, Pose
from simconsole.vehicle.platforms import build
from simconsole.vehicle.registered import OwnVehicle, build_own, registered
from tests.drives.console import simconsole as command
from tests.installed import installed as register

LEVEL = Ground(friction=1.0, slope_x=0.0, slope_y=0.0)
DRIVES = """
import sys
import simconsole
session = simconsole.load("bridge").with_values({"environment.world": None, "scenario.vehicle": sys.argv[1]})
drive = session.run(lambda seen: simconsole.hold_speed(6.0, 0.02), duration_s=10.0)
assert abs(drive.column("vehicle.vx_mps")[-1] - 6.0) < 0.5, drive.column("vehicle.vx_mps")[-1]
assert drive.column("vehicle.yaw_rad")[-1] > 0.1
own = [name for name in drive.columns if name.endswith(".speed_mps") and not name.startswith(("ros", "ecu"))]
assert (drive.column(own[0]) == drive.column("vehicle.vx_mps")).all(), own
assert drive.replay().hashes_equal
laden = session.with_values({"parameters.throttle_mps2": 1.0})
assert laden.run(lambda seen: simconsole.actuate(1.0, 0.0), duration_s=4.0).column("vehicle.vx_mps")[-1] < 4.0
print(drive.digest)
"""


def installed(folder: Path) -> None:
    register(folder, "simconsole.vehicles", quick="VEHICLE", wrong="PARAMETERS")


@pytest.mark.parametrize("compiled", [False, True], ids=["plain", "compiled"])
def test_a_vehicle_of_another_package_drives_and_replays(compiled: bool, tmp_path: Path) -> None:
    assert command("new", "platform", "quick", "--out", tmp_path).returncode == 0
    installed(tmp_path)
    source = tmp_path / "quick.py"
    if compiled:
        text = source.read_text().replace("compiled=False", "compiled=True")
        text = text.replace("def step(", "@stage\ndef step(")
        source.write_text(
            text.replace(
                "from simconsole.values.layout",
                "from simconsole.values.kernels import stage\nfrom simconsole.values.layout",
            )
        )
    program = f"import sys; sys.path.insert(0, {str(tmp_path)!r})\n{DRIVES}"
    words = [sys.executable, "-c", program, str(tmp_path / "quick.yaml")]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_what_is_not_registered_is_refused_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ProfileError, match="kind: value nobody: one of fmu"):
        build_own(OwnProfile(kind="nobody"), Pose(0.0, 0.0, 0.0), LEVEL)
    installed(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(ProfileError, match="kind: value quick: quick:VEHICLE: ModuleNotFoundError: No module named"):
        registered("quick")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("raise RuntimeError('no\\nlicence')", "quick:VEHICLE: RuntimeError: no licence"),
        ("def (", "quick:VEHICLE: SyntaxError: "),
        ("OTHER = 1", "quick:VEHICLE: AttributeError: "),
        ("VEHICLE = 1", "quick:VEHICLE: an OwnVehicle"),
    ],
)
def test_what_cannot_be_loaded_is_one_line(
    text: str, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    installed(tmp_path)
    (tmp_path / "quick.py").write_text(text)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "quick", raising=False)
    with pytest.raises(ProfileError, match=f"kind: value quick: {told}") as error:
        registered("quick")
    assert "\n" not in str(error.value)
    sys.modules.pop("quick", None)


def ball(**other: Any) -> Platform:
    return build(load_vehicle("ball"), Pose(0.0, 0.0, 0.0), LEVEL)._replace(**other)


def fails() -> Platform:
    raise KeyError("mass")


@pytest.mark.parametrize(
    ("built", "told"),
    [
        (fails, "KeyError: 'mass'"),
        (lambda: None, "NoneType: a Platform"),
        (lambda: ball(initial_state=(0.0,)), "initial_state: 1 values"),
        (lambda: ball(state=float), "state: a NamedTuple of floats"),
        (lambda: ball(initial_vehicle=(0.0,)), "initial_vehicle: a VehicleState"),
        (lambda: ball(parameters=np.zeros(3, dtype=int)), "parameters: a float64 array of one dimension"),
        (lambda: ball(wheelbase_m=0.0), "wheelbase_m: not above 0"),
    ],
)
def test_what_is_no_platform_is_one_line(built: Callable[[], Platform], told: str) -> None:
    own = OwnVehicle(parameters=None, build=lambda settings: built())
    with pytest.raises(ProfileError, match=rf"^vehicle: kind: value quick: {told}"):
        build_own(OwnProfile(kind="quick"), Pose(0.0, 0.0, 0.0), LEVEL, own)
