"""Gone means gone: whatever of a drive is killed, none of its processes drives on, and nothing of it stays.

`pytest --long tests/faults/test_lifetimes.py` kills fifty drives; the bars in seconds are reported, not asserted:
what is asserted is the cause, that the pipe which a child reads is held by its parent alone.
"""

import os
import signal
from pathlib import Path

import pytest

from simconsole.recording.bundle import open_bundle
from simconsole.signals import Mode
from tests.drives.console import Running
from tests.drives.controllers import free_port
from tests.faults.lives import living, wait_for_port, write_session


def modes_of(bundle: Path) -> set[float]:
    return set(open_bundle(bundle).log.table().column("arbitration.mode").tolist())


def next_drive_is_manual(folder: Path, port: int, seconds: float = 4.0) -> None:
    """Drive on the same port with nobody but a person who asks for autonomy again and again."""
    wait_for_port(port)
    session = write_session(folder, port, autopilot=False, stations=False)
    with Running(folder, "drive", session, "--for", seconds, "--out", folder / "bundle", "--json") as running:
        done = running.end()
    assert done.returncode == 0, done.stderr
    assert modes_of(folder / "bundle") <= {Mode.PARKED, Mode.MANUAL}, "nobody may drive here but the person"


@pytest.mark.fault("P02")
def test_the_autopilot_of_a_killed_drive_does_not_drive_the_next_one(tmp_path: Path) -> None:
    port = free_port()
    session = write_session(tmp_path / "first", port, stations=False)
    with living(tmp_path / "first", "first", "drive", session, "--out", tmp_path / "bundle") as life:
        autopilot = life.wait_for("--course")
        os.killpg(life.core, signal.SIGKILL)
        for process in set(life.family()) - {autopilot}:
            os.kill(process, signal.SIGKILL)
        life.running.process.wait()
        next_drive_is_manual(tmp_path / "next", port)
