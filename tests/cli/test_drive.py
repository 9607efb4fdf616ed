"""`simconsole drive --headless`: every driver that needs no hardware, from the command line into a bundle."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.devices.synthetic.trace_format import COLUMNS
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.session.headless import LOOKED_AT
from simconsole.values.signals import NEVER_TICKS, Mode, Validity
from tests.drives.console import complaint, results, simconsole, within

PERSON = """\
schema: 1
title: A person, headless
scenario: {vehicle: hatchback}
outputs: {hud: null, scene: null, report: false}
devices:
  driver: virtual
  person: {title: stops again, sit_s: 0.2, cruise_kmh: 12, top_gear: 1, stop: {distance_m: 4}}
mode: {pacing: free}
"""


def test_a_script_drives_for_as_long_as_asked(short: Path) -> None:
    table = open_bundle(short).log.table()
    assert verify(short) == []
    assert table.ticks.tolist() == list(range(1, 751))
    assert table.column("vehicle.distance_m")[-1] > 0.5
    assert table.column("driver.gear")[-1] == 1.0
    assert table.column("driver.brake").max() > 0.2
    assert (table.column("driver.hand_wheel_rad") > 0.15).any()
    assert (table.column("arbitration.mode") == float(Mode.MANUAL)).all()
    assert (short / "report.html").exists()
    assert (short / "scene.rrd").exists()


def test_every_bundle_and_report_tells_the_latency_of_each_hop(short: Path) -> None:
    hops = open_bundle(short).manifest.summary["latency_us"]
    assert list(hops)[:6] == ["device", "read", "take", "decide", "step", "force feedback"]
    assert {hop["count"] for hop in hops.values()} == {750 // LOOKED_AT}
    assert "<h2>Latency</h2>" in (short / "report.html").read_text()


def test_a_recorded_cockpit_gives_the_same_samples_again(plain: Path, tmp_path: Path) -> None:
    trace = tmp_path / "trace.csv"
    recorded = simconsole("devices", "record", "--virtual", "--for", 2, "--out", trace, "--json")
    assert recorded.returncode == 0, recorded.stderr
    assert results(recorded)["ticks"] == 500
    lines = trace.read_text().splitlines()[2:]
    rows = np.array([[float(value) for value in line.split(",")] for line in lines])
    bundle = tmp_path / "bundle"
    done = within("drive", plain, "--driver", f"trace:{trace}", "--for", 2, "--out", bundle, "--json")
    assert done.returncode == 0, done.stderr
    table = open_bundle(bundle).log.table()
    for at, name in enumerate(COLUMNS):
        if name != "tick":
            assert np.array_equal(table.column(f"sample.{name}"), rows[:, at]), name
    assert table.column("sample.throttle_axis").min() < 0.0, "the recording holds somebody's foot"
    assert table.column("driver.throttle").max() > 0.9
    assert table.column("driver.wheel_validity")[-1] == Validity.LIVE


def test_after_its_end_a_trace_is_a_lost_cockpit(plain: Path, tmp_path: Path) -> None:
    trace = tmp_path / "trace.csv"
    assert simconsole("devices", "record", "--virtual", "--for", 0.2, "--out", trace).returncode == 0
    bundle = tmp_path / "bundle"
    done = within("drive", plain, "--driver", f"trace:{trace}", "--for", 1, "--out", bundle)
    assert done.returncode == 0, done.stderr
    table = open_bundle(bundle).log.table()
    validity = table.column("driver.wheel_validity")
    assert validity[49] in (Validity.ARMED, Validity.LIVE)
    assert validity[-1] >= Validity.STALE
    assert table.column("arbitration.mode")[-1] in (Mode.MINIMAL_RISK, Mode.STOPPED, Mode.PARKED)
    assert not table.column("command.throttle")[60:].any()


def test_a_simulated_person_drives_through_sdl_without_a_controller(tmp_path: Path) -> None:
    session, bundle = tmp_path / "person.yaml", tmp_path / "bundle"
    session.write_text(PERSON)
    done = simconsole("drive", session, "--for", 60, "--out", bundle, "--json")
    assert done.returncode == 0, done.stderr
    table = open_bundle(bundle).log.table()
    assert len(table.ticks) < 60 * 250, "it ends when the person is through"
    assert table.column("vehicle.distance_m")[-1] > 4.0
    assert abs(table.column("vehicle.vx_mps")[-1]) < 0.01
    assert np.median(table.column("sample.brake_axis")) > 0.9
    assert sorted(path.name for path in bundle.iterdir()) == ["drive.parquet", "manifest.json", "session.json"]


def test_with_nobody_seated_nothing_is_commanded(plain: Path, tmp_path: Path) -> None:
    bundle = tmp_path / "bundle"
    done = within("drive", plain, "--driver", "none", "--for", 0.5, "--out", bundle, "--json")
    assert done.returncode == 0, done.stderr
    table = open_bundle(bundle).log.table()
    assert (table.column("sample.wheel_age_ticks") == NEVER_TICKS).all()
    assert (table.column("arbitration.mode") == float(Mode.PARKED)).all()
    assert not table.column("command.throttle").any()
    assert np.abs(table.column("vehicle.vx_mps")).max() < 1e-3


def test_a_drive_of_one_tick_is_a_whole_drive(tmp_path: Path, script: Path) -> None:
    bundle = tmp_path / "bundle"
    done = within("drive", "--headless", "--driver", f"script:{script}", "--for", 0.004, "--out", bundle, "--json")
    assert done.returncode == 0, done.stderr
    assert results(done)["ticks"] == 1
    assert within("replay", bundle).returncode == 0


def test_a_session_finds_its_script_beside_itself(tmp_path: Path, script: Path) -> None:
    (tmp_path / "person.yaml").write_text(script.read_text())
    session = tmp_path / "session.yaml"
    session.write_text(
        "schema: 1\noutputs: {hud: null, scene: null, report: false}\n"
        "devices: {driver: 'script:person.yaml'}\nmode: {pacing: free}\n"
    )
    done = within("drive", session, "--for", 1, "--out", tmp_path / "bundle", "--json")
    assert done.returncode == 0, done.stderr
    assert open_bundle(tmp_path / "bundle").log.table().column("driver.clutch").max() == pytest.approx(1.0)


def test_participant_trial_and_notes_are_kept_in_the_bundle(plain: Path, tmp_path: Path) -> None:
    options = ["--driver", "none", "--for", 0.1, "--participant", "P07", "--trial", 3]
    done = within("drive", plain, *options, "--note", "tired", "--note", "glasses", "--out", tmp_path / "b")
    assert done.returncode == 0, done.stderr
    known = open_bundle(tmp_path / "b").manifest.provenance
    assert (known.participant, known.trial, known.notes) == ("P07", "3", ("tired", "glasses"))
    assert known.devices == (), "nobody sat there"
    refused = complaint(within("drive", plain, "--participant", "P" * 65, "--out", tmp_path / "c"))
    assert "participant: value of 65 characters: up to 64" in refused
    assert not (tmp_path / "c").exists()
