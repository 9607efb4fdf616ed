"""What a learner does again and again, in one compiled call: command, make the ticks until the next, look at the lane.

As calls of their own, with their arrays handed over each time, they took as long as a tick more.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any, Final, NamedTuple

from simconsole.tick.advance import Console, Execution, Stage, constants
from simconsole.values.kernels import Row, holding, kernel
from simconsole.values.signals import RemoteKind
from simconsole.values.state_vector import LAYOUT
from simconsole.world.lane_view import Path, lane_view
from simconsole.world.rules.road_rules import RoadRules

_ROS: Final = LAYOUT.ros
_SEQUENCE, _KIND, _WHEEL = _ROS.at("sequence"), _ROS.at("kind"), _ROS.at("road_wheel_rad")
_SPEED, _ACCEL = _ROS.at("speed_mps"), _ROS.at("accel_mps2")

LearnerStep = Callable[[float, float, Row], bool]
"""A function of the road-wheel angle in rad, left-positive, of the speed in m/s or acceleration in m/s2 that is asked
for, and of an array for what is seen then (`lane_view`). It returns whether automation drives."""


class _Held(NamedTuple):
    """What stays where it is from step to step."""

    rows: Row
    kind: float
    asked_at: int
    path: Path
    place: Row
    roads: RoadRules | None
    constants: tuple[Row, Row, Row, Row, Row, float, int]


def learner_step(
    console: Console, rows: Row, kind: RemoteKind, path: Path, place: Row, execution: Execution
) -> LearnerStep:
    """Return the call that makes a learner's steps. Its arrays are held: write into them to begin anew.

    Args:
        console: whose ticks.
        rows: float64 [1 + ticks of a step, columns]: the state vector, then the inputs of the ticks; a step writes what
            it commands into these.
        kind: what is asked for beside the angle: SPEED or ACCELERATION.
        path: beside which the vehicle is.
        place: where on it, see `lane_view`; it is followed.
        execution: that of the console.
    """
    held = _Held(
        rows=rows,
        kind=float(kind),
        asked_at=_SPEED if kind == RemoteKind.SPEED else _ACCEL,
        path=path,
        place=place,
        roads=console.roads,
        constants=constants(console),
    )
    if console.platform.compiled:
        return holding(execution(_step_of(console.ticks, lane_view)), held)
    return holding(_step_of(console.ticks, execution(lane_view)), held)


@lru_cache(maxsize=8)  # environments that are alike have one
def _step_of(ticks: Stage, look: Callable[..., bool]) -> Callable[..., Any]:
    @kernel
    def step(held: _Held, road_wheel_rad: float, asked: float, seen: Row) -> bool:
        rows = held.rows
        state, last = rows[0], rows[len(rows) - 1]
        sequence = state[_SEQUENCE] + 1.0
        for index in range(1, len(rows)):
            rows[index, _SEQUENCE] = sequence
            rows[index, _KIND] = held.kind
            rows[index, _WHEEL] = road_wheel_rad
            rows[index, held.asked_at] = asked
        ticks(held.roads, state, rows[1:], *held.constants)
        for column in range(len(state)):
            state[column] = last[column]
        return look(held.path, state, held.place, seen)

    return step
