from pathlib import Path

import numpy as np
import pytest

from simconsole.scene.viewer.job import Job, load_job, save_job
from simconsole.values.errors import WorkerError
from tests.scene.drives import COLUMNS, job


def test_a_job_survives_its_file(tmp_path: Path) -> None:
    wanted = job()
    save_job(tmp_path / "job.npz", wanted)
    found = load_job(tmp_path / "job.npz")
    assert found.columns == COLUMNS
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
    save_job(folder / "bare.npz", job(with_course=False))
    return load_job(folder / "bare.npz")


@pytest.mark.parametrize("content", [b"", b"not a job", b"PK\x03\x04 torn"])
def test_a_damaged_job_is_one_clear_line(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "job.npz").write_bytes(content)
    with pytest.raises(WorkerError, match=r"job\.npz: is not a scene job") as caught:
        load_job(tmp_path / "job.npz")
    assert "\n" not in str(caught.value)


def test_missing_files_are_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match=r"none\.npz: cannot be read"):
        load_job(tmp_path / "none.npz")
    with pytest.raises(WorkerError, match=r"job\.npz: cannot be written"):
        save_job(tmp_path / "nowhere" / "job.npz", job())
