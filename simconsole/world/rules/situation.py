"""What lies ahead of the vehicle in each tick: lane, limit, next signal, leader. A kernel, a stage of the tick.

Time to collision as of Hayward: Near-miss determination through use of a scale of danger, Highway Research Record 384
(1972), 24-34: the gap divided by the speed at which it closes.
"""

from typing import Final, NamedTuple

from simconsole.values.kernels import Row, kernel, stage
from simconsole.values.layout import read, write
from simconsole.values.signals import FAR, AheadInput, SignalState, Situation, VehicleState
from simconsole.values.state_vector import LAYOUT
from simconsole.values.trigonometry import Direction, direction
from simconsole.world.roads.lane_index import HEADING_M, Found, nearest_segment
from simconsole.world.rules.breaches import Place, judged
from simconsole.world.rules.road_rules import (
    APPROACH,
    BEYOND,
    EDGE,
    HALF_WIDTH,
    IN_JUNCTION,
    LENGTH,
    LIMIT,
    SHOWN,
    SIGNAL,
    RoadRules,
)
from simconsole.world.rules.timetable import phase_now

_NO_SIGNAL: Final = float(SignalState.UNAVAILABLE)
_FAR: Final = FAR
LEAST_CLOSING_MPS: Final = 0.1
"""A gap that closes more slowly than this counts as one that stays."""


class Lead(NamedTuple):
    """The road user ahead, and what is owed to others."""

    gap_m: float
    speed_mps: float
    contact_s: float  # time to collision
    yield_m: float
    yield_s: float


class Foreign(NamedTuple):
    """What another simulator's signal shows."""

    approach: float  # row of the table of approaches, from 1; 0: signals run their own programs; -1: none is ahead
    state: float
    tick: float  # when it changes


OWN: Final = Foreign(approach=0.0, state=0.0, tick=FAR)
"""Signals that run their own programs."""


@kernel
def time_to_collision(ahead: AheadInput, speed_mps: float) -> float:
    """Return the time in s until the gap to the road user ahead is gone, FAR while it does not close."""
    closing_mps = speed_mps - ahead.lead_speed_mps
    if ahead.lead_gap_m >= _FAR or closing_mps < LEAST_CLOSING_MPS:
        return _FAR
    return ahead.lead_gap_m / closing_mps


@stage
def look_around(previous: Row, row: Row, rules: RoadRules, tick_s: float) -> None:
    """Write situation and broken rules after a tick into `row`, whose vehicle has moved."""
    vehicle = read(row, LAYOUT.vehicle)
    before = read(previous, LAYOUT.situation)
    heading = direction(vehicle.yaw_rad)
    index = rules.segments
    found = nearest_segment(
        index.rows,
        index.starts,
        index.items,
        index.grid,
        vehicle.x_m,
        vehicle.y_m,
        heading.cos,
        heading.sin,
        HEADING_M,
    )
    ahead = read(row, LAYOUT.ahead)
    lead = Lead(
        gap_m=ahead.lead_gap_m,
        speed_mps=ahead.lead_speed_mps,
        contact_s=time_to_collision(ahead, vehicle.vx_mps),
        yield_m=ahead.yield_m,
        yield_s=ahead.yield_s,
    )
    foreign = Foreign(approach=ahead.approach, state=ahead.signal_state, tick=ahead.signal_tick)
    situation = situation_at(found, before.tick + 1.0, rules, lead, foreign, tick_s)
    place = place_of(found, heading, vehicle, rules)
    write(row, LAYOUT.situation, situation)
    touched = read(row, LAYOUT.impact).first_touch + read(row, LAYOUT.obstacle).touches
    write(row, LAYOUT.rules, judged(read(previous, LAYOUT.rules), before, situation, place, touched, tick_s))


@kernel
def situation_at(found: Found, tick: float, rules: RoadRules, lead: Lead, foreign: Foreign, tick_s: float) -> Situation:
    """Return the situation of a vehicle on the segment that was found for it.

    A signal of another simulator's is unknown from a change of lanes until its next step.
    """
    lane, edge, lane_s, lateral, limit = -1.0, -1.0, 0.0, 0.0, _FAR
    state, distance, change = _NO_SIGNAL, _FAR, _FAR
    if found.segment >= 0.0:
        segment = int(found.segment)
        lane = rules.segments.owners[segment]
        place = int(lane)
        edge, limit = rules.lanes[place, EDGE], rules.lanes[place, LIMIT]
        lane_s, lateral = rules.segments.rows[segment, 5] + found.along_m, found.lateral_m
        approach = int(rules.lanes[place, APPROACH])
        if approach >= 0:
            distance = rules.lanes[place, LENGTH] - lane_s + rules.lanes[place, BEYOND] - rules.front_m[0]
            if foreign.approach == 0.0:
                signal = rules.approaches[approach, SIGNAL]
                now = phase_now(rules.timetable, signal, tick)
                first = rules.timetable.signals[int(signal), 0]
                shown = int(rules.approaches[approach, SHOWN] + now.phase - first)
                state = rules.shown[shown, 0]
                if rules.shown[shown, 1] < _FAR:
                    change = (now.left_ticks + rules.shown[shown, 1]) * tick_s
            elif foreign.approach == approach + 1.0:
                state = foreign.state
                if foreign.tick < _FAR:
                    change = max(foreign.tick - tick, 0.0) * tick_s
    return Situation(
        tick=tick,
        lane=lane,
        edge=edge,
        lane_s_m=lane_s,
        lateral_m=lateral,
        speed_limit_mps=limit,
        signal_state=state,
        signal_distance_m=distance,
        signal_change_s=change,
        lead_gap_m=lead.gap_m,
        lead_speed_mps=lead.speed_mps,
        time_to_collision_s=lead.contact_s,
        yield_m=lead.yield_m,
        yield_s=lead.yield_s,
    )


@kernel
def place_of(found: Found, heading: Direction, vehicle: VehicleState, rules: RoadRules) -> Place:
    """Return what the rules ask of where the vehicle is and how it moves."""
    outside, along, in_junction = _FAR, 1.0, 0.0
    if found.segment >= 0.0:
        segment = int(found.segment)
        lane = int(rules.segments.owners[segment])
        outside = abs(found.lateral_m) - rules.lanes[lane, HALF_WIDTH]
        forward_x, forward_y = rules.segments.rows[segment, 2], rules.segments.rows[segment, 3]
        along = heading.cos * forward_x + heading.sin * forward_y
        in_junction = rules.lanes[lane, IN_JUNCTION]
    return Place(outside_m=outside, along=along, in_junction=in_junction, speed_mps=vehicle.vx_mps)
