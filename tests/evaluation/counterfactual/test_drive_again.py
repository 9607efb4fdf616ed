"""A recorded drive with one thing changed: what may change, what stays, and that it is a drive like any other."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.counterfactual.drive_again import OPEN_LOOP, changes_of, drive_again
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session, replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.errors import ProfileError, RecordingError

HANDS_OVER = """\
schema: 1
environment: {world: urban_signals, traffic: {vehicles: 3, parked: 0, pedestrians: 0}}
scenario: {vehicle: hatchback, duration_s: 14}
features: {autopilot: urban_signals}
outputs: {hud: null, scene: null, report: false, bridge: {port: 0}}
devices:
  driver: virtual
  person: {sit_s: 0.5, cruise_kmh: 15, top_gear: 2, autonomy: {distance_m: 5}, take_back: {distance_m: 20}}
mode: {pacing: lockstep, answer_timeout_s: 60}
"""


def test_a_heavier_car_gains_speed_more_slowly_by_the_same_pedals(short: Path, tmp_path: Path) -> None:
    again = drive_again(short, {"body.mass_kg": 1900}, tmp_path / "heavy")
    before, after = open_bundle(short).log.table(), open_bundle(again.folder).log.table()
    assert (before.ticks == after.ticks).all()
    inputs = open_bundle(short).log.header.input_columns
    assert (before.vectors[:, :inputs] == after.vectors[:, :inputs]).all()
    at_2_s = 500
    assert after.column("vehicle.vx_mps")[at_2_s] < before.column("vehicle.vx_mps")[at_2_s] - 0.1
    fields = {difference.field for difference in again.changed.differences}
    assert "vehicle.vx_mps" in fields
    assert not any(field.startswith(("sample.", "ros.", "events.")) for field in fields)
    assert again.unchanged.equal


def test_the_new_drive_is_a_bundle_like_any_other_and_says_what_it_is(short: Path, tmp_path: Path) -> None:
    again = drive_again(short, {"body.mass_kg": 1600, "environment.friction": 0.5}, tmp_path / "again")
    bundle = open_bundle(again.folder)
    session = recorded_session(bundle)
    assert (getattr(session.vehicle, "body").mass_kg, session.session.environment.friction) == (1600.0, 0.5)  # noqa: B009
    assert verify(again.folder) == []
    assert replay_bundle(again.folder).hashes_equal
    notes = bundle.manifest.provenance.notes
    of = open_bundle(short).manifest.digest
    assert notes == (f"counterfactual of {of}: body.mass_kg=1600, environment.friction=0.5", OPEN_LOOP)


def test_the_same_value_is_the_same_drive(short: Path, tmp_path: Path) -> None:
    body = getattr(recorded_session(open_bundle(short)).vehicle, "body")  # noqa: B009
    again = drive_again(short, {"body.mass_kg": body.mass_kg}, tmp_path / "again")
    assert again.changed.differences == ()
    assert open_bundle(again.folder).manifest.digest == open_bundle(short).manifest.digest


def test_a_hand_over_is_changed_by_its_control_profile_and_keeps_what_operators_said(tmp_path: Path) -> None:
    """Of a person among other cars who hands over and takes back."""
    (tmp_path / "session.yaml").write_text(HANDS_OVER)
    driven = drive(resolve(load_session(str(tmp_path / "session.yaml"))), tmp_path / "bundle").folder
    again = drive_again(driven, {"features.control.fade_s": 2.0}, tmp_path / "slow")
    before, after = open_bundle(driven).log, open_bundle(again.folder).log
    assert [stream.name for stream in before.header.streams] == ["state", "acts", "road_users"]
    assert before.header.streams[1:] == after.header.streams[1:]
    share = "arbitration.remote_lateral"
    between = [
        np.count_nonzero((values > 0.0) & (values < 1.0))
        for values in (log.table([share]).column(share) for log in (before, after))
    ]
    assert between[1] > 2 * between[0]


@pytest.mark.parametrize(
    "key",
    [
        "mode.tick_hz",
        "outputs.bridge.link.delay_ms",
        "devices.driver",
        "environment.world",
        "environment.traffic.seed",
        "scenario.vehicle",
        "scenario.faults",
        "features.autopilot",
    ],
)
def test_what_would_change_nothing_is_refused(key: str, short: Path, tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match=rf"--set {key}: inputs are recorded"):
        drive_again(short, {key: 1}, tmp_path / "again")
    assert not (tmp_path / "again").exists()


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"body.mass_kg": -1}, r"--set: vehicle: body\.mass_kg: value -1: a number from 300 to 5000"),
        ({"body.mas_kg": 1600}, r"mas_kg: value 1600: unknown key, did you mean mass_kg"),
        ({"environment.friction": 9}, r"environment\.friction: value 9"),
        ({}, "nothing is changed"),
    ],
)
def test_a_wrong_value_leaves_nothing_behind(values: dict[str, object], said: str, short: Path, tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match=said):
        drive_again(short, values, tmp_path / "again")
    assert not (tmp_path / "again").exists()


def test_a_folder_that_is_not_empty_is_left_alone(short: Path, tmp_path: Path) -> None:
    shutil.copytree(short, tmp_path / "taken")
    before = sorted(path.name for path in (tmp_path / "taken").iterdir())
    with pytest.raises(RecordingError, match="taken"):
        drive_again(short, {"body.mass_kg": 1600}, tmp_path / "taken")
    assert sorted(path.name for path in (tmp_path / "taken").iterdir()) == before


def test_values_are_read_as_in_a_profile() -> None:
    assert changes_of(["body.mass_kg=1600", "a.b=true", "c=[1, 2.5]", "d=x=y"]) == {
        "body.mass_kg": 1600,
        "a.b": True,
        "c": [1, 2.5],
        "d": "x=y",
    }
    for wrong in ("body.mass_kg", "=1", "body.mass_kg="):
        with pytest.raises(ProfileError, match="KEY=VALUE"):
            changes_of([wrong])
