"""How vehicles of traffic let people cross: the next strip ahead that is not free is a line to stop at."""

from typing import Final, NamedTuple

from simconsole.values.kernels import Row, kernel
from simconsole.world.traffic_columns import COUNT, LANES

FAR_M: Final = 1e6
_PASSED_M: Final = 0.3  # whose front is further than this on the crossing drives on


class Crossed(NamedTuple):
    """Where lanes lead over crossings, and which of these strips are not free."""

    over: Row  # int64, strips lane by lane
    over_starts: Row  # int64 [lanes + 1]
    near_m: Row  # float64 [strips], way along the lane to the crossing
    occupied: Row  # int64 [strips]


@kernel
def occupied_ahead(lengths_m: Row, path: Row, front_m: float, crossed: Crossed, reach_m: float) -> float:
    """Return how far the next occupied strip on a path is from a front `front_m` along it; FAR_M: none in reach."""
    start = 0.0
    for slot in range(path[COUNT]):
        if start > front_m + reach_m:
            break
        lane = path[LANES + slot]
        best = FAR_M
        for place in range(crossed.over_starts[lane], crossed.over_starts[lane + 1]):
            strip = crossed.over[place]
            left = start + crossed.near_m[strip] - front_m
            if crossed.occupied[strip] == 1 and -_PASSED_M <= left < best:
                best = left
        if best < reach_m:
            return best
        start += lengths_m[lane]
    return FAR_M
