"""The depth camera of a robot against closed forms: walls of any height, robots, floor and nothing."""

import math

import numpy as np
import pytest

from simconsole.profiles.parts.depth_camera import DepthCameraProfile
from simconsole.profiles.validation import convert
from simconsole.profiles.world import ArenaProfile
from simconsole.values.host.jit import plain
from simconsole.values.platform import Pose
from simconsole.world.arena.depth_camera import DepthCamera
from tests.samples import Sample

LENS = DepthCameraProfile(
    width_px=33, height_px=25, horizontal_fov_deg=60.0, min_m=0.2, max_m=4.0, x_m=0.1, z_m=0.1
)  # fmt: skip
MIDDLE = (12, 16)
"""The pixel on the camera's axis."""


def wall(at_m: float, height_m: float, reach_m: float = 30.0) -> dict[str, object]:
    """A wall across the robot's way."""
    points = [{"x_m": at_m, "y_m": -reach_m}, {"x_m": at_m, "y_m": reach_m}]
    return {"points": points, "height_m": height_m}


def camera(*walls: dict[str, object], pillars: tuple[dict[str, float], ...] = (), others_m: float = 0.2) -> DepthCamera:
    plain_arena = {"schema": 1, "title": "t", "walls": list(walls), "pillars": list(pillars)}
    starts = [{"name": "s", "x_m": -90.0, "y_m": 0.0}]
    return DepthCamera(LENS, convert(plain_arena | {"starts": starts}, ArenaProfile, "test"), others_m, plain)


def rises() -> np.ndarray:
    """How far the rays of each row rise per m along the axis."""
    return -(np.arange(LENS.height_px) - MIDDLE[0]) / LENS.focal_px


def test_a_wall_across_is_as_far_in_every_pixel_that_it_fills_and_the_floor_lies_before_it() -> None:
    image = camera(wall(2.1, 0.5)).image(Pose(0.0, 0.0, 0.0))
    heights = 0.1 + 2.0 * rises()
    for row, height in enumerate(heights):
        if height > 0.5:
            assert np.isposinf(image[row]).all(), "above it is nothing"
        elif height >= 0.0:
            assert image[row] == pytest.approx(2.0), "along the axis, not along the ray"
        else:
            assert image[row] == pytest.approx(0.1 / -rises()[row]), "the floor"
    assert image[MIDDLE] == pytest.approx(2.0)


def test_a_low_wall_hides_only_the_foot_of_a_higher_one_behind_it() -> None:
    image = camera(wall(1.1, 0.15), wall(3.1, 1.5)).image(Pose(0.0, 0.0, 0.0))
    over_low, over_high = 0.1 + 1.0 * rises(), 0.1 + 3.0 * rises()
    for row in range(MIDDLE[0] + 1):
        expected = 1.0 if over_low[row] <= 0.15 else 3.0 if over_high[row] <= 1.5 else math.inf
        assert image[row] == pytest.approx(np.full(LENS.width_px, expected)), f"row {row}"
    assert {1.0, 3.0} <= {round(float(value), 6) for value in image[:, 16]}


def test_what_is_out_of_range_is_told_apart_and_is_no_point() -> None:
    far, near = (camera(wall(at_m, 5.0)).image(Pose(0.0, 0.0, 0.0)) for at_m in (4.2, 0.25))
    assert np.isposinf(far[MIDDLE])
    assert np.isneginf(near[MIDDLE])
    assert np.isnan(camera(wall(4.2, 5.0)).points(far)[MIDDLE]).all()


def test_robots_and_pillars_are_seen_up_to_their_height() -> None:
    pillar = {"x_m": 1.1, "y_m": 0.0, "radius_m": 0.1, "height_m": 0.14}
    for seen, others in (
        (camera(wall(3.1, 2.0), pillars=(pillar,)), np.empty((0, 3))),
        (camera(wall(3.1, 2.0), others_m=0.14), np.array([(1.1, 0.0, 0.1)])),
    ):
        image = seen.image(Pose(0.0, 0.0, 0.0), others)
        assert image[MIDDLE] == pytest.approx(0.9)
        over = int(np.flatnonzero(0.1 + 0.9 * rises() > 0.14)[-1])
        assert image[over, MIDDLE[1]] == pytest.approx(3.0), "the wall over its head"
        assert image[MIDDLE[0], 0] == pytest.approx(3.0), "and beside it"


def test_points_lie_on_what_was_seen_wherever_the_robot_stands(sample: Sample) -> None:
    draw = np.random.default_rng(sample.seed)
    for _ in range(sample.of(20, 2000)):
        ends = draw.uniform(-3.0, 3.0, (2, 2))
        high = float(draw.uniform(0.12, 1.0))
        points = [{"x_m": float(x), "y_m": float(y)} for x, y in ends]
        x_m, y_m, yaw_rad = draw.uniform((-2.0, -2.0, -3.0), (2.0, 2.0, 3.0)).tolist()
        pose = Pose(x_m, y_m, yaw_rad)
        seen = camera({"points": points, "height_m": high})
        found = seen.points(seen.image(pose)).reshape(-1, 3).astype(np.float64)
        right, down, ahead = found[np.isfinite(found).all(axis=1)].T
        height = LENS.z_m - down
        cosine, sine = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        x = pose.x_m + (LENS.x_m + ahead) * cosine + right * sine
        y = pose.y_m + (LENS.x_m + ahead) * sine - right * cosine
        way = ends[1] - ends[0]
        off_m = np.abs((x - ends[0, 0]) * way[1] - (y - ends[0, 1]) * way[0]) / np.hypot(*way)
        on_floor = np.abs(height) < 1e-3
        assert (on_floor | ((off_m < 1e-3) & (height > -1e-3) & (height < high + 1e-3))).all(), "within 1 mm"


def test_depths_out_of_order_are_refused() -> None:
    with pytest.raises(ValueError, match="min_m"):
        DepthCameraProfile(
            width_px=9, height_px=9, horizontal_fov_deg=60.0, min_m=2.0, max_m=1.0, x_m=0.0, z_m=0.1
        )  # fmt: skip
