"""Signals that another simulator runs, in the words of our own."""

from simconsole.values.signals import FAR, SignalState
from simconsole.world.roads.road_map import Phase
from simconsole.world.roads.running import NONE_RUNNING, Running, changed
from simconsole.world.rules.approaches import Approach
from simconsole.world.rules.road_signals import RoadSignals
from simconsole.world.rules.running_signals import RunningSignals, Shown
from tests.world.nets import CITY, generated_map

PHASES = (Phase(20.0, "Gr"), Phase(3.0, "yr"), Phase(10.0, "rG"))
RED, GREEN = SignalState.STOP_AND_REMAIN, SignalState.PROTECTED_MOVEMENT_ALLOWED


def running(phase: int, switch_tick: float) -> tuple[RunningSignals, str]:
    signals = RunningSignals(generated_map(*CITY), 100)
    name = generated_map(*CITY).signals[0].id
    signals.take({name: Running(PHASES[phase].state, PHASES, phase, switch_tick)})
    return signals, name


def test_the_program_says_what_comes_next_and_when() -> None:
    signals, _ = running(0, 700.0)
    assert signals.of(Approach(0, (0,))) == Shown(GREEN, SignalState.PERMISSIVE_CLEARANCE, 700.0)
    assert signals.of(Approach(0, (1,))) == Shown(RED, GREEN, 1000.0), "after the yellow of the others"
    assert signals.of(Approach(0, (0, 1))).state == GREEN, "the most permissive"
    assert signals.shown(0, 500).change_s == [2.0, 5.0]
    assert signals.state(0, 1, 500) == RED


def test_a_phase_without_an_end_never_changes() -> None:
    signals, _ = running(2, FAR)
    assert signals.of(Approach(0, (1,))) == Shown(GREEN, GREEN, FAR)
    assert signals.shown(0, 5).change_s == [-1.0, -1.0]


def test_the_next_times_of_green_are_told() -> None:
    signals, _ = running(0, 700.0)
    shown = signals.shown(0, 500)
    assert (shown.green_from_s, shown.green_to_s) == ([0.0, 5.0], [2.0, 15.0])
    assert (shown.later_green_from_s, shown.later_green_to_s) == ([15.0, 38.0], [35.0, 48.0])
    unknown = running(2, FAR)[0].shown(0, 5)
    assert (unknown.green_from_s, unknown.green_to_s) == ([-1.0, 0.0], [-1.0, -1.0])
    assert unknown.later_green_from_s == [-1.0, -1.0]


def test_signal_that_nobody_runs_is_unavailable() -> None:
    signals, _ = running(0, 700.0)
    assert signals.of(Approach(1, (0,))).state == SignalState.UNAVAILABLE
    assert signals.shown(1, 5).states == []


def test_changes_are_told_once() -> None:
    signals, name = running(0, 700.0)
    said = signals.changed()
    assert said is not None
    assert changed(NONE_RUNNING, said) == {name: Running("Gr", PHASES, 0, 700.0)}
    signals.take({name: Running("Gr", PHASES, 0, 700.0)})
    assert signals.changed() is None


def test_where_it_has_failed_they_run_the_programs_of_the_map() -> None:
    signals, name = running(0, 700.0)
    own = RoadSignals(generated_map(*CITY), 100)
    assert signals.shown(0, 500) != own.shown(0, 500)
    signals.changed()
    signals.take(NONE_RUNNING)
    assert signals.changed() == b'{"%b":null}' % name.encode()
    for number in range(3):
        assert signals.shown(number, 500) == own.shown(number, 500)
        assert signals.state(number, 0, 500) == own.shown(number, 500).states[0]


def test_who_asks_now_and_then_gets_the_newest() -> None:
    road_map = generated_map(*CITY)
    now = {one.id: Running("r" * 20, PHASES, 2, FAR) for one in road_map.signals}
    signals = RunningSignals(road_map, 100, lambda: now)
    x, y = road_map.lanes[0].line[0, :2]
    near = signals.in_reach(x, y, 5)
    assert near
    assert {state for one in near for state in one.states} == {RED}
    assert [one.id for one in near] == [one.id for one in RoadSignals(road_map, 100).in_reach(x, y, 5)]
