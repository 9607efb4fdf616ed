"""Who sets off at green is let go, and who has waited long is let in: nobody waits at a junction without end."""

from collections.abc import Sequence
from typing import Final

from simconsole.world import traffic_columns as at
from simconsole.world.traffic.junctions import GIVE_WAY, GO
from simconsole.world.traffic.network import Network, Numbers

WAITED_S: Final = 10.0
"""After so long others keep the ways of who waits free, in turns: nobody knows whether they want to drive on at all."""
KEPT_S: Final = 10.0
SETS_OFF_S: Final = 5.0
"""So long after its light turned green the ways of who stands there are kept free."""
_STANDS_MPS: Final = 0.3
_AT_LINE_M: Final = 6.0


class Courtesy:
    """Watches a vehicle that is not traffic, and keeps its ways over the next junction free when it has waited."""

    def __init__(self, net: Network, lights: Numbers, kept_free: Numbers) -> None:
        """Write 1 into `kept_free` [connections] for each way that is kept free, else 0; `lights` may close one."""
        self._net, self._lights, self._kept_free = net, lights, kept_free
        self._stood_s = self._green_s = 0.0

    def step(self, box: Sequence[float], period_s: float) -> None:
        """Look at the vehicle's box, BOX values, once in a period."""
        if self._stood_s:
            self._kept_free[:] = 0
        if not self._waits(box):
            self._stood_s = self._green_s = 0.0
            return
        self._stood_s += period_s
        own = self._net.origins == int(box[at.LANE])
        green = own & (self._lights == GO)
        self._green_s = self._green_s + period_s if green.any() else 0.0
        if 0.0 < self._green_s < SETS_OFF_S:
            self._kept_free[green] = 1
        if self._stood_s % (WAITED_S + KEPT_S) >= WAITED_S:
            self._kept_free[own & (self._lights <= GIVE_WAY)] = 1

    def _waits(self, box: Sequence[float]) -> bool:
        lane = int(box[at.LANE])
        if box[at.LENGTH] == 0.0 or lane < 0 or abs(box[at.SPEED]) >= _STANDS_MPS:
            return False
        return bool(self._net.lengths_m[lane] - box[at.ALONG] - 0.5 * box[at.LENGTH] < _AT_LINE_M)
