import math

import numpy as np
import pytest

from simconsole.values.host.jit import plain
from simconsole.world.traffic.collisions import Struck, overlap, overlapping
from simconsole.world.traffic.road_users import NOBODY, Box, RoadUser, table
from tests.samples import Sample
from tests.world.traffic.made import box


def as_user(one: Box, number: float = 1.0) -> RoadUser:
    return RoadUser(
        id=number,
        kind=1.0,
        x_m=one.x_m,
        y_m=one.y_m,
        yaw_rad=one.yaw_rad,
        speed_mps=0.0,
        length_m=one.length_m,
        width_m=one.width_m,
        height_m=1.5,
    )


@pytest.mark.parametrize(
    ("other", "touch"),
    [
        (box(4.4, 0.0), True),
        (box(4.6, 0.0), False),
        (box(0.0, 1.7), True),
        (box(0.0, 1.9), False),
        (box(3.1, 0.0, math.pi / 2.0), True),
        (box(3.2, 0.0, math.pi / 2.0), False),
        (box(3.9, 1.9, math.pi / 4.0), True),
        (box(3.9, 3.4, math.pi / 4.0), False),
    ],
)
def test_boxes_touch_or_do_not(other: Box, touch: bool) -> None:
    assert overlap(box(0.0, 0.0), other) is touch
    assert overlap(other, box(0.0, 0.0)) is touch


def inside(one: Box, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    along = (x - one.x_m) * math.cos(one.yaw_rad) + (y - one.y_m) * math.sin(one.yaw_rad)
    aside = (y - one.y_m) * math.cos(one.yaw_rad) - (x - one.x_m) * math.sin(one.yaw_rad)
    return (np.abs(along) <= 0.5 * one.length_m) & (np.abs(aside) <= 0.5 * one.width_m)


def test_overlap_is_what_a_fine_raster_sees(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    x, y = (grid.ravel() for grid in np.meshgrid(np.arange(-4.0, 4.0, 0.05), np.arange(-4.0, 4.0, 0.05)))
    seen = 0
    for _ in range(sample.of(200, 5000)):
        one = box(0.0, 0.0, float(rng.uniform(-4, 4)))
        x_m, y_m, yaw_rad = (rng.uniform(-1, 1, 3) * (5.0, 5.0, 4.0)).tolist()
        other = box(x_m, y_m, yaw_rad)
        if bool((inside(one, x, y) & inside(other, x, y)).any()):
            seen += 1
            assert overlap(one, other)
        elif overlap(one, other):  # then less than the raster sees
            thinner = (one._replace(length_m=4.3, width_m=1.6), other._replace(length_m=4.3, width_m=1.6))
            assert not overlap(*thinner)
    assert seen > 20


def test_who_is_struck_and_which_pairs_overlap() -> None:
    users = table([as_user(box(0.5, 0.5), 1.0), as_user(box(30.0, 0.0), 2.0), as_user(box(31.0, 0.5), 3.0)])
    assert [user.id for user in Struck(plain).by(box(0.0, 0.0), users)] == [1.0]
    assert overlapping(users) == [(1, 2)]
    assert Struck(plain).by(box(0.0, 0.0), NOBODY) == []
