import math

import numpy as np
import pytest

from simconsole.scene.road_user_shapes import CAR, VAN, road_user_shapes
from simconsole.world.traffic.road_users import NOBODY, RoadUser, RoadUserKind, RoadUsersAt, table


def user(kind: RoadUserKind, yaw_rad: float) -> RoadUser:
    return RoadUser(
        id=1.0,
        kind=float(kind),
        x_m=3.0,
        y_m=4.0,
        yaw_rad=yaw_rad,
        speed_mps=0.0,
        length_m=4.0,
        width_m=2.0,
        height_m=1.5,
    )


def test_boxes_stand_on_the_ground_and_look_along_their_heading() -> None:
    steps = [
        RoadUsersAt(0, table([user(RoadUserKind.CAR, math.pi / 2.0), user(RoadUserKind.VAN, 0.0)])),
        RoadUsersAt(10, NOBODY),
        RoadUsersAt(20, table([user(RoadUserKind.CAR, math.pi)])),
    ]
    shapes = road_user_shapes(steps, 250)
    assert shapes.times_ns.tolist() == [0, 40_000_000, 80_000_000]
    assert shapes.counts == [2, 0, 1]
    assert shapes.centres[0].tolist() == [3.0, 4.0, 0.75]
    assert shapes.half_sizes[0].tolist() == [2.0, 1.0, 0.75]
    assert shapes.quaternions[:2].tolist() == [pytest.approx([0, 0, math.sqrt(0.5), math.sqrt(0.5)]), [0, 0, 0, 1]]
    assert shapes.colours == [CAR, VAN, CAR]
    assert np.isfinite(shapes.centres).all()


def test_on_ground_with_height_they_stand_on_it() -> None:
    shapes = road_user_shapes([RoadUsersAt(0, table([user(RoadUserKind.CAR, 0.0)._replace(z_m=12.5)]))], 250)
    assert shapes.centres[0, 2] == 13.25
