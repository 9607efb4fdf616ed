"""What a scene's process is given of a session."""

from simconsole.profiles.view import SceneProfile
from simconsole.session.resolution import load_session, override, resolve
from simconsole.session.scene_job import scene_job

COLUMNS = (("a", "b"), 250)


def test_a_car_on_a_course_is_as_large_as_its_vehicle_and_has_a_road() -> None:
    job = scene_job(resolve(load_session("demo")), *COLUMNS)
    assert 3.5 < job.dimensions.length_m < 5.0
    assert 1.5 < job.dimensions.width_m < 2.1
    assert job.drawing is not None
    assert len(job.drawing.path) > 100
    assert (job.columns, job.tick_hz) == (("a", "b"), 250)


def test_the_session_says_how_the_scene_is_drawn_and_need_not() -> None:
    session = load_session("demo")
    near = resolve(override(session, outputs={"scene": {"chase_back_m": 5.5}}))
    assert scene_job(near, *COLUMNS).profile.chase_back_m == 5.5
    assert scene_job(resolve(override(session, outputs={"scene": None})), *COLUMNS).profile == SceneProfile()


def test_without_a_course_there_is_nothing_to_draw() -> None:
    bare = resolve(override(load_session("demo"), environment={"world": None}, features={"autopilot": None}))
    assert scene_job(bare, *COLUMNS).drawing is None
