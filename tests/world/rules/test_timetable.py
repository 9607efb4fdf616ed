"""What signals show when: a function of the tick and the program alone."""

import numpy as np
import pytest

from simconsole.values.host.jit import compiled
from simconsole.values.signals import FAR, SignalState
from simconsole.world.roads.road_map import Phase, Program, Signal, active
from simconsole.world.rules.timetable import (
    PERMISSIVENESS,
    PhaseNow,
    Signals,
    durations_ticks,
    link_states,
    phase_now,
    timetable_of,
    until_change,
)
from tests.samples import Sample

HZ = 250
RED, YELLOW, GREEN = (
    SignalState.STOP_AND_REMAIN,
    SignalState.PERMISSIVE_CLEARANCE,
    SignalState.PROTECTED_MOVEMENT_ALLOWED,
)


def signal(*phases: tuple[float, str], offset_s: float = 0.0) -> Signal:
    return Signal("one", (Program("0", "static", offset_s, tuple(Phase(*phase) for phase in phases)),))


TWO_ROADS = signal((37.0, "rG"), (3.0, "ry"), (31.0, "Gr"), (4.0, "yr"))


@pytest.mark.parametrize(
    ("t_s", "letters", "left_s"),
    [(0.0, "rG", 37.0), (36.996, "rG", 0.004), (37.0, "ry", 3.0), (74.996, "yr", 0.004), (75.0, "rG", 37.0)],
)
def test_phases_follow_each_other_for_ever(t_s: float, letters: str, left_s: float) -> None:
    signals = Signals((TWO_ROADS,), HZ)
    for lap in (0, 1, 1000):
        tick = round((t_s + lap * 75.0) * HZ)
        assert signals.letters(0, tick) == letters
        assert signals.phase(0, tick)[1] == round(left_s * HZ)


@pytest.mark.parametrize("offset_s", [20.0, 95.0, -55.0])
def test_positive_offset_delays_all_phases(offset_s: float) -> None:
    plain, late = Signals((TWO_ROADS,), HZ), Signals((TWO_ROADS._replace(programs=(_with(offset_s),)),), HZ)
    for tick in range(0, 75 * HZ, 100):
        assert late.letters(0, tick + 20 * HZ) == plain.letters(0, tick)


def _with(offset_s: float) -> Program:
    return TWO_ROADS.programs[0]._replace(offset_s=offset_s)


def test_phase_is_the_one_whose_time_it_is(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    twin = compiled(phase_now)
    for _ in range(sample.of(50, 1000)):
        durations = rng.integers(1, 60, int(rng.integers(1, 9))).tolist()
        many = [signal(*((float(one), "G") for one in durations), offset_s=float(rng.integers(-99, 99))), TWO_ROADS]
        tick = float(rng.integers(0, 10**7))
        timetable = timetable_of(many, HZ)
        found = phase_now(timetable, 0.0, tick)
        at, first = (tick - many[0].programs[0].offset_s * HZ) % (sum(durations) * HZ), 0
        while at >= durations[first] * HZ:
            at -= durations[first] * HZ
            first += 1
        assert found == PhaseNow(first, durations[first] * HZ - at)
        assert twin(timetable, 0.0, tick) == found


def test_link_says_what_comes_next_and_when() -> None:
    signals = Signals((TWO_ROADS,), HZ)
    assert signals.link(0, 1, 0) == (GREEN, YELLOW, 37.0)
    assert signals.link(0, 0, 0) == (RED, GREEN, 40.0)  # red over two phases
    assert signals.link(0, 1, 72 * HZ) == (RED, GREEN, 3.0)
    assert signals.link(0, 7, 0) == (SignalState.UNAVAILABLE, SignalState.UNAVAILABLE, FAR)


def test_signal_without_a_program_or_with_one_phase_never_changes() -> None:
    bare = Signal("bare", ())
    assert Signals((bare,), HZ).link(0, 0, 12345) == (SignalState.UNAVAILABLE, SignalState.UNAVAILABLE, FAR)
    assert Signals((signal((0.0, "o")),), HZ).link(0, 0, 7)[0] == SignalState.CAUTION_CONFLICTING_TRAFFIC
    assert durations_ticks(active(signal((0.0, "o"))), HZ) == [1]


def test_several_links_show_the_most_permissive() -> None:
    program = active(signal((5.0, "rgG"), (5.0, "ruy"), (5.0, "rrr")))
    assert link_states(program, (0, 1, 2)) == [GREEN, YELLOW, RED]
    assert link_states(program, (0, 1)) == [SignalState.PERMISSIVE_MOVEMENT_ALLOWED, SignalState.PRE_MOVEMENT, RED]
    assert sorted(PERMISSIVENESS) == sorted(SignalState)


def test_time_until_the_state_changes_passes_over_equal_phases() -> None:
    assert until_change([RED, RED, GREEN, RED], [1, 2, 4, 8]) == [(2.0, GREEN), (0.0, GREEN), (0.0, RED), (3.0, GREEN)]
    assert until_change([RED, RED], [1, 2]) == [(FAR, RED), (FAR, RED)]
