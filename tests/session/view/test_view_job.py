"""What the driver's view is given of a session."""

from copy import copy
from pathlib import Path

import numpy as np
import pytest

from simconsole.hud.driver_view.gltf import Node, glb
from simconsole.hud.driver_view.mesh import Box, box
from simconsole.session.resolution import load_session, override, resolve
from simconsole.session.view.view_job import limit_kmh, limits_of, load_view_job, save_view_job, view_job
from simconsole.values.errors import ProfileError, WorkerError
from simconsole.world.kinds.worlds import open_world

HOUSE = box(Box(0.0, 0.0, 0.0, half_length_m=4.0, half_width_m=2.0, height_m=3.0), (200, 120, 40))
WITH_MODELS = """\
schema: 1
environment: {world: urban}
outputs:
  hud:
    view:
      vehicle_model: {file: town.glb, yaw_deg: 90}
      models:
        - {file: town.glb, x_m: 100, y_m: 20, yaw_deg: 30, scale: 2}
"""


def test_a_job_comes_out_of_its_file_as_it_went_in(tmp_path: Path) -> None:
    job = view_job(resolve(load_session("demo")))
    save_view_job(tmp_path / "view.npz", job)
    back = load_view_job(tmp_path / "view.npz")
    assert (back.limits, back.size, back.steering_ratio) == (job.limits, job.size, job.steering_ratio)
    assert job.limits == ((0.0, 50.0),)
    assert 2.0 < job.size.wheelbase_m < 3.0
    assert job.drawing is not None
    assert back.drawing is not None
    assert (back.drawing.path == job.drawing.path).all()


def test_models_of_a_labs_own_are_in_the_scene(tmp_path: Path) -> None:
    (tmp_path / "town.glb").write_bytes(glb("map", [Node("house", HOUSE)]))
    session = tmp_path / "session.yaml"
    session.write_text(WITH_MODELS)
    resolved = resolve(load_session(str(session)))
    job = view_job(resolved)
    save_view_job(tmp_path / "view.npz", job)
    back = load_view_job(tmp_path / "view.npz")
    assert (back.models.world == job.models.world).all()
    assert len(back.models.body) == len(HOUSE)
    middle = 0.5 * (back.models.world["position"].min(axis=0) + back.models.world["position"].max(axis=0))
    assert middle == pytest.approx((100.0, 20.0, 3.0), abs=1e-4)  # twice as large: 6 m high
    plain = view_job(resolve(override(load_session("demo"), environment={"world": "urban", "traffic": None}))).scene()
    scene = back.scene()
    assert len(scene.solids.vertices) == len(plain.solids.vertices) + len(HOUSE)
    assert (scene.vehicle.body["position"] == back.models.body["position"]).all()


def test_a_model_that_is_none_is_one_line(tmp_path: Path) -> None:
    session = tmp_path / "session.yaml"
    session.write_text(WITH_MODELS)
    with pytest.raises(ProfileError, match=r"town\.glb"):
        view_job(resolve(load_session(str(session))))
    (tmp_path / "town.glb").write_bytes(b"solid town")
    with pytest.raises(ProfileError, match=r"town\.glb: file: no binary glTF 2\.0"):
        view_job(resolve(load_session(str(session))))
    session.write_text(WITH_MODELS.replace("file: town.glb, x_m", "file: ../town.glb, x_m"))
    with pytest.raises(ProfileError, match=r"outputs\.hud\.view\.models\.file.*a file inside"):
        load_session(str(session))


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


def test_a_limit_that_changes_on_the_way_is_told_where_it_does() -> None:
    country = override(load_session("demo"), environment={"world": "country"}, features={"autopilot": None})
    resolved = resolve(country)
    assert resolved.world is not None
    assert view_job(resolved).limits == ((0.0, 80.0),)
    route = copy(open_world(resolved.world).route)
    assert limit_kmh(route) == pytest.approx(80.0, abs=0.1)
    route.limit = np.where(route.s < 500.0, 13.89, 22.22)
    assert limit_kmh(route) == 0.0
    assert limits_of(route) == ((0.0, 50.0), (pytest.approx(500.0, abs=1.0), 80.0))
    route.limit = np.where((route.s > 500.0) & (route.s < 530.0), 6.63, 22.22)  # a bend inside a junction
    assert limits_of(route) == ((0.0, 80.0),)


@pytest.mark.parametrize("world", ["urban_signals", "motorway", "urban"])
def test_every_shipped_road_tells_its_limits(world: str) -> None:
    resolved = resolve(override(load_session("demo"), environment={"world": world}, features={"autopilot": None}))
    limits = view_job(resolved).limits
    assert limits
    assert all(kmh in (30.0, 50.0, 60.0, 80.0, 95.0, 130.0) for _, kmh in limits)
    assert len(limits) < 6
