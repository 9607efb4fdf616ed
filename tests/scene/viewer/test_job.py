from pathlib import Path

import numpy as np

from simconsole.scene.timeline import NEEDED
from simconsole.scene.viewer.job import Job, load_job, save_job
from tests.scene.drives import COLUMNS, job


def test_a_job_survives_its_file(tmp_path: Path) -> None:
    wanted = job(40)
    save_job(tmp_path / "job.npz", wanted)
    found = load_job(tmp_path / "job.npz")
    assert set(found.columns) == set(NEEDED)
    for name in NEEDED:
        assert (found.vectors[:, found.columns.index(name)] == wanted.vectors[:, COLUMNS.index(name)]).all()
    assert found.ticks.tolist() == wanted.ticks.tolist()
    assert (found.tick_hz, found.dimensions, found.profile) == (wanted.tick_hz, wanted.dimensions, wanted.profile)
    assert found.drawing is not None
    assert wanted.drawing is not None
    assert found.drawing.lights == wanted.drawing.lights
    assert found.drawing.islands == ()
    for name in ("surfaces", "edges", "centre_lines", "zebras", "stop_lines"):
        pairs = zip(getattr(found.drawing, name), getattr(wanted.drawing, name), strict=True)
        assert all(np.array_equal(a, b) for a, b in pairs)
    assert load_job_without_course(tmp_path).drawing is None


def load_job_without_course(folder: Path) -> Job:
    save_job(folder / "bare.npz", job(1, with_course=False))
    return load_job(folder / "bare.npz")
