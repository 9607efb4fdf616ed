"""What every kind of world gives to those who drive in it, draw it or judge a drive: a route and a drawing."""

from collections.abc import Callable
from functools import cached_property

from simconsole.world.drawing import Drawing
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
