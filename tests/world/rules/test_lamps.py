"""The lamps that are drawn are those of the programs, at every tick."""

import pytest

from simconsole.values.signals import FAR, SignalState
from simconsole.world.drawing_layers import Light, LightProgram
from simconsole.world.roads.lane_graph import LaneGraph
from simconsole.world.roads.road_drawing import draw_roads
from simconsole.world.roads.road_route import route_over
from simconsole.world.roads.running import Running
from simconsole.world.rules.lamps import AMBER, GREEN, RED, Lamps, Lit
from simconsole.world.rules.road_signals import RoadSignals
from tests.world.nets import CITY, generated_map

HZ = 50
BY_STATE = {
    SignalState.STOP_AND_REMAIN: [RED],
    SignalState.PRE_MOVEMENT: [RED, AMBER],
    SignalState.PERMISSIVE_CLEARANCE: [AMBER],
    SignalState.PROTECTED_CLEARANCE: [AMBER],
    SignalState.PERMISSIVE_MOVEMENT_ALLOWED: [GREEN],
    SignalState.PROTECTED_MOVEMENT_ALLOWED: [GREEN],
}


def light(letters: str) -> Light:
    return Light(0.0, 0.0, 0.0, LightProgram("one", 0, 0.0, (2.0,) * len(letters), letters))


def test_lamps_of_a_city_show_what_its_signals_tell() -> None:
    road_map = generated_map(*CITY)
    drawing = draw_roads(road_map, route_over(road_map, LaneGraph(road_map).drawn(1, 300.0)))
    signals, lamps = RoadSignals(road_map, HZ), Lamps(drawing.lights)
    numbers = {signal.id: number for number, signal in enumerate(road_map.signals)}
    assert len(drawing.lights) > 10
    seen = set()
    for tick in range(0, 120 * HZ, 37):
        shining: dict[int, list[int]] = {}
        for at, lamp in lamps.lit(tick, HZ):
            shining.setdefault(at, []).append(lamp)
        states = [signals.shown(number, tick).states for number in range(len(road_map.signals))]
        for place, one in enumerate(drawing.lights):
            assert one.program is not None
            told = states[numbers[one.program.signal]][one.program.link]
            assert shining.get(place, []) == BY_STATE[SignalState(told)]
            seen.add(told)
    assert len(seen) > 2


@pytest.mark.parametrize(
    ("letters", "shining"),
    [("r", [RED]), ("u", [RED, AMBER]), ("y", [AMBER]), ("G", [GREEN]), ("s", [RED]), ("O", []), ("x", [])],
)
def test_each_letter_has_its_lamps(letters: str, shining: list[int]) -> None:
    assert Lamps([light(letters)]).lit(7, HZ) == [Lit(0, lamp) for lamp in shining]


def test_blinking_lamp_is_dark_every_other_half_second() -> None:
    lamps = Lamps([light("o")])
    assert [bool(lamps.lit(tick, HZ)) for tick in (0, 24, 25, 49, 50)] == [True, True, False, False, True]


def test_light_of_no_program_shows_nothing_and_the_tick_rate_may_change() -> None:
    lamps = Lamps([Light(0.0, 0.0, 0.0), light("rG")])
    assert lamps.lit(0, HZ) == [Lit(1, RED)]
    assert lamps.lit(2 * HZ, HZ) == [Lit(1, GREEN)]
    assert lamps.lit(2 * HZ, 2 * HZ) == [Lit(1, RED)]


def test_another_simulator_says_what_shines() -> None:
    lamps = Lamps([light("r"), Light(0.0, 0.0, 0.0, LightProgram("two", 1, 0.0, (2.0,), "r"))])
    now = {"one": Running("G", (), 0, FAR), "two": Running("ry", (), 0, FAR)}
    assert lamps.lit(7, HZ, now) == [Lit(0, GREEN), Lit(1, AMBER)]
    assert lamps.lit(7, HZ, {"two": Running("r", (), 0, FAR)}) == [], "of nobody it knows, and of no such link"
    assert lamps.lit(7, HZ, {}) == [Lit(0, RED), Lit(1, RED)], "the programs of the map"
