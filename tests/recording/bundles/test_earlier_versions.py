"""Bundles that earlier versions recorded: what has not changed since replays to the last bit; of a car, which has, the
inputs are the same, and what differs is said field by field.

Those in tests/recording/earlier have logs of schema 1: a person who hands over to the autopilot, a light van in two
bends, and a ball that a program rolls.
"""

import json
import shutil
from pathlib import Path

import pytest

from simconsole.cli.main import main
from simconsole.recording.bundles import replay_bundle as replaying
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.compare import compare
from simconsole.values.host import jit
from simconsole.vehicle.car import tyre
from tests.paths import ROOT

EARLIER = sorted((ROOT / "tests" / "recording" / "earlier").iterdir())
LARGEST_BYTES = 1_000_000


def named(name: str) -> Path:
    return next(folder for folder in EARLIER if folder.name == name)


def test_a_vehicle_that_has_not_changed_replays_to_the_last_bit() -> None:
    folder = named("ball")
    found = replay_bundle(folder)
    assert found.good, found.problems
    assert found.equal, found.differences  # in every column that both have; its hashes cover new ones, too
    assert found.missing == ()
    assert found.ticks >= 400


@pytest.mark.parametrize("name", ["hand_over", "light_van"])
def test_a_car_that_has_changed_takes_the_same_inputs_and_says_what_differs(name: str) -> None:
    folder = named(name)
    found = replay_bundle(folder)
    assert found.problems == ()
    assert found.ticks == open_bundle(folder).manifest.ticks
    assert {name.partition(".")[0] for name in found.missing} <= {"platform"}, "only the car's own columns may go"
    inputs = ("sample.", "ros.", "events.", "ecu.", "driver.")
    fields = {difference.field for difference in found.differences}
    assert fields
    assert not any(field.startswith(inputs) for field in fields), "the inputs are given"
    assert {field.partition(".")[0] for field in fields} >= {"vehicle", "platform"}


@pytest.mark.parametrize("folder", EARLIER, ids=lambda folder: folder.name)
def test_a_bundle_of_an_earlier_version_is_whole_and_small(folder: Path) -> None:
    assert verify(folder) == []
    assert b'"schema":1' in (folder / "drive.log").read_bytes()[:16_384]
    assert sum(path.stat().st_size for path in folder.iterdir()) < LARGEST_BYTES
    moved_m = open_bundle(folder).log.table(("vehicle.distance_m",)).vectors[-1, 0]
    assert moved_m > 5.0, "something happens in it"


def test_a_bundle_of_an_earlier_version_is_compared_with_another() -> None:
    folder = named("light_van")
    first, second = open_bundle(folder), open_bundle(named("hand_over"))
    assert compare(first.log, first.log).equal
    found = compare(first.log, second.log)
    assert (found.equal, found.ticks, found.only_first, found.only_second) == (False, 400, (), ())
    assert found.reason.startswith("only 400 ticks could be compared")


def test_a_changed_constant_of_the_tyre_is_told_by_its_fields(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The same inputs under another law: what differs, since when and how far, to the end of the drive."""
    folder = Path(shutil.copytree(named("light_van"), tmp_path / "van"))
    as_today = {found.field: found.largest for found in replay_bundle(folder).differences}
    monkeypatch.setattr(replaying, "compiled", jit.plain)
    monkeypatch.setattr(tyre, "PEAK_DEMAND", 1.01 * tyre.PEAK_DEMAND)
    assert main(["replay", str(folder), "--json"]) == 1
    said, text = capsys.readouterr()
    found = json.loads(said)
    assert (found["equal"], found["ticks"], found["problems"]) == (False, 400, [])
    fields = {difference["field"]: difference for difference in found["differences"]}
    speed = fields["vehicle.vx_mps"]
    assert 1 < speed["first_tick"] < 400
    assert 0.0 < abs(speed["largest"] - as_today["vehicle.vx_mps"]) < 0.1  # the car has changed since, too
    assert speed["first_tick"] in [around["tick"] for around in speed["around"]]
    assert {name.partition(".")[0] for name in fields} >= {"vehicle", "platform"}
    assert not any(name.startswith(("sample.", "ros.", "events.", "ecu.")) for name in fields), "the inputs are given"
    first = found["differences"][0]
    assert first["field"].startswith(("vehicle.", "platform."))
    assert f"400 ticks replayed, {len(fields)} fields differ" in text
    assert all(name in text for name in fields)
    assert f">{first['first_tick']}" in text
    assert "Traceback" not in text
    tolerances = tmp_path / "tolerances.yaml"
    tolerances.write_text("'*': 100.0\nplatform.*: ignore\n")
    assert main(["replay", str(folder), "--tolerances", str(tolerances)]) == 0
    assert "no field of both differs by more than its tolerance" in capsys.readouterr().out
