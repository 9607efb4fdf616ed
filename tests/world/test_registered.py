"""A world of another package: installed beside us, driven in, replayed, and refused where it is wrong."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from simconsole.profiles.world import OwnWorldProfile
from simconsole.values.errors import ProfileError
from simconsole.values.registered import Bounded
from simconsole.world.kinds.worlds import open_world
from simconsole.world.registered import GROUP, OwnWorld, make_own
from simconsole.world.world import World
from tests.drives.console import environment
from tests.drives.console import simconsole as command
from tests.installed import installed
from tests.paths import ROOT
from tests.world.made import world

USED = """
import sys
import simconsole
from simconsole.cli.main import main
session = simconsole.load("bridge").with_values({"environment.world": sys.argv[1] + "/quick.yaml"})
assert session.route.closed and abs(session.route.length_m - 388.5) < 0.1, session.route.length_m
route, place = session.route, 0.0
def controller(seen):
    global place
    place, lateral_m, _ = route.project(seen.vehicle.x_m, seen.vehicle.y_m, place)
    bend = 2.6 * route.curvature_at(place + 2.0)
    return simconsole.hold_speed(8.0, bend - 0.1 * lateral_m)
drive = session.run(controller, duration_s=14.0, out=sys.argv[1] + "/bundle")
assert drive.metrics["autonomous"]["lateral_max_m"] < 1.5, drive.metrics["autonomous"]
assert abs(drive.column("vehicle.pitch_rad")).max() > 0.005
assert drive.replay().hashes_equal
assert main(["verify", sys.argv[1] + "/bundle"]) == 0
assert main(["report", sys.argv[1] + "/bundle"]) == 0
flat = session.with_values({"world.parameters.hill_m": 0.0, "world.parameters.straight_m": 50.0})
assert abs(flat.route.length_m - 288.5) < 0.1
level = flat.run(lambda seen: simconsole.hold_speed(8.0), duration_s=4.0)
assert (level.column("vehicle.z_m")[0] == level.column("vehicle.z_m")).all()
assert main(["world", "show", sys.argv[1] + "/quick.yaml"]) == 0
"""


def test_a_world_of_another_package_is_driven_in_and_replays(tmp_path: Path) -> None:
    assert command("new", "place", "quick", "--out", tmp_path).returncode == 0
    installed(tmp_path, GROUP, quick="WORLD")
    path = os.pathsep.join((str(tmp_path), str(ROOT)))
    words = [sys.executable, "-c", USED, str(tmp_path)]
    done = subprocess.run(words, capture_output=True, text=True, check=False, env=environment(PYTHONPATH=path))
    assert done.returncode == 0, done.stdout + done.stderr


def profile(**parameters: float) -> OwnWorldProfile:
    return OwnWorldProfile(schema=1, title="quick", name="quick", parameters=parameters)


def own(made: Callable[[Any], Any]) -> OwnWorld:
    return OwnWorld({"radius_m": Bounded(30.0, 8.0, 500.0)}, made)


def fails(settings: object) -> World:
    raise KeyError("map")


@pytest.mark.parametrize(
    ("made", "told"),
    [
        (fails, "KeyError: 'map'"),
        (lambda settings: None, "NoneType: a World"),
        (lambda settings: world(route=None), "route: NoneType: a Route"),
    ],
)
def test_what_is_no_world_is_one_line(made: Callable[[Any], Any], told: str) -> None:
    with pytest.raises(ProfileError, match=rf"^world: name: value quick: {told}$"):
        make_own(profile(), own(made))


def test_parameters_are_inside_their_bounds_and_equal_profiles_are_one_world() -> None:
    seen: list[Any] = []

    def made(settings: Any) -> World:
        seen.append(settings.parameters)
        return world()

    make_own(profile(radius_m=9.0), own(made))
    assert seen == [{"radius_m": 9.0}]
    with pytest.raises(ProfileError, match=r"^world: parameters: radius_m: value 7: 8 to 500$"):
        make_own(profile(radius_m=7.0), own(made))
    with pytest.raises(ProfileError, match=r"^world: name: value quick: one of "):
        open_world(profile())
    assert hash(profile(radius_m=9.0)) == hash(profile(radius_m=9.0))
    assert profile(radius_m=9.0) != profile(radius_m=8.0)
