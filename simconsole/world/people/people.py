"""Those who walk over the crossings of a map, by a seed; who has gone is followed by others."""

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np

from simconsole.values.kernels import holding
from simconsole.world.people.crossings import crossings_of
from simconsole.world.people.footways import Footways, footways
from simconsole.world.people.walking import (
    ASIDE,
    PACE,
    PERSON,
    RESTS,
    SIZE_M,
    WALK,
    WAY,
    Crowd,
    Others,
    Walkers,
    put_on_way,
    step_people,
)
from simconsole.world.people.yielding import Crossed
from simconsole.world.roads.road_map import Array, RoadMap
from simconsole.world.traffic_columns import BOX, LANE, LENGTH, SPEED, WIDTH

PACE_MPS: Final = 1.34
"""How fast people walk, and how much that varies: Weidmann, Transporttechnik der Fussgänger, Schriftenreihe des IVT 90,
ETH Zurich 1993."""
PACE_DEVIATION_MPS: Final = 0.26
SLOWEST_MPS: Final = 0.8
FASTEST_MPS: Final = 2.0
REST_S: Final = (1.0, 20.0)
"""So long nobody comes after somebody has gone."""
_GREEN: Final = "Gg"


class People:
    """All people on foot of a map; equal maps, numbers and seeds give equal bits."""

    def __init__(self, road_map: RoadMap, count: int, seed: int, execution: Callable[[Any], Any]) -> None:
        """Let `count` people come, nobody on a map without crossings; `execution` is how kernels run."""
        crossings = crossings_of(road_map) if count else []
        self._ways: Footways = footways(road_map, crossings)
        self._signals = [(crossing.signal, crossing.link) for crossing in crossings]
        self._rng = np.random.default_rng((seed, 1))
        self._execution, self._put = execution, execution(put_on_way)
        strips = len(self._ways.near_m)
        self._crowd = Crowd(np.ones(len(crossings), np.int64), np.zeros(strips, np.int64))
        self.crossed = Crossed(self._ways.over, self._ways.over_starts, self._ways.near_m, self._crowd.occupied)
        self.rows: Array = np.zeros((count if crossings else 0, PERSON))
        for row in self.rows:
            self._come(row, anywhere=True)

    @property
    def boxes(self) -> Array:
        """Where people are, float64 [people, BOX]."""
        return self.rows[:, :BOX]

    def meet(self, others: Others) -> None:
        """Let people look at those who are not on foot: in arrays that stay where they are."""
        walkers = Walkers(self._ways, self.rows, self._crowd, others)
        self._step_all: Callable[[float], None] = holding(self._execution(step_people), walkers)

    def step(self, shown: Sequence[str], period_s: float) -> list[int]:
        """Move everybody on while signals show `shown`; return who has come anew. They must have met the others."""
        if not len(self.rows):
            return []
        for number, (signal, link) in enumerate(self._signals):
            self._crowd.walks[number] = signal < 0 or _is_green(shown[signal], link)
        self._step_all(period_s)
        return [
            place for place in np.flatnonzero(self.rows[:, LENGTH] == 0.0).tolist() if self._waited(place, period_s)
        ]

    def fall(self, place: int) -> None:
        """Let somebody lie where they are."""
        self.rows[place, PACE] = self.rows[place, SPEED] = 0.0

    def _waited(self, place: int, period_s: float) -> bool:
        """Return whether somebody comes now in the place of who has gone."""
        row = self.rows[place]
        if row[RESTS] == 0.0:
            row[RESTS] = self._rng.uniform(*REST_S)
        row[RESTS] -= period_s
        if row[RESTS] > 0.0:
            return False
        self._come(row, anywhere=False)
        return True

    def _come(self, row: Array, *, anywhere: bool) -> None:
        rng, ways = self._rng, self._ways
        way = int(rng.integers(len(ways.kerbs_m)))
        row[:] = 0.0
        row[LENGTH] = row[WIDTH] = SIZE_M
        row[LANE] = -1.0
        row[WALK] = way
        row[WAY] = float(ways.kerbs_m[way]) * float(rng.random()) if anywhere else 0.0
        room = 0.5 * float(ways.widths_m[way]) - SIZE_M
        row[ASIDE] = float(rng.uniform(-room, room)) if room > 0.0 else 0.0
        drawn = float(rng.normal(PACE_MPS, PACE_DEVIATION_MPS))
        row[PACE] = row[SPEED] = min(max(drawn, SLOWEST_MPS), FASTEST_MPS)
        self._put(ways, row)


def _is_green(letters: str, link: int) -> bool:
    return link >= len(letters) or letters[link] in _GREEN
