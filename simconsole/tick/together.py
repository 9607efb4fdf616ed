"""Several platforms in one session: all make the ticks of a period before any of them goes on.

What a platform reacts to is where the others were at the end of the period before. It is told that as an input, so that
its own recording makes its drive again (docs/decisions/0046-several-platforms.md).
"""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from simconsole.tick.advance import ConsoleState
from simconsole.values.kernels import Row
from simconsole.values.layout import read
from simconsole.values.state_vector import LAYOUT
from simconsole.values.trigonometry import cos, sin


class Body(NamedTuple):
    """What others see of a platform: a circle."""

    ahead_m: float  # its middle, of base_link
    radius_m: float


class Whereabouts:
    """Where the platforms of a session are, as the others are told."""

    def __init__(self, bodies: Sequence[Body], states: Sequence[ConsoleState]) -> None:
        """Start with the states before the first tick, in the order of the bodies."""
        self._bodies = bodies
        self._circles: list[tuple[float, ...]] = []
        self.renew(states)

    def renew(self, states: Sequence[ConsoleState]) -> None:
        """Tell from now on where the platforms are in these states."""
        self._circles = [_circle(state.vector, body) for state, body in zip(states, self._bodies, strict=True)]

    def seen_by(self, number: int) -> Callable[[], tuple[float, ...]]:
        """Return what tells the platform of this number of all others, in their order."""

        def others() -> tuple[float, ...]:
            circles = (circle for at, circle in enumerate(self._circles) if at != number)
            return tuple(value for circle in circles for value in circle)

        return others


def _circle(vector: Row, body: Body) -> tuple[float, ...]:
    vehicle = read(vector, LAYOUT.vehicle)
    x_m = vehicle.x_m + body.ahead_m * cos(vehicle.yaw_rad)
    return x_m, vehicle.y_m + body.ahead_m * sin(vehicle.yaw_rad), body.radius_m


def run_together(
    drives: Sequence[Iterator[ConsoleState]],
    states: Sequence[ConsoleState],
    whereabouts: Whereabouts,
    period_ticks: int,
    finished: Callable[[Sequence[ConsoleState]], bool] = lambda states: False,
) -> list[ConsoleState]:
    """Drive all platforms until one drive ends or `finished` says so; return their last states.

    Args:
        drives: of each platform, its `loop.steps`.
        states: of each before the first tick, all at the same tick.
        whereabouts: renewed after each period.
        period_ticks: how many ticks one of them makes before the next one does, as far as it foresees them.
        finished: asked after each period, so that all end at the same tick.
    """
    now = list(states)
    until = now[0].tick
    while not finished(now):
        until += period_ticks - until % period_ticks
        ended = False
        for number, drive in enumerate(drives):
            while now[number].tick < until:
                state = next(drive, None)
                if state is None:
                    ended = True
                    break
                now[number] = state
        if ended:
            break
        whereabouts.renew(now)
    return now
