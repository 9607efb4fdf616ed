"""What the driver's view is given of a session."""

from copy import copy
from pathlib import Path

import numpy as np
import pytest

from simconsole.session.resolution import load_session, override, resolve
from simconsole.session.view_job import limit_kmh, load_view_job, save_view_job, view_job
from simconsole.values.errors import WorkerError
from simconsole.world.kinds.worlds import open_world


def test_a_job_comes_out_of_its_file_as_it_went_in(tmp_path: Path) -> None:
    job = view_job(resolve(load_session("demo")))
    save_view_job(tmp_path / "view.npz", job)
    back = load_view_job(tmp_path / "view.npz")
    assert (back.limit_kmh, back.size, back.steering_ratio) == (job.limit_kmh, job.size, job.steering_ratio)
    assert job.limit_kmh == pytest.approx(50.0)
    assert 2.0 < job.size.wheelbase_m < 3.0
    assert job.drawing is not None
    assert back.drawing is not None
    assert (back.drawing.path == job.drawing.path).all()


def test_without_a_course_there_is_nothing_to_draw(tmp_path: Path) -> None:
    bare = resolve(override(load_session("demo"), environment={"world": None}, features={"autopilot": None}))
    save_view_job(tmp_path / "view.npz", view_job(bare))
    assert load_view_job(tmp_path / "view.npz").drawing is None


def test_what_is_no_job_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match="cannot be read"):
        load_view_job(tmp_path / "nowhere.npz")
    (tmp_path / "text.npz").write_text("no")
    with pytest.raises(WorkerError, match="is not a view job"):
        load_view_job(tmp_path / "text.npz")
    with pytest.raises(WorkerError, match="cannot be written"):
        save_view_job(tmp_path / "nowhere" / "view.npz", view_job(resolve(load_session("roll_a_ball"))))


def test_a_limit_that_changes_on_the_way_is_on_no_sign() -> None:
    country = override(load_session("demo"), environment={"world": "country"}, features={"autopilot": None})
    resolved = resolve(country)
    assert resolved.world is not None
    assert view_job(resolved).limit_kmh == pytest.approx(80.0, abs=0.1)
    route = copy(open_world(resolved.world).route)
    route.limit = np.append(route.limit, 10.0)
    assert limit_kmh(route) == 0.0
