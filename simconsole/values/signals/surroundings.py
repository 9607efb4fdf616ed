"""What surrounds the vehicle, short and of fixed width, and which rules of the road it breaks."""

from typing import Final, NamedTuple

FAR: Final = 1e9
"""Distance in m, time in s or speed limit in m/s where there is nobody, no signal and no limit."""


class AheadInput(NamedTuple):
    """The road ahead as traffic's last step found it: an input, for nobody else on the road is in the state.

    Where another simulator runs the signals, they are inputs likewise: -1 as `approach` says that it shows none ahead.
    """

    lead_gap_m: float  # from the vehicle's front, along its way; FAR: nobody
    lead_speed_mps: float  # along the vehicle's way
    yield_m: float  # from the vehicle's front to the line before which it lets others pass; FAR: nobody
    yield_s: float  # until who goes first is in its way; FAR: nobody would be hindered
    approach: float = 0.0  # to which of the map's stop lines the rest speaks, from 1; 0: signals run their own programs
    signal_state: float = 0.0  # `SignalState` that another simulator shows there
    signal_tick: float = FAR  # when it changes; FAR: never, or nobody knows
    traffic_lost: float = 0.0  # 1: another simulator has failed, and the road is empty since


NO_AHEAD: Final = AheadInput(lead_gap_m=FAR, lead_speed_mps=0.0, yield_m=FAR, yield_s=FAR)
"""An empty road."""


class ImpactInput(NamedTuple):
    """What a collision with a road user does at once: the change of the motion of the vehicle's centre of gravity.

    An input, for those who are struck are not in the state.
    """

    first_touch: float  # 1: somebody is touched who was not touched before
    vx_mps: float  # along the vehicle
    vy_mps: float
    yaw_rate_radps: float


NO_IMPACT: Final = ImpactInput(first_touch=0.0, vx_mps=0.0, vy_mps=0.0, yaw_rate_radps=0.0)
"""A vehicle that nobody touches."""


class ObstacleImpact(NamedTuple):
    """What fixed things that the vehicle runs into do to it in a tick; a collision with road users is `ImpactInput`."""

    touches: float  # 1: it moves on into one
    vx_mps: float  # change of the motion of its centre of gravity, along the vehicle
    vy_mps: float
    yaw_rate_radps: float


NO_OBSTACLE_TOUCHED: Final = ObstacleImpact(touches=0.0, vx_mps=0.0, vy_mps=0.0, yaw_rate_radps=0.0)
"""A vehicle with room round it, or a world without fixed things."""


class Situation(NamedTuple):
    """The road around the vehicle; everything else of a world is drawn from the map, the tick and other streams."""

    tick: float  # simulated time, in ticks since the start of the drive; 0 where the world has no rules
    lane: float  # place in the map's lanes; -1: off the map, or no map
    edge: float  # place in the map's edges; -1 likewise
    lane_s_m: float  # of base_link, along the lane from its beginning
    lateral_m: float  # of base_link, left of the lane's centre line
    speed_limit_mps: float  # of this lane; FAR: none
    signal_state: float  # `SignalState` of the next signal ahead
    signal_distance_m: float  # from the vehicle's front to its stop line, negative beyond it; FAR: none
    signal_change_s: float  # until its state changes; FAR: never
    lead_gap_m: float  # to the road user ahead, as of traffic's last step; FAR: nobody
    lead_speed_mps: float
    time_to_collision_s: float  # FAR: never
    yield_m: float  # to the line before which others go first, as of traffic's last step; FAR: nobody does
    yield_s: float  # until they are in the way; FAR: nobody would be hindered


NO_SITUATION: Final = Situation(
    tick=0.0,
    lane=-1.0,
    edge=-1.0,
    lane_s_m=0.0,
    lateral_m=0.0,
    speed_limit_mps=FAR,
    signal_state=0.0,
    signal_distance_m=FAR,
    signal_change_s=FAR,
    lead_gap_m=FAR,
    lead_speed_mps=0.0,
    time_to_collision_s=FAR,
    yield_m=FAR,
    yield_s=FAR,
)
"""A world without rules."""


class Rules(NamedTuple):
    """Which rules of the road the vehicle breaks, 1 while it does: each rise is an event.

    A breach begins and ends only after it has been seen, or not seen, for a while: the times count that.
    """

    collision: float  # it has touched a road user or a fixed thing; shown for a while
    red_light: float  # its front has passed a stop line at red; shown for a while
    wrong_way: float
    off_road: float
    speeding: float
    failing_to_yield: float  # its front has passed a line before which it had to let others pass; shown for a while
    collision_s: float  # since the touch
    red_light_s: float  # since it was passed
    wrong_way_s: float
    off_road_s: float
    speeding_s: float
    failing_to_yield_s: float  # since then


NO_RULES_BROKEN: Final = Rules(*(0.0,) * len(Rules._fields))
"""A vehicle that obeys, or a world without rules."""
