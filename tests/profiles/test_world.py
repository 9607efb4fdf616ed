"""Worlds: what is refused, and that the shipped one closes."""

import pytest

from simconsole.profiles.files.loader import load, parse, to_text
from simconsole.profiles.world import ArenaProfile, CourseProfile, Primitive
from simconsole.values.errors import ProfileError
from tests.profiles.refused import refusal

HEAD = "schema: 1\ntitle: t\nlane_width_m: 3.5\nspeed_limit_kmh: 50\nlength_m: 10\n"
LINE = "{kind: line, s_m: 0, x_m: 0, y_m: 0, yaw_rad: 0, length_m: 10, curvature_start_1pm: 0, curvature_end_1pm: 0}"


@pytest.mark.parametrize("name", ["urban"])
def test_shipped_courses_have_no_gap_in_distance_or_curvature(name: str) -> None:
    world = load("worlds", name, CourseProfile)
    s_m = 0.0
    for part, following in zip(world.path, (*world.path[1:], world.path[0]), strict=True):
        assert part.s_m == pytest.approx(s_m, abs=1e-6)
        s_m += part.length_m
        assert part.curvature_end_1pm == pytest.approx(following.curvature_start_1pm, abs=1e-9)
        if part.kind != "clothoid":
            assert part.curvature_start_1pm == part.curvature_end_1pm
    assert s_m == pytest.approx(world.length_m)


def test_a_written_world_comes_back() -> None:
    world = parse(f"{HEAD}path: [{LINE}]\n", CourseProfile, "f.yaml")
    assert isinstance(world.path[0], Primitive)
    assert parse(to_text(world), CourseProfile, "f.json") == world


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("path: []", "path: "),
        (f"path: [{LINE.replace('line', 'spline')}]", 'path[0].kind: value "spline": one of '),
        (f"path: [{LINE.replace('length_m: 10', 'length_m: 0')}]", "path[0].length_m: value 0: "),
        (f"path: [{LINE.replace('start_1pm: 0', 'start_1pm: 1.1')}]", "path[0].curvature_start_1pm: value 1.1: "),
        (f"path: [{LINE}]\ncrossings: [{{s_m: -1, width_m: 4}}]", "crossings[0].s_m: value -1: "),
        (f"path: [{LINE}]\nintersections: [{{s_m: 1, arm_m: 20}}]", "intersections[0].signalled: value missing: "),
        (f"path: [{LINE}]\nroundabout: []", "roundabout: value []: unknown key, did you mean roundabouts?"),
    ],
)
def test_what_cannot_be_meant_is_refused(text: str, told: str) -> None:
    assert told in refusal(f"{HEAD}{text}\n", CourseProfile)


ARENA = """schema: 1
kind: arena
title: t
walls: [{points: [{x_m: 0, y_m: 0}, {x_m: 4, y_m: 0}]}]
pillars: [{x_m: 2, y_m: 2, radius_m: 0.5}]
starts: [{name: a, x_m: 1, y_m: 1}]
targets: [{name: A, x_m: 3, y_m: 1}]
"""


@pytest.mark.parametrize(
    ("written", "instead", "told"),
    [
        ("{x_m: 4, y_m: 0}", "{x_m: 0, y_m: 0}", r"walls\[0\]\.points: the same point twice"),
        ("{x_m: 4, y_m: 0}", "{x_m: 4000, y_m: 0}", r"walls\[0\]\.points\[1\]\.x_m: value 4000: .*500"),
        ("{x_m: 4, y_m: 0}", "{x_m: 4, z_m: 0}", r"walls\[0\]\.points\[1\]\.z_m"),
        ("{x_m: 0, y_m: 0}, ", "", r"walls\[0\]\.points"),
        ("radius_m: 0.5", "radius_m: -1", r"pillars\[0\]\.radius_m: value -1"),
        ("x_m: 1, y_m: 1", "x_m: 1, y_m: 0.05", r"starts: a is 0\.050 m from a wall"),
        ("x_m: 3, y_m: 1", "x_m: 2.2, y_m: 1.9", r"targets: A is -0\.\d+ m from a wall or a pillar"),
        (
            "[{name: A, x_m: 3, y_m: 1}]",
            "[{name: A, x_m: 3, y_m: 1}, {name: A, x_m: 3, y_m: 1}]",
            "targets: a name twice",
        ),
        ("starts: [{name: a, x_m: 1, y_m: 1}]", "starts: []", "starts: value"),
        ("name: a", "name: a b", r"starts\[0\]\.name: value"),
        ("title: t", "title: t\ncolour: red", "colour"),
    ],
)
def test_an_arena_that_contradicts_itself_is_refused(written: str, instead: str, told: str) -> None:
    assert parse(ARENA, ArenaProfile, "f.yaml").walls[0].closed is False
    with pytest.raises(ProfileError, match=f"f.yaml: .*{told}") as refused:
        parse(ARENA.replace(written, instead), ArenaProfile, "f.yaml")
    assert "\n" not in str(refused.value)
