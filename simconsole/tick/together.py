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
    """What robots are told of a platform: of the circles between two middles on its axis the one next to them."""

    rear_m: float  # middle of the hindmost circle, ahead of base_link
    front_m: float  # of the foremost; a round body has one
    radius_m: float


class Whereabouts:
    """Where the platforms of a session are, as the others are told."""

    def __init__(self, bodies: Sequence[Body], states: Sequence[ConsoleState]) -> None:
        """Start with the states before the first tick, in the order of the bodies."""
        self._bodies = bodies
        self._places: list[_Place] = []
        self.renew(states)

    def renew(self, states: Sequence[ConsoleState]) -> None:
        """Tell from now on where the platforms are in these states."""
        self._places = [_place(state.vector) for state in states]

    def seen_by(self, number: int) -> Callable[[], tuple[float, ...]]:
        """Return what tells the platform of this number of all others, in their order."""

        def others() -> tuple[float, ...]:
            own = self._places[number]
            all_there = enumerate(zip(self._places, self._bodies, strict=True))
            circles = (_circle(place, body, own) for at, (place, body) in all_there if at != number)
            return tuple(value for circle in circles for value in circle)

        return others


class _Place(NamedTuple):
    x_m: float
    y_m: float
    cosine: float
    sine: float


def _place(vector: Row) -> _Place:
    vehicle = read(vector, LAYOUT.vehicle)
    return _Place(vehicle.x_m, vehicle.y_m, cos(vehicle.yaw_rad), sin(vehicle.yaw_rad))


def _circle(place: _Place, body: Body, seen_from: _Place) -> tuple[float, float, float]:
    """Return the circle of a body that is next to who looks at it."""
    away_m = (seen_from.x_m - place.x_m) * place.cosine + (seen_from.y_m - place.y_m) * place.sine
    ahead_m = min(max(away_m, body.rear_m), body.front_m)
    return place.x_m + ahead_m * place.cosine, place.y_m + ahead_m * place.sine, body.radius_m


def run_together(
    drives: Sequence[Iterator[ConsoleState]],
    states: Sequence[ConsoleState],
    meet: Callable[[Sequence[ConsoleState]], None],
    period_ticks: int,
    finished: Callable[[Sequence[ConsoleState]], bool] = lambda states: False,
    turn_ticks: int | None = None,
) -> list[ConsoleState]:
    """Drive all platforms until one drive ends or `finished` says so; return their last states.

    Args:
        drives: of each platform, its `loop.steps`.
        states: of each before the first tick, all at the same tick.
        meet: told where all are after each period, before any goes on.
        period_ticks: how many ticks lie between two meetings.
        finished: asked after each turn, so that all end at the same tick.
        turn_ticks: how many ticks one of them makes before the next one does, as far as it foresees them; without, a
            period. A period is a whole number of turns.
    """
    now = list(states)
    until, turn = now[0].tick, turn_ticks or period_ticks
    while not finished(now):
        until += turn - until % turn
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
        if until % period_ticks == 0:
            meet(now)
    return now
