"""The picture of a team's mission: the map that SLAM made, the ways that were driven, the targets."""

from typing import Any, Final

import numpy as np

from simconsole.evaluation.report.figures import figure
from simconsole.evaluation.robots.mission_result import MissionResult
from simconsole.world.arena.arena_world import ArenaWorld
from simconsole.world.arena.occupancy import FREE, OCCUPIED

COLOURS: Final = ("#1f6fb2", "#d1602e", "#2f8f5b", "#8a5fb0", "#b08a2f")
_SIZE_INCH: Final = (9.2, 6.6)


def mission_svg(result: MissionResult, arena: ArenaWorld) -> str:
    """Return the picture as SVG."""
    made = figure(_SIZE_INCH, lambda drawn: _draw(drawn, result, arena))
    return str(made._repr_svg_())


def _draw(drawn: Any, result: MissionResult, arena: ArenaWorld) -> None:
    axes, grid = drawn.add_subplot(), result.grid
    shades = np.full(grid.cells.shape, 0.8)
    shades[grid.cells == FREE] = 1.0
    shades[grid.cells == OCCUPIED] = 0.15
    rows, columns = grid.cells.shape
    right, top = grid.x_m + columns * grid.resolution_m, grid.y_m + rows * grid.resolution_m
    axes.imshow(shades, cmap="gray", vmin=0.0, vmax=1.0, origin="lower", extent=(grid.x_m, right, grid.y_m, top))
    for number, robot in enumerate(result.robots):
        colour = COLOURS[number % len(COLOURS)]
        axes.plot(*robot.way_m.T, color=colour, linewidth=1.4, label=robot.name)
        axes.plot(*robot.way_m[0], "o", color=colour, markersize=8)
        axes.plot(*robot.way_m[-1], "s", color=colour, markersize=8)
    for spot in arena.profile.targets:
        axes.plot(spot.x_m, spot.y_m, "x", color="black", markersize=9)
        axes.annotate(spot.name, (spot.x_m, spot.y_m), textcoords="offset points", xytext=(7, 5))
    axes.set_xlabel("x in map / m")
    axes.set_ylabel("y in map / m")
    axes.set_title("Map by SLAM; ways driven from the circles to the squares; targets")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=len(result.robots))
