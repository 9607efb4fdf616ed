"""What is ahead: without traffic and signals nothing is."""

import math

import numpy as np

from simconsole.drivers.simulated_person.situation import NOTHING_AHEAD, Light, empty_road
from simconsole.values.state_vector import PLATFORM_AT, Snapshot


def test_an_empty_road_has_nobody_and_no_line() -> None:
    assert empty_road(Snapshot(1, 250, np.zeros(PLATFORM_AT))) == NOTHING_AHEAD
    assert (NOTHING_AHEAD.lead_gap_m, NOTHING_AHEAD.line_m, NOTHING_AHEAD.yield_m) == (math.inf,) * 3
    assert NOTHING_AHEAD.light == Light.NONE
