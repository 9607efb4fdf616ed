from typing import Any

import msgspec
import pytest

from simconsole.profiles.course_plan import CoursePlan
from simconsole.values.errors import ProfileError
from simconsole.world.path_geometry import Piece, travel
from simconsole.world.planning import ORIGIN, solve

CORNER = {"element": "curve", "radius_m": 20, "angle_deg": 90}
FREE = {"element": "straight", "length_m": "free"}


def square(**changes: Any) -> CoursePlan:
    values: dict[str, Any] = {
        "schema": 1,
        "title": "square",
        "lane_width_m": 3.5,
        "speed_limit_kmh": 50,
        "length_m": 600,
        "elements": [FREE, CORNER, FREE, CORNER, FREE, CORNER, {"element": "straight", "length_m": 100}, CORNER],
    }
    return msgspec.convert({**values, **changes}, CoursePlan)


def test_square_closes_at_its_length() -> None:
    world = solve(square(), "square")
    pose = ORIGIN
    for part in world.path:
        assert (pose.x_m, pose.y_m, pose.yaw_rad) == pytest.approx((part.x_m, part.y_m, part.yaw_rad), abs=1e-9)
        pose = travel(pose, Piece(part.length_m, part.curvature_start_1pm, part.curvature_end_1pm))
    assert (pose.x_m, pose.y_m) == pytest.approx((0.0, 0.0), abs=1e-8)
    assert world.length_m == pytest.approx(600.0, abs=1e-8)
    assert world.path[4].length_m == pytest.approx(100.0, abs=1e-8)  # opposite the straight of 100 m


def test_features_stand_where_the_plan_says() -> None:
    straight = {"element": "straight", "length_m": 100, "features": [{"feature": "crossing", "at_m": 30}]}
    world = solve(square(elements=[FREE, CORNER, FREE, CORNER, FREE, CORNER, straight, CORNER]), "square")
    before = sum(part.length_m for part in world.path[:12])
    assert world.crossings[0].s_m == pytest.approx(before + 30.0, abs=1e-8)


def test_roundabout_stands_on_the_axis_of_both_roads() -> None:
    ring = {"element": "roundabout", "radius_m": 18, "entry_radius_m": 25, "turn_deg": 90}
    world = solve(square(elements=[FREE, CORNER, FREE, CORNER, FREE, CORNER, FREE | {"length_m": 150}, ring]), "ring")
    spot = world.roundabouts[0]
    entry = next(part for part in world.path if part.s_m == spot.s_m)
    assert entry.yaw_rad == pytest.approx(4.71238898, abs=1e-6)  # southwards
    assert spot.x_m - entry.x_m == pytest.approx(1.75, abs=1e-6)  # left of a southbound lane is east
    assert spot.y_m == pytest.approx(1.75, abs=1e-6)  # the lane to the east is the one from the origin along +x
    arcs = [part for part in world.path if part.kind == "arc" and part.curvature_start_1pm == pytest.approx(1 / 18)]
    assert len(arcs) == 1


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"elements": [FREE, CORNER, FREE, CORNER, FREE, CORNER, FREE]}, "turns 270.000000 deg"),
        ({"elements": [FREE, CORNER, FREE, CORNER, FREE, CORNER, FREE, CORNER]}, "4 straights are free"),
        ({"elements": [FREE, FREE, CORNER, FREE, CORNER, CORNER, CORNER]}, "different directions"),
        ({"length_m": 300}, "must be above 0"),
        ({"elements": [FREE, {"element": "curve", "radius_m": 8, "angle_deg": 45}, FREE]}, "too long for 45 deg"),
        (
            {
                "elements": [
                    *(FREE, CORNER, FREE, CORNER, FREE, CORNER),
                    {"element": "straight", "length_m": 100, "features": [{"feature": "crossing", "at_m": 100}]},
                    CORNER,
                ]
            },
            "100 is beyond its straight",
        ),
    ],
)
def test_impossible_plan_is_refused_by_name(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(ProfileError, match=words) as caught:
        solve(square(**changes), "plan.yaml")
    assert str(caught.value).startswith("plan.yaml: ")
    assert "\n" not in str(caught.value)


def test_a_plan_without_a_length_is_an_open_course() -> None:
    world = solve(square(length_m=None, elements=[{"element": "straight", "length_m": 30}, CORNER]), "open")
    assert world.length_m == pytest.approx(30.0 + world.path[1].length_m * 2 + world.path[2].length_m)
    assert [part.kind for part in world.path] == ["line", "clothoid", "arc", "clothoid"]


def test_free_straights_need_a_length_to_close() -> None:
    with pytest.raises(ProfileError, match="open: length_m: value missing"):
        solve(square(length_m=None), "open")
