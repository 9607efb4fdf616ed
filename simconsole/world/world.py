"""What every kind of world gives to those who drive in it, draw it or judge a drive: a route and a drawing."""

from collections.abc import Callable
from functools import cached_property
from typing import Final, NamedTuple

from simconsole.world.drawing import Drawing
from simconsole.world.earth import Earth
from simconsole.world.route import Route


class World:
    """One world, ready for use. The drawing is made when somebody asks for it."""

    def __init__(self, title: str, route: Route, draw: Callable[[], Drawing]) -> None:
        self.title = title
        self.route = route
        self._draw = draw

    @cached_property
    def drawing(self) -> Drawing:
        """Everything there is to draw."""
        return self._draw()


class ShownMap(NamedTuple):
    """What those outside are told of a world: how it looks, and where on the earth it lies."""

    drawing: Callable[[], Drawing | None] = lambda: None
    earth: Earth | None = None  # None: nobody knows


NO_MAP: Final = ShownMap()
