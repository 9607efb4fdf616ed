"""What every kind of world gives to those who drive in it, draw it or judge a drive: a route and a drawing."""

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

from simconsole.world.drawing import Drawing
from simconsole.world.roads.lane_graph import Leg
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.route import Route


class Roads(NamedTuple):
    """A road map, and the way that the world's route takes over it."""

    road_map: RoadMap
    legs: tuple[Leg, ...]


class World:
    """One world, ready for use. The drawing is made when somebody asks for it."""

    def __init__(self, title: str, route: Route, draw: Callable[[], Drawing], roads: Roads | None = None) -> None:
        self.title = title
        self.route = route
        self.roads = roads
        """None: a course, whose rules nobody has written down."""
        self._draw = draw

    @cached_property
    def drawing(self) -> Drawing:
        """Everything there is to draw."""
        return self._draw()
