"""An FMU as a vehicle: it follows the closed form of its model, begins again, and its drive replays."""

from argparse import Namespace
from pathlib import Path
from typing import Literal

import numpy as np
import pytest

import simconsole
from simconsole.cli.recordings import replay
from simconsole.evaluation.report.exports import REPORT, write_exports
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.verification import examine
from simconsole.values.errors import ProfileError, VehicleError
from simconsole.values.kernels import Row
from simconsole.values.layout import read, write
from simconsole.values.platform import Ground, Platform, Pose
from simconsole.values.signals import VehicleCommand
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.platforms import build as build_platform
from tests.bits import difference
from tests.vehicle.fmu.building import build

V, M, IZ, LF, LR, CF, CR = 20.0, 1200.0, 1800.0, 1.2, 1.4, 90000.0, 110000.0
LEVEL = Ground(friction=1.0, slope_x=0.0, slope_y=0.0)
DELTA_RAD = 0.02
SUBSTEPS = 4
Version = Literal[2, 3]


def closed_form(times_s: np.ndarray) -> np.ndarray:
    """Return lateral velocity of the centre of gravity and yaw rate [n, 2] after a step of the road wheels.

    x' = A x + b delta from rest: x = A^-1 (e^(A t) - 1) b delta, by the eigenvectors of A.
    """
    a = np.array([[-(CF + CR) / (M * V), (CR * LR - CF * LF) / (M * V) - V], [(CR * LR - CF * LF) / (IZ * V), 0.0]])
    a[1, 1] = -(CF * LF**2 + CR * LR**2) / (IZ * V)
    b = np.array([CF / M, CF * LF / IZ]) * DELTA_RAD
    values, vectors = np.linalg.eig(a)
    part = np.linalg.solve(vectors, b.astype(complex))
    grown = (np.exp(np.outer(times_s, values)) - 1.0) / values * part
    return np.real(grown @ vectors.T)


def platform(profile: Path) -> Platform:
    return build_platform(load_vehicle(str(profile)), Pose(0.0, 0.0, 0.0), LEVEL)


def beginning(on: Platform) -> Row:
    row = np.zeros(PLATFORM_AT + len(on.initial_state))
    write(row, LAYOUT.vehicle, on.initial_vehicle)
    row[PLATFORM_AT:] = on.initial_state
    return row


def tick(on: Platform, before: Row, road_wheel_rad: float, brake: float = 0.0) -> Row:
    row = before.copy()
    command = VehicleCommand(*(0.0,) * len(LAYOUT.command.names))
    command = command._replace(road_wheel_rad=road_wheel_rad, brake=brake)
    write(row, LAYOUT.command, command)
    on.step(before, row, on.parameters, on.ground, SUBSTEPS)
    return row


@pytest.mark.parametrize("version", [2, 3])
def test_it_follows_the_closed_form_of_the_linear_single_track_car(version: Version, tmp_path: Path) -> None:
    on = platform(build(tmp_path, version))
    assert not on.exact
    rows = [beginning(on)]
    for _ in range(500):
        rows.append(tick(on, rows[-1], DELTA_RAD))
    seen = [read(row, LAYOUT.vehicle) for row in rows]
    expected = closed_form(np.arange(501) * SUBSTEPS * 0.001)
    lateral = np.array([one.vy_mps + LR * one.yaw_rate_radps for one in seen])
    rate = np.array([one.yaw_rate_radps for one in seen])
    assert np.abs(lateral - expected[:, 0]).max() < 1e-6
    assert np.abs(rate - expected[:, 1]).max() < 1e-6
    assert rate[-1] > 0.1
    assert seen[-1].x_m == pytest.approx(40.0, abs=2.0)
    assert seen[-1].yaw_rad == pytest.approx(float(np.trapezoid(rate, dx=0.004)), abs=1e-9)


@pytest.mark.parametrize("version", [2, 3])
def test_a_tick_that_is_made_again_is_the_same(version: Version, tmp_path: Path) -> None:
    on = platform(build(tmp_path, version))
    rows = [beginning(on)]
    for number in range(20):
        rows.append(tick(on, rows[-1], 0.001 * number))
    again = tick(on, rows[7], 0.007)
    assert not difference(again, rows[8])
    first = tick(on, rows[0], 0.0)
    assert not difference(first, rows[1])


@pytest.mark.parametrize("version", [2, 3])
def test_its_drive_replays_and_says_that_it_is_not_exact(version: Version, tmp_path: Path) -> None:
    profile = build(tmp_path, version, speed_mps=0.0)
    session = simconsole.load("bridge").with_values({"environment.world": None, "scenario.vehicle": str(profile)})
    drive = session.run(lambda seen: simconsole.actuate(0.5, 0.0, 0.02), duration_s=6.0)
    assert drive.column("vehicle.vx_mps")[-1] > 3.0
    assert drive.column("vehicle.yaw_rad")[-1] > 0.01
    assert "fmu.steps" in drive.columns or any(name.endswith("steps") for name in drive.columns)
    assert drive.replay().hashes_equal
    assert open_bundle(drive.folder).manifest.summary["bit_exact"] is False
    told = f"{drive.folder}: not bit-exact: its vehicle is foreign machine code; on another machine hashes may differ"
    assert examine(drive.folder).remarks == [told]
    again = replay(Namespace(bundle=str(drive.folder), set=None, out=None, tolerances=None))
    assert (again.code, again.results["bit_exact"]) == (0, False)
    assert told in again.text.splitlines()
    write_exports(drive.folder, report=True, scene=False)
    assert "<tr><th>bit exact</th><td>False</td></tr>" in (drive.folder / REPORT).read_text()


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("delta", "angle", "no variable angle: one of brake, delta"),
        ("vx_mps:", "wings_m:", "names: wings_m: a field of VehicleCommand or VehicleState"),
        ("v0", "mass", "no variable mass"),
        ("kind: fmu", "kind: nothing", "kind: value nothing: one of fmu"),
        ("file: car2.fmu", "file: car2.so", "no FMU"),
        ("file: car2.fmu\n", "", "file: value missing"),
    ],
)
def test_what_cannot_be_used_is_refused(before: str, after: str, told: str, tmp_path: Path) -> None:
    profile = build(tmp_path, 2)
    text = profile.read_text()
    assert before in text
    profile.write_text(text.replace(before, after, 1))
    with pytest.raises(ProfileError, match=told):
        platform(profile)


@pytest.mark.parametrize("version", [2, 3])
def test_a_unit_that_fails_ends_the_drive_with_one_line(version: Version, tmp_path: Path) -> None:
    profile = build(tmp_path, version)
    on = platform(profile)
    first = beginning(on)
    second = tick(on, first, 0.0)
    for brake, told in ((2.0, "at 4 ms: .*"), (4.0, "at 8 ms: v: value nan: a finite number")):
        with pytest.raises(VehicleError, match=rf"^{profile.with_suffix('.fmu')}: {told}") as error:
            tick(on, second, 0.0, brake)
        assert "\n" not in str(error.value)
    like = platform(profile)
    expected = tick(like, tick(like, first, 0.0), 0.001)
    assert not difference(tick(on, second, 0.001), expected), "from where it was before it failed"
