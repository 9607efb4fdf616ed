"""The operators' screen: its views, and what the map shows whole. Made in a process of its own: rerun has threads."""

import json
import subprocess
import sys
from typing import Any

import pytest

from simconsole.scene.lanes import LANES, WHO_DRIVES
from simconsole.scene.plots import PLOTS, ROBOT_PLOTS
from simconsole.scene.viewer.standing import MAP
from tests.paths import ROOT

PROGRAM = """
import json
import numpy as np
from simconsole.scene.viewer.blueprint import blueprint
from tests.scene.drives import job

def views(part):
    inner = getattr(part, "contents", None)
    return [view for each in inner for view in views(each)] if isinstance(inner, (list, tuple)) else [part]

def shown(path, camera, robot=False):
    found, of = {}, job()
    of = of._replace(has_camera=camera, vehicle=of.vehicle._replace(is_robot=robot))
    for view in views(blueprint(of, path, is_live=True).root_container):
        bounds = view.properties.get("VisualBounds2D")
        found[view.name] = [view.origin, bounds and bounds.range.as_arrow_array().to_pylist()[0]]
    return found

way = np.array([[0.0, 10.0, 5.0], [100.0, 60.0, 5.0]])
print(json.dumps([shown(None, False), shown(way, True), shown(None, False, robot=True)]))
"""


@pytest.fixture(scope="module")
def shown() -> list[dict[str, Any]]:
    """Origin and bounds of each view by its name: without a path and with one, and those of a robot."""
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True, cwd=ROOT)
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


@pytest.fixture(scope="module")
def car(shown: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return shown[:2]


def test_every_plot_has_a_view_beside_lanes_chase_map_and_log(car: list[dict[str, Any]]) -> None:
    always = {"who drives", "chase", "health", "log", "controls", "latency", "map", *(plot.title for plot in PLOTS)}
    assert [set(found) for found in car] == [always, always | {"camera"}]
    for found in car:
        assert [found[plot.title][0] for plot in PLOTS] == [f"/{plot.path}" for plot in PLOTS]
        assert found["map"][0] == f"/{MAP}"


def test_a_robot_has_views_of_its_own_plots_and_none_of_a_cars_controls(shown: list[dict[str, Any]]) -> None:
    plots = {plot.title for plot in ROBOT_PLOTS}
    assert set(shown[2]) == {"who drives", "chase", "health", "log", "latency", "map", *plots}


def test_who_drives_stands_first_and_its_mode_above_all(shown: list[dict[str, Any]]) -> None:
    for found in shown:
        assert next(iter(found)) == "who drives"
        assert found["who drives"][0] == f"/{WHO_DRIVES}"
    lanes = sorted(kind.path for kind in LANES if kind.path.startswith(f"{WHO_DRIVES}/"))  # as rerun sorts them
    assert lanes[0] == f"{WHO_DRIVES}/mode"
    assert len(lanes) <= 3, "as many as have room"


def test_map_shows_the_whole_path_with_a_margin_and_its_y_down(car: list[dict[str, Any]]) -> None:
    without, with_path = (found["map"][1] for found in car)
    assert without is None
    assert with_path["x_range"] == pytest.approx([-6.0, 106.0])
    assert with_path["y_range"] == pytest.approx([-66.0, -4.0])
