import math

import numpy as np
import pytest

from simconsole.drivers.robots.slam.odometry_track import OdometryTrack
from simconsole.drivers.robots.slam.planar import composed
from simconsole.drivers.robots.slam.rays import Turn, rays_of
from simconsole.values.platform import Pose

MOUNT = Pose(-0.1, 0.02, 0.3)


def turn(ranges: list[float], time_step_s: float = 0.01) -> Turn:
    count = len(ranges)
    return Turn(2.0, np.array(ranges), 0.0, math.tau / count, time_step_s, 0.12, 3.5)


def test_each_ray_begins_where_the_lidar_was_and_all_are_seen_from_the_end() -> None:
    track = OdometryTrack()
    for step in range(200):
        track.add(1.0 + 0.01 * step, Pose(0.02 * step, 0.5, 0.05 * step))
    found = rays_of(turn([1.0, 2.0, 1.5, 0.5, 1.0, 1.0, 2.0, 3.0]), MOUNT, track)
    assert found.odometry == pytest.approx((0.02 * 108, 0.5, 0.05 * 108))
    for ray, range_m in enumerate((1.0, 2.0, 1.5, 0.5, 1.0, 1.0, 2.0, 3.0)):
        base = Pose(0.02 * (100 + ray), 0.5, 0.05 * (100 + ray))
        lidar = composed(base, MOUNT)
        hit = composed(lidar, Pose(range_m * math.cos(ray * math.tau / 8), range_m * math.sin(ray * math.tau / 8), 0.0))
        begin, end = (
            composed(found.odometry, Pose(found.lines_m[ray, at], found.lines_m[ray, at + 1], 0.0)) for at in (0, 2)
        )
        assert begin[:2] == pytest.approx(lidar[:2])
        assert end[:2] == pytest.approx(hit[:2])


def test_what_is_out_of_range_says_nothing_and_infinity_says_free() -> None:
    track = OdometryTrack()
    track.add(1.0, Pose(0.0, 0.0, 0.0))
    found = rays_of(turn([0.0, math.inf, math.nan, 1.0, 3.6, 0.1, 3.5, 2.0]), Pose(0.0, 0.0, 0.0), track)
    assert found.echo.tolist() == [0.0, 1.0, 1.0, 1.0]
    assert np.hypot(*found.lines_m[0, 2:]) == pytest.approx(3.5)
    assert len(found.points_m) == 3
