"""What a person sees of other road users and signals ahead on their way, and on the display. Pure."""

import math
from collections.abc import Callable
from enum import IntEnum
from typing import Final, NamedTuple

from simconsole.values.state_vector import Snapshot
from simconsole.values.units import NS_PER_S
from simconsole.world.rules.speed_advice import Advice, Advised


class Light(IntEnum):
    """What the next signal on the way shows."""

    NONE = 0
    GREEN = 1
    AMBER = 2
    RED = 3


class Situation(NamedTuple):
    """What is ahead; distances are from the front of one's own car, infinite where there is nothing."""

    lead_gap_m: float = math.inf  # to the rear of the vehicle ahead in the lane
    lead_speed_mps: float = 0.0
    light: float = float(Light.NONE)
    line_m: float = math.inf  # to the line at which the light is obeyed
    yield_m: float = math.inf  # to where to wait for somebody with right of way; infinite while nobody has it
    advised_mps: float = math.inf  # the middle of the band that the display advises; infinite while it has none


NOTHING_AHEAD: Final = Situation()

Look = Callable[[Snapshot], Situation]
"""What is ahead in a snapshot."""

_RED: Final = (2.0, 3.0, 4.0)
_AMBER: Final = (7.0, 8.0)
_GREEN: Final = (5.0, 6.0)
"""MovementPhaseState of SAE J2735: stop, clearance, movement allowed."""
_PASSED_M: Final = -1.0
_FAR_M: Final = 1e8
"""The state vector has no infinity: further than this there is nothing."""


def ahead_in(snapshot: Snapshot) -> Situation:
    """Return what the state vector's situation tells of the way ahead."""
    seen = snapshot.situation
    is_ahead = _PASSED_M < seen.signal_distance_m < _FAR_M
    return Situation(
        lead_gap_m=_metres(seen.lead_gap_m),
        lead_speed_mps=seen.lead_speed_mps,
        light=_light(seen.signal_state) if is_ahead else float(Light.NONE),
        line_m=seen.signal_distance_m if is_ahead else math.inf,
        yield_m=seen.yield_m if _PASSED_M < seen.yield_m < _FAR_M else math.inf,
    )


def with_display(newest: Callable[[int], Advice]) -> Look:
    """Return what sees the way ahead and the display; `newest` tells its speed advice at a time of the drive (ns)."""

    def look(snapshot: Snapshot) -> Situation:
        advice = newest(round(snapshot.t_s * NS_PER_S))
        if advice.kind is not Advised.SPEED:
            return ahead_in(snapshot)
        return ahead_in(snapshot)._replace(advised_mps=0.5 * (advice.low_mps + advice.high_mps))

    return look


def _metres(value: float) -> float:
    return value if value < _FAR_M else math.inf


def _light(state: float) -> float:
    shown = ((_RED, Light.RED), (_AMBER, Light.AMBER), (_GREEN, Light.GREEN))
    return float(next((light for states, light in shown if state in states), Light.NONE))
