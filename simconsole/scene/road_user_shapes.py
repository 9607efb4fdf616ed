"""Road users as boxes for the operators. Pure arrays, no rerun."""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.scene.entities import Array, Colour
from simconsole.values.units import NS_PER_S
from simconsole.world.traffic.road_users import RoadUserKind, RoadUsersAt

CAR: Final[Colour] = (92, 148, 214)
VAN: Final[Colour] = (148, 120, 206)
PEDESTRIAN: Final[Colour] = (226, 196, 92)


class RoadUserShapes(NamedTuple):
    """The boxes of several steps of traffic, one step after the other."""

    times_ns: NDArray[np.int64]  # [steps]
    counts: list[int]  # how many boxes each step has
    centres: Array  # [boxes, 3]
    half_sizes: Array  # [boxes, 3]
    quaternions: Array  # [boxes, 4], w last
    colours: list[Colour]


def road_user_shapes(steps: Sequence[RoadUsersAt], tick_hz: int) -> RoadUserShapes:
    """Return the boxes of steps of traffic, at least one."""
    users = np.vstack([step.users for step in steps])
    half = 0.5 * users[:, 6:9]
    nought = np.zeros(len(users))
    return RoadUserShapes(
        times_ns=np.array([step.tick * NS_PER_S // tick_hz for step in steps], np.int64),
        counts=[len(step.users) for step in steps],
        centres=np.column_stack((users[:, 2:4], users[:, 9] + half[:, 2])),
        half_sizes=half,
        quaternions=np.column_stack((nought, nought, np.sin(0.5 * users[:, 4]), np.cos(0.5 * users[:, 4]))),
        colours=[_colour(kind) for kind in users[:, 1].tolist()],
    )


def _colour(kind: float) -> Colour:
    return {RoadUserKind.VAN: VAN, RoadUserKind.PEDESTRIAN: PEDESTRIAN}.get(RoadUserKind(int(kind)), CAR)
