"""Lamps of traffic lights that shine, as points for the operators. Pure arrays, no rerun."""

from collections import deque
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.scene.entities import Array, Colour, light_places
from simconsole.values.units import NS_PER_S
from simconsole.world.drawing import Drawing
from simconsole.world.roads.running import NONE_RUNNING
from simconsole.world.rules.lamps import Lamps, Lit
from simconsole.world.traffic.road_users import RoadUsersAt

LIT: Final[tuple[Colour, ...]] = ((255, 64, 52), (255, 184, 40), (62, 232, 124))
LOOKS_HZ: Final = 10
"""How often the lamps are looked at: a change shows at most so much later."""


class LampShapes(NamedTuple):
    """The lamps that shine from each change on, one change after the other."""

    times_ns: NDArray[np.int64]  # [changes]
    counts: list[int]  # how many lamps shine after each
    centres: Array  # [lamps, 3]
    colours: list[Colour]


class LampChanges:
    """Follows the lamps of a drawing through a drive."""

    def __init__(self, drawing: Drawing | None, tick_hz: int) -> None:
        lights = () if drawing is None else drawing.lights
        self._lamps = Lamps(lights)
        self._centres = np.zeros((0, 3, 3)) if drawing is None else light_places(drawing)[1]
        self._tick_hz = tick_hz
        self._stride = max(1, tick_hz // LOOKS_HZ)
        self._seen: list[Lit] = []
        self._looked_at = -1
        self._signals = NONE_RUNNING

    def until(self, tick: int, steps: Sequence[RoadUsersAt] = ()) -> LampShapes | None:
        """Return what has changed since the last call, up to `tick`; None: nothing.

        Another simulator's signals come with the `steps` of traffic that no call before had.
        """
        changes: list[tuple[int, list[Lit]]] = []
        place, coming = self._looked_at + 1, deque(steps)
        while place * self._stride <= tick:
            while coming and coming[0].tick <= place * self._stride:
                self._signals = coming.popleft().signals
            lit = self._lamps.lit(place * self._stride, self._tick_hz, self._signals)
            if lit != self._seen:
                self._seen = lit
                changes.append((place * self._stride, lit))
            self._looked_at = place
            place += 1
        if coming:
            self._signals = coming[-1].signals
        if not changes:
            return None
        shining = [one for _, lit in changes for one in lit]
        return LampShapes(
            times_ns=np.array([at * NS_PER_S // self._tick_hz for at, _ in changes], np.int64),
            counts=[len(lit) for _, lit in changes],
            centres=np.array([self._centres[one.light, one.lamp] for one in shining]).reshape(-1, 3),
            colours=[LIT[one.lamp] for one in shining],
        )
