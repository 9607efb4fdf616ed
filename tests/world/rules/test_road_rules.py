"""The tables that the tick looks up."""

from simconsole.values.signals import FAR, SignalState
from simconsole.world.roads.road_map import active
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
    road_rules,
)
from tests.world.nets import CITY, generated_map, straight_map


def test_lanes_have_their_rows() -> None:
    road_map = straight_map()
    rules = road_rules(road_map, (), 250, 3.5)
    for place, lane in enumerate(road_map.lanes):
        row = rules.lanes[place]
        assert (row[EDGE], row[LENGTH], row[LIMIT]) == (lane.edge, lane.length_m, lane.limit_mps)
        assert (row[HALF_WIDTH], row[APPROACH], row[BEYOND]) == (0.5 * lane.width_m, -1.0, 0.0)
        assert row[IN_JUNCTION] == lane.id.startswith(":")
    assert rules.front_m.tolist() == [3.5]


def test_approaches_that_show_the_same_share_a_row() -> None:
    road_map = generated_map(*CITY)
    rules = road_rules(road_map, (), 250, 3.5)
    assert len(rules.timetable.signals) == len(road_map.signals)
    assert len(rules.approaches) < len(rules.lanes)
    assert set(rules.lanes[:, APPROACH]) == set(range(-1, len(rules.approaches)))
    for row in rules.approaches:
        first = int(row[SHOWN])
        phases = len(active(road_map.signals[int(row[SIGNAL])]).phases)
        states = rules.shown[first : first + phases, 0]
        assert set(states) <= {float(state) for state in SignalState}
        assert (rules.shown[first : first + phases, 1] < FAR).all() == (len(set(states)) > 1)
