"""Memory of the scene's process over a long drive, fed as fast as it takes it."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.paths import ROOT
from tests.samples import Measured, Sample
from tests.scene.drives import rows

# Every call of the ring is a second of the drive: as many pieces an hour as in a seated one.
FEEDER = """
import os, sys
from pathlib import Path
import numpy as np
from simconsole.values.state_vector import Snapshot
from simconsole.scene.viewer import follow
from tests.scene.drives import job as make_job

follow.POLL_S = 0.0
folder = Path(sys.argv[1])
job, rows = make_job(), np.load(folder / "rows.npy")
seconds, tick, second = 60 * int(sys.argv[3]), 0, 0
def new_ticks():
    global tick, second
    second += 1
    if second % 60 == 0:
        print(int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE"), flush=True)
    start, tick = tick, tick + job.tick_hz
    return [Snapshot(at + 1, job.tick_hz, rows[at % len(rows)]) for at in range(start, tick)]
ports = follow.Ports(new_ticks, lambda: second >= seconds)
follow.follow(ports, job._replace(profile=job.profile.__class__(chunk_s=1e-6)), Path(sys.argv[2]))
"""
ALLOCATOR_MIB = 4.0
"""Steps in which rerun's threads take memory from the system; an index would take 17 MiB in ten minutes."""
MIB = 1 << 20


@pytest.mark.fault("P08")
@pytest.mark.timeout(3600)
def test_the_scene_of_a_long_drive_takes_no_more_memory_than_that_of_a_short_one(
    tmp_path: Path, sample: Sample, measured: Measured
) -> None:
    warm, minutes = sample.of(2, 10), sample.of(10, 8 * 60)
    np.save(tmp_path / "rows.npy", rows(7500))
    command = [sys.executable, "-c", FEEDER, str(tmp_path), str(tmp_path / "scene.rrd"), str(minutes)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    resident = np.array(done.stdout.split(), dtype=np.int64)[warm:]
    part = max(1, len(resident) // 3)
    grown = float(np.median(resident[-part:]) - np.median(resident[:part]))
    hours = (len(resident) - part) / 60.0
    assert grown <= max(ALLOCATOR_MIB, hours) * MIB
    seen = f"{grown / MIB:+.2f} MiB in {hours:.1f} h, {resident[-1] / MIB:.0f} MiB in all"
    measured("P08", "resident memory of the scene's process", seen, f"at most 1 MiB an hour after {warm} minutes")
