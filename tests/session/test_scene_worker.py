"""What a scene's process is told of a session, and what it makes of it."""

from simconsole.profiles.view import SceneProfile
from simconsole.scene.timeline import NEEDED, TRAFFIC_LOST
from simconsole.scene.viewer.job import job_of
from simconsole.scene.wheel_shapes import WHEEL_COLUMNS
from simconsole.session.resolution import load_session, override, resolve
from simconsole.session.scene_worker import scene_columns, scene_source
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import plain

COLUMNS = (("a", "b"), 250)


def test_a_car_on_a_course_is_as_large_as_its_vehicle_and_has_a_road() -> None:
    job = job_of(scene_source(resolve(load_session("demo")), *COLUMNS))
    assert 3.5 < job.dimensions.length_m < 5.0
    assert 1.5 < job.dimensions.width_m < 2.1
    assert job.drawing is not None
    assert job.route is not None
    assert len(job.drawing.path) > 100
    assert (job.columns, job.tick_hz) == (("a", "b"), 250)
    assert job.vehicle.wheelbase_m > 2.0
    assert job.vehicle.wheels is not None
    assert job.scanner is None


def test_the_session_says_how_the_scene_is_drawn_and_need_not() -> None:
    session = load_session("demo")
    near = resolve(override(session, outputs={"scene": {"chase_back_m": 5.5}, "bridge": {"camera": {}}}))
    source = scene_source(near, *COLUMNS)
    assert source.profile.chase_back_m == 5.5
    assert source.has_camera
    plain_one = scene_source(resolve(override(session, outputs={"scene": None})), *COLUMNS)
    assert plain_one.profile == SceneProfile()
    assert not plain_one.has_camera


def test_without_a_course_there_is_nothing_to_draw() -> None:
    bare = resolve(override(load_session("demo"), environment={"world": None}, features={"autopilot": None}))
    job = job_of(scene_source(bare, *COLUMNS))
    assert job.drawing is None
    assert job.route is None


def test_a_robot_turns_on_the_spot_and_has_its_lidar() -> None:
    resolved = resolve(load_session("turtlebot3_burger"))
    columns = assemble(resolved, plain)[0].columns
    job = job_of(scene_source(resolved, columns, 200))
    assert job.scanner is not None
    assert job.vehicle == (0.0, None, True)
    assert scene_columns(resolved, columns) == columns


def test_of_a_car_only_what_is_shown_is_read() -> None:
    resolved = resolve(load_session("demo"))
    columns = assemble(resolved, plain)[0].columns
    read = scene_columns(resolved, columns)
    assert set(read) == {*NEEDED, TRAFFIC_LOST, *WHEEL_COLUMNS}
    assert len(read) < len(columns) / 2
