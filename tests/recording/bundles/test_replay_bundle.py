"""Replay re-simulates: an equal drive is equal to the last bit, and one forged value is found where it acts first."""

import json
import shutil
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from itertools import islice
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

from simconsole.profiles.files.loader import profiles_folder
from simconsole.recording.bundles.bundle import BundleWriter, open_bundle
from simconsole.recording.bundles.pack import pack, unpack
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.replay import ReplayResult
from tests.drives.console import complaint, results, within
from tests.drives.fixtures import Demo
from tests.recording.conftest import change_header
from tests.samples import Sample

REPLAYS = 20
BRAKES = 0.2
AFTER_TICKS = 1000
FORGED_TICK = 400


@pytest.fixture(scope="module")
def beginning(demo: Demo, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The demo until its person first brakes, and a moment more; not packed. Read only: copy it to change it."""
    table = demo.table("driver.brake")
    ticks = int(table.ticks[np.flatnonzero(table.column("driver.brake") > BRAKES)[0]]) + AFTER_TICKS
    folder = tmp_path_factory.mktemp("beginning") / "bundle"
    contents = {path.name: path.read_bytes() for path in (*demo.bundle.glob("map.*"), demo.bundle / "session.json")}
    with BundleWriter(folder, open_bundle(demo.bundle).log.header, contents) as writer:
        for record in islice(open_bundle(demo.bundle).log, ticks):
            writer.log.append(record.tick, record.vector)
        writer.finish({})
    return folder


@pytest.fixture
def copy(short: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(short, tmp_path / "copy"))


def test_replay_of_the_demo_finds_every_hash_equal(demo: Demo) -> None:
    done = within("replay", demo.bundle, "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    (road_map,) = (path.name for path in demo.bundle.glob("map.*"))
    assert results(done) == {
        "equal": True,
        "hashes_equal": True,
        "bit_exact": True,
        "ticks": demo.ticks,
        "digest": demo.results["digest"],
        "differences": [],
        "new": [],
        "missing": [],
        "problems": [],
        "remarks": [],
        "vouches_for": ["drive.parquet", road_map, "session.json"],
    }
    assert "every hash equal" in done.stderr
    says = f"this vouches for drive.parquet, {road_map}, session.json; "
    says += "for manifest.json, report.html, scene.rrd: simconsole verify"
    assert says in done.stderr.splitlines()


def test_replays_of_the_demo_are_equal(demo: Demo, beginning: Path, sample: Sample) -> None:
    """The sample replays the beginning of it."""
    # In processes of their own, beside that of the test above: compiled code is loaded anew, two cores share the work.
    replays, bundle = sample.of(1, REPLAYS), demo.bundle if sample.long else beginning
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = list(pool.map(replay_bundle, [bundle] * replays))
    manifest = open_bundle(bundle).manifest
    assert found == [ReplayResult(True, True, manifest.ticks, bytes.fromhex(manifest.digest))] * replays
    assert not sample.long or manifest.digest == demo.results["digest"]


def test_twenty_replays_in_a_row_are_equal(short: Path) -> None:
    digest = bytes.fromhex(open_bundle(short).manifest.digest)
    assert [replay_bundle(short) for _ in range(REPLAYS)] == [ReplayResult(True, True, 750, digest)] * REPLAYS


def test_a_packed_drive_and_its_log_replay_alike(copy: Path) -> None:
    from_log = replay_bundle(copy)
    pack(copy)
    assert replay_bundle(copy) == from_log
    assert from_log.good


def test_the_plain_functions_replay_what_compiled_code_drove(short: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from simconsole.recording.bundles import replay_bundle as replaying
    from simconsole.values.host import jit

    monkeypatch.setattr(replaying, "compiled", jit.plain)
    found = replay_bundle(short)
    assert found.hashes_equal, found.differences
    assert found.ticks == 750


def test_a_drive_on_a_tir_tyre_replays_without_the_file(script: Path, short: Path, tmp_path: Path) -> None:
    """The bundle holds the tyre's coefficients: the file may change or go, the drive is equal to the bit."""
    vehicles = profiles_folder() / "vehicles"
    shutil.copy(vehicles / "tyres" / "example.tir", tmp_path / "mine.tir")
    (tmp_path / "mine.yaml").write_text((vehicles / "hatchback.yaml").read_text() + "tyre: {tir: mine.tir}\n")
    session = tmp_path / "session.yaml"
    session.write_text("schema: 1\nscenario: {vehicle: mine.yaml}\noutputs: {scene: null, report: false}\n")
    bundle = tmp_path / "bundle"
    words = ("--headless", "--driver", f"script:{script}", "--for", 3, "--out", bundle, "--json", "--no-pack")
    done = within("drive", session, *words)
    assert done.returncode == 0, done.stdout + done.stderr
    (tmp_path / "mine.tir").unlink()
    found = replay_bundle(bundle)
    assert found.hashes_equal, found.differences
    assert (found.ticks, found.digest.hex()) == (750, results(done)["digest"])
    table = open_bundle(bundle).log.table()
    assert table.column("vehicle.vx_mps").max() > 1.0
    assert open_bundle(short).manifest.digest != found.digest.hex(), "the same drive on its own tyre"


def test_one_forged_brake_value_is_named_with_tick_and_field(
    copy: Path, rewrite_log: Callable[..., None], rewrite_checksums: Callable[[Path], None]
) -> None:
    table = open_bundle(copy).log.table()
    before = table.column("sample.brake_axis")[FORGED_TICK - 1]
    rewrite_log(copy / "drive.log", FORGED_TICK, "sample.brake_axis", before - 0.5)
    rewrite_checksums(copy)
    assert verify(copy) == [], "the forgery is perfect: only driving it again can tell"
    done = within("replay", copy, "--json")
    assert done.returncode == 1
    found = results(done)
    assert (found["equal"], found["hashes_equal"], found["ticks"]) == (False, False, 750)
    difference = found["differences"][0]
    assert (difference["first_tick"], difference["field"]) == (FORGED_TICK, "driver.brake")
    assert difference["recorded"] == pytest.approx(table.column("driver.brake")[FORGED_TICK - 1])
    assert difference["replayed"] != difference["recorded"]
    assert {"tick": FORGED_TICK, "recorded": difference["recorded"], "replayed": difference["replayed"]} in (
        difference["around"]
    )
    assert f"750 ticks replayed, {len(found['differences'])} fields differ" in done.stderr


def test_a_forged_brake_value_in_the_demo_is_found_too(
    demo: Demo,
    beginning: Path,
    sample: Sample,
    tmp_path: Path,
    rewrite_log: Callable[..., None],
    rewrite_checksums: Callable[[Path], None],
) -> None:
    """The sample is its beginning."""
    whole = demo.bundle if sample.long else beginning
    forged = Path(shutil.copytree(whole, tmp_path / "forged"))
    unpack(forged)
    table = open_bundle(whole).log.table(("driver.brake",))
    manual = np.flatnonzero(table.column("driver.brake") > BRAKES)
    tick = int(table.ticks[manual[len(manual) // 2]])
    rewrite_log(forged / "drive.log", tick, "sample.brake_axis", 0.0)
    rewrite_checksums(forged)
    found = replay_bundle(forged)
    assert not found.equal
    first = found.differences[0]
    assert (first.first_tick, first.field) == (tick, "driver.brake")
    assert found.ticks == len(table.ticks), "to the end, whatever differs"


def test_one_changed_vehicle_value_is_named_with_tick_and_field(
    copy: Path, rewrite_session: Callable[..., None]
) -> None:
    session = json.loads((copy / "session.json").read_text())
    session["vehicle"]["body"]["mass_kg"] *= 1.01
    (copy / "session.json").write_text(json.dumps(session))
    assert any("session.json" in problem for problem in verify(copy))
    rewrite_session(copy, session)
    assert verify(copy) == []
    done = within("replay", copy, "--json")
    assert done.returncode == 1, done.stdout + done.stderr
    difference = results(done)["differences"][0]
    assert 1 <= difference["first_tick"] <= FORGED_TICK
    assert difference["field"].split(".")[0] in ("vehicle", "platform")
    assert difference["field"] in done.stderr


def test_a_session_altered_into_nonsense_is_one_line(copy: Path, rewrite_session: Callable[..., None]) -> None:
    session = json.loads((copy / "session.json").read_text())
    session["vehicle"]["body"]["mass_kg"] = -1
    rewrite_session(copy, session)
    assert f"{copy / 'session.json'}: vehicle.body.mass_kg: value -1" in complaint(within("replay", copy))


@pytest.mark.parametrize("command", ["replay", "report", "view", "verify"])
def test_a_session_that_the_log_was_not_recorded_with_is_refused(
    copy: Path, rewrite_session: Callable[..., None], command: str
) -> None:
    """Nothing of this drive would differ by this value: only the log's own hash of the session can tell."""
    session = json.loads((copy / "session.json").read_text())
    session["session"]["features"]["control"]["stop_decel_mps2"] += 0.5
    rewrite_session(copy, session, forged=False)
    done = within(command, copy, *(["--no-open"] if command == "view" else []))
    line = done.stdout.strip() if command == "verify" else complaint(done)
    assert done.returncode == (1 if command == "verify" else 2)
    assert f"{copy / 'session.json'}: altered: sha256 " in line
    assert len(line.splitlines()) == 1


def test_other_sources_are_told_and_not_refused(copy: Path, rewrite_checksums: Callable[[Path], None]) -> None:
    change_header(copy / "drive.log", source_sha256="5" * 64, console_version="0.0.9")
    rewrite_checksums(copy)
    done = within("replay", copy, "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    (remark,) = results(done)["remarks"]
    assert f"{copy / 'drive.log'}: recorded with other sources: 555555555555 (simconsole 0.0.9), here " in remark
    assert remark in done.stderr.splitlines()


@pytest.mark.parametrize("command", ["replay", "report", "view"])
def test_a_bundle_cut_short_is_one_line(copy: Path, command: str) -> None:
    log = copy / "drive.log"
    size = log.stat().st_size
    with log.open("r+b") as file:
        file.truncate(size // 2)
    before = sorted(path.name for path in copy.iterdir())
    line = complaint(within(command, copy, *(["--no-open"] if command == "view" else [])))
    assert f"{log}: " in line
    assert "truncated" in line
    assert str(size) in line
    assert sorted(path.name for path in copy.iterdir()) == before
