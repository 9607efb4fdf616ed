"""What every kind of world gives to those who drive in it, draw it or judge a drive: route, drawing and ground."""

from collections.abc import Callable
from functools import cached_property
from typing import Final, NamedTuple

from simconsole.values.height_field import HeightField
from simconsole.world.drawing import Drawing
from simconsole.world.earth import Earth
from simconsole.world.route import Route


class World:
    """One world, ready for use. Drawing and ground are made when somebody asks for them."""

    def __init__(
        self,
        title: str,
        route: Route,
        draw: Callable[[], Drawing],
        raise_ground: Callable[[], HeightField] | None = None,
    ) -> None:
        """Take a route, and what makes drawing and ground; without `raise_ground` the ground is flat."""
        self.title = title
        self.route = route
        self._draw = draw
        self._raise_ground = raise_ground

    @cached_property
    def drawing(self) -> Drawing:
        """Everything there is to draw."""
        flat = self._draw()
        return flat if self.ground is None else flat._replace(ground=self.ground)

    @cached_property
    def ground(self) -> HeightField | None:
        """The heights of the ground; None where it is flat."""
        return None if self._raise_ground is None else self._raise_ground()


class ShownMap(NamedTuple):
    """What those outside are told of a world: how it looks, and where on the earth it lies."""

    drawing: Callable[[], Drawing | None] = lambda: None
    earth: Earth | None = None  # None: nobody knows


NO_MAP: Final = ShownMap()
