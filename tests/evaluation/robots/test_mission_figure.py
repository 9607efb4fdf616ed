from simconsole.evaluation.robots.mission_figure import mission_svg
from simconsole.profiles.files.world_files import load_world
from simconsole.world.arena.arena_world import arena_of
from simconsole.world.kinds.worlds import open_world
from tests.evaluation.robots.test_mission_result import GOOD


def test_map_ways_and_targets_are_drawn() -> None:
    world = arena_of(open_world(load_world("arena")))
    assert world is not None
    svg = mission_svg(GOOD, world)
    assert svg.rstrip().endswith("</svg>")
    assert "<image" in svg, "the map"
    assert svg.count("#1f6fb2") >= 2, "the first robot's way"
    assert svg.count("#d1602e") >= 2
