"""What a scene is made of: a lidar is shown where a robot has walls around it, and nowhere else."""

import pytest

from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.view import SceneProfile
from simconsole.scene.entities import Dimensions
from simconsole.scene.timeline import NO_VEHICLE
from simconsole.scene.viewer.job import SceneSource, job_of


@pytest.mark.parametrize(
    ("world", "has_robot", "has_scanner"),
    [("arena", True, True), ("arena", False, False), (None, True, False)],
)
def test_only_a_robot_in_an_arena_has_a_scanner(world: str | None, has_robot: bool, has_scanner: bool) -> None:
    robot = load_vehicle("turtlebot3_burger")
    assert isinstance(robot, TurtlebotProfile)
    job = job_of(
        SceneSource(
            columns=("a", "b"),
            tick_hz=200,
            dimensions=Dimensions(1.0, 1.0, 1.0, 0.5),
            vehicle=NO_VEHICLE,
            world=None if world is None else load_world(world),
            robot=robot if has_robot else None,
            seed=7,
            has_camera=True,
            profile=SceneProfile(),
        )
    )
    assert (job.scanner is not None) is has_scanner
    assert (job.drawing is None) is (job.route is None) is (world is None)
    assert (job.columns, job.tick_hz, job.has_camera) == (("a", "b"), 200, True)
