"""What is known of a drive is in its bundle before the first tick, and nothing of it in its log."""

import os
import shutil
import signal
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import msgspec
import numba
import numpy as np
import pytest

from simconsole import __version__
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.provenance import NOTHING_GIVEN, Given, Source
from simconsole.session import provenance
from simconsole.session.lifecycle import drive
from simconsole.session.provenance import package_versions, provenance_at_start, with_devices
from simconsole.values.errors import RecordingError
from simconsole.values.protocols import DeviceIdentity
from tests.faults.recorded import session

KILLED = """
import os, signal, sys
from pathlib import Path
from simconsole.recording.bundles.provenance import Given
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
session = load_session("demo")
outputs = {"bridge": None, "scene": None, "report": False}
plain = override(session, outputs=outputs, mode={"pacing": "free"}, features={"autopilot": None})
given = Given(participant="P07", trial="3", notes=("slept badly", "second visit"))
def watch(snapshot):
    if snapshot.tick == int(sys.argv[2]):
        os.kill(os.getpid(), signal.SIGKILL)
    return False
drive(resolve(plain), Path(sys.argv[1]), watch, given=given)
"""


@pytest.mark.parametrize("ticks", [0, 1])
def test_kill_9_before_or_after_the_first_tick_loses_nothing_that_was_known(ticks: int, tmp_path: Path) -> None:
    """Participant, notes, machine, source and the devices that were opened: on the disk before the tick is."""
    words = [sys.executable, "-c", KILLED, str(tmp_path / "b"), str(ticks)]
    done = subprocess.run(words, capture_output=True, check=False)
    assert done.returncode == -signal.SIGKILL, done.stderr
    bundle = open_bundle(tmp_path / "b")
    assert not bundle.manifest.finished
    assert [record.tick for record in bundle.log] == [1][:ticks]
    found = bundle.manifest.provenance
    assert (found.participant, found.trial, found.notes) == ("P07", "3", ("slept badly", "second visit"))
    assert found.started_utc.endswith("+00:00")
    assert found.title
    assert found.machine is not None
    assert found.machine.cpus == os.cpu_count()
    assert found.source is not None
    assert found.source.version == __version__
    assert {role for device in found.devices for role in device.roles} >= {"wheel", "pedals"}
    assert bundle.manifest.versions["numba"] == numba.__version__
    assert bundle.manifest.versions["simconsole"] == __version__


def test_nothing_of_it_is_in_the_log(script: Path, tmp_path: Path) -> None:
    for name in ("P01", "P02"):
        drive(session(script, 0.2), tmp_path / name, given=Given(participant=name))
    logs = [(tmp_path / name / "drive.log").read_bytes() for name in ("P01", "P02")]
    assert logs[0] == logs[1]
    assert open_bundle(tmp_path / "P02").manifest.provenance.participant == "P02", "kept at the end too"


def test_manifest_says_how_much_of_the_cars_torque_the_wheel_bears(script: Path, tmp_path: Path) -> None:
    """A motor of half the inertia that is late: it bears less, and less the faster the car."""
    plain = session(script, 0.2)
    force = plain.cockpit.force_feedback
    assert force is not None
    motor = msgspec.structs.replace(force.motor, inertia_kgm2=0.5 * force.motor.inertia_kgm2, delay_s=0.032)
    weak = msgspec.structs.replace(plain.cockpit, force_feedback=msgspec.structs.replace(force, motor=motor))
    without = msgspec.structs.replace(plain.cockpit, force_feedback=None)
    shares = []
    for name, cockpit in (("shipped", plain.cockpit), ("weak", weak), ("without", without)):
        drive(msgspec.structs.replace(plain, cockpit=cockpit), tmp_path / name)
        shares.append(open_bundle(tmp_path / name).manifest.provenance.torque_shares)
    shipped, weaker, none = shares
    assert [at.share for at in shipped if at.speed_kmh <= 90.0] == [1.0, 1.0, 1.0]
    falling = [at.share for at in weaker]
    assert falling == sorted(falling, reverse=True)
    assert falling[-1] < 0.5
    assert none == ()


def test_a_drive_with_too_long_a_note_does_not_begin(script: Path, tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="note: value of 501 characters: up to 500"):
        drive(session(script, 0.2), tmp_path / "b", given=Given(notes=("x" * 501,)))
    assert not (tmp_path / "b").exists()


def test_versions_are_those_of_what_is_installed() -> None:
    assert package_versions()["numpy"] == np.__version__
    assert set(package_versions()) <= {"simconsole", *provenance.PACKAGES}


def test_devices_are_added_to_what_is_known() -> None:
    known = provenance_at_start("A drive", NOTHING_GIVEN)
    wheel = DeviceIdentity(roles=("wheel",), name="T500", usb_id="044f:b65e", port="usb-2", serial="A1")
    found = with_devices(known, [wheel])
    assert found.title == "A drive"
    (device,) = found.devices
    assert (device.name, device.usb_id, device.port, device.serial) == ("T500", "044f:b65e", "usb-2", "A1")


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package in a git checkout of its own."""
    for name in ("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE"):
        monkeypatch.delenv(name, raising=False)
    package = tmp_path / "checkout" / "package"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("x = 1\n")
    (package.parent / ".gitignore").write_text("site-packages/\n")
    git(package.parent, "init", "-q")
    git(package.parent, "add", ".")
    git(package.parent, "-c", "user.name=n", "-c", "user.email=e@x", "commit", "-q", "-m", "One")
    return package


def git(folder: Path, *words: str) -> str:
    return subprocess.run(["git", "-C", folder, *words], capture_output=True, check=True, text=True).stdout.strip()


def source(package: Path) -> Source:
    provenance._source.cache_clear()
    return provenance._source(package)


def test_source_state_tells_commit_and_changes(checkout: Path) -> None:
    clean = source(checkout)
    assert (clean.commit, clean.changed) == (git(checkout, "rev-parse", "HEAD"), False)
    content = b"x = 1\n"
    assert clean.sha256 == sha256(b"__init__.py\0" + b"6\0" + content).hexdigest()
    (checkout / "new.py").write_text("y = 2\n")
    changed = source(checkout)
    assert (changed.commit, changed.changed) == (clean.commit, True)
    assert changed.sha256 != clean.sha256


def test_a_package_that_the_checkout_around_it_ignores_is_not_of_its_commit(checkout: Path) -> None:
    installed = checkout.parent / "site-packages" / "package"
    shutil.copytree(checkout, installed)
    found = source(installed)
    assert (found.commit, found.changed) == (None, None)
    assert found.sha256 == source(checkout).sha256


def test_without_git_there_is_no_commit(checkout: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(checkout))
    found = source(checkout)
    assert (found.commit, found.changed) == (None, None)
