"""Where the values of one vehicle stand in the arrays of traffic."""

from typing import Final

from simconsole.values.kernels import Row, kernel

# Rows of float64, one a vehicle. The first seven are those of any box on the road.
X: Final = 0  # of its middle, m in `map`
Y: Final = 1
COSINE: Final = 2  # of its heading
SINE: Final = 3
SPEED: Final = 4
LENGTH: Final = 5  # 0: not on the road
WIDTH: Final = 6
LANE: Final = 7  # of boxes that are not traffic: the lane they are on, -1 for none
ALONG: Final = 8  # and how far along it
BOX: Final = 9

S: Final = 9  # way of its middle from the beginning of its path, m
ACCELERATION: Final = 10
SPEED_SHARE: Final = 11  # of the limit, that it likes to drive
TIME_GAP: Final = 12
OFFSET: Final = 13  # left of its lane's centre where its change of lane began, m
CHANGED: Final = 14  # how far the change is done, 0 to 1
STOOD: Final = 15  # for how long, s
SINCE_CHANGE: Final = 16  # s
CRASHED: Final = 17  # 1: it has collided, and does nothing more than come to rest

VALUES: Final = 18

# Rows of int64, one a vehicle: its path, a window of lanes that moves along.
COUNT: Final = 0
DRAW: Final = 1  # state of its generator
LANES: Final = 2
SLOTS: Final = 32
CONNECTIONS: Final = LANES + SLOTS  # by which it leaves the lane of the same slot, -1: none, or inside a junction
GRANTS: Final = CONNECTIONS + SLOTS  # 1: it may go on over this connection
PATH: Final = GRANTS + SLOTS


@kernel
def drawn(path: Row, count: int) -> int:
    """Return a number below `count` from a vehicle's own generator (Lehmer's with the constants of ANSI C)."""
    path[DRAW] = (path[DRAW] * 1103515245 + 12345) % 2147483648
    return int((path[DRAW] // 65536) % count)
