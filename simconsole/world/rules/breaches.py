"""Which rules of the road the vehicle breaks: red light, wrong way, off the road, speed limit, yielding. Kernels.

Whom it strikes is told like a rule. A breach is told once it has lasted, and is over once it has been over for a
while: a speed that wavers about the limit is one breach, not a hundred.
"""

from typing import Final, NamedTuple

from simconsole.values.kernels import kernel
from simconsole.values.signals import FAR, Rules, SignalState, Situation

SHOWN_S: Final = 3.0
"""So long a collision is shown, a red light that was passed, and a duty to yield that was not met."""
HINDERED_S: Final = 2.0
"""Who has the right of way and is there sooner than this has to brake hard, or to swerve."""
SPEEDING_MPS: Final = 1.4
"""So much above the limit is a breach: 5 km/h, what a speedometer may show wrongly; it ends at the limit."""
SPEEDING_S: Final = 0.5
OFF_ROAD_M: Final = 1.2
"""So far base_link is outside its lane when the whole car has left the road."""
BACK_ON_ROAD_M: Final = 0.6
JUNCTION_M: Final = 4.0
"""So much wider a junction's surface is than the lanes that lead over it."""
OFF_ROAD_S: Final = 0.3
WRONG_WAY: Final = -0.5
"""Cosine of the angle to the lane, beyond which the vehicle drives against it; it ends at a right angle."""
WRONG_WAY_S: Final = 1.0
_MOVING_MPS: Final = 1.0
_RED: Final = float(SignalState.STOP_AND_REMAIN)
_RED_YELLOW: Final = float(SignalState.PRE_MOVEMENT)


class Place(NamedTuple):
    """Where the vehicle is, as far as the rules ask."""

    outside_m: float  # of base_link beyond the edge of its lane, negative inside
    along: float  # cosine of the angle between vehicle and lane
    in_junction: float  # 1: inside a junction
    speed_mps: float


class Breach(NamedTuple):
    """Whether a rule is broken, and for how long the opposite has been seen."""

    is_broken: float
    against_s: float


@kernel
def judged(before: Rules, was: Situation, now: Situation, place: Place, touched: float, tick_s: float) -> Rules:
    """Return which rules are broken after a tick.

    Args:
        before: those that were broken before it.
        was: the situation before it.
        now: that after it.
        place: where the vehicle is.
        touched: more than 0: it has touched a road user or a fixed thing in this tick.
        tick_s: the tick's length.
    """
    collision, collision_s = before.collision, before.collision_s + tick_s
    if touched > 0.0:
        collision, collision_s = 1.0, 0.0
    if collision == 0.0 or collision_s >= SHOWN_S:
        collision, collision_s = 0.0, 0.0
    red, red_s = before.red_light, before.red_light_s + tick_s
    if passed_red(was, now):
        red, red_s = 1.0, 0.0
    if red == 0.0 or red_s >= SHOWN_S:
        red, red_s = 0.0, 0.0
    failing, failing_s = before.failing_to_yield, before.failing_to_yield_s + tick_s
    if failed_to_yield(was, now):
        failing, failing_s = 1.0, 0.0
    if failing == 0.0 or failing_s >= SHOWN_S:
        failing, failing_s = 0.0, 0.0
    room_m = JUNCTION_M * place.in_junction
    against = place.along < WRONG_WAY and place.in_junction == 0.0 and place.speed_mps > _MOVING_MPS
    wrong_way = held(before.wrong_way, before.wrong_way_s, against, place.along > 0.0, WRONG_WAY_S, tick_s)
    off = held(
        before.off_road,
        before.off_road_s,
        place.outside_m > OFF_ROAD_M + room_m,
        place.outside_m < BACK_ON_ROAD_M + room_m,
        OFF_ROAD_S,
        tick_s,
    )
    speed, limit = abs(place.speed_mps), now.speed_limit_mps
    speeding = held(
        before.speeding, before.speeding_s, speed > limit + SPEEDING_MPS, speed <= limit, SPEEDING_S, tick_s
    )
    return Rules(
        collision=collision,
        red_light=red,
        wrong_way=wrong_way.is_broken,
        off_road=off.is_broken,
        speeding=speeding.is_broken,
        failing_to_yield=failing,
        collision_s=collision_s,
        red_light_s=red_s,
        wrong_way_s=wrong_way.against_s,
        off_road_s=off.against_s,
        speeding_s=speeding.against_s,
        failing_to_yield_s=failing_s,
    )


@kernel
def passed_red(was: Situation, now: Situation) -> bool:
    """Return whether the vehicle's front has passed a stop line in this tick while its signal showed red."""
    red = now.signal_state == _RED or now.signal_state == _RED_YELLOW
    same = was.lane == now.lane
    return red and same and was.signal_distance_m > 0.0 and now.signal_distance_m <= 0.0


@kernel
def failed_to_yield(was: Situation, now: Situation) -> bool:
    """Return whether the vehicle's front has passed a line before which somebody who goes first would be hindered."""
    return 0.0 < was.yield_m < FAR and now.yield_m <= 0.0 and now.yield_s < HINDERED_S


@kernel
def held(broken: float, against_s: float, breaks: bool, obeys: bool, patience_s: float, tick_s: float) -> Breach:
    """Return whether a rule is broken, where it changes only after `patience_s` of the opposite."""
    against_s = against_s + tick_s if (obeys if broken > 0.0 else breaks) else 0.0
    if against_s >= patience_s:
        broken, against_s = 1.0 - broken, 0.0
    return Breach(broken, against_s)
