import pytest

from simconsole.world.roads.road_map import Connection, Phase, Program, Signal
from simconsole.world.traffic.junctions import GIVE_WAY, GO, STOP, STOP_IF_POSSIBLE
from simconsole.world.traffic.signal_states import Lights, by_programs
from tests.world.nets import straight_map

PROGRAM = Program("0", "static", 5.0, (Phase(10.0, "Gr"), Phase(3.0, "yr"), Phase(7.0, "ru")))


@pytest.mark.parametrize(
    ("time_s", "state"),
    [(5.0, "Gr"), (14.9, "Gr"), (15.0, "yr"), (18.0, "ru"), (24.9, "ru"), (25.0, "Gr"), (0.0, "yr"), (1005.0, "Gr")],
)
def test_programs_run_for_ever_from_their_offset(time_s: float, state: str) -> None:
    road_map = straight_map()._replace(signals=(Signal("one", (PROGRAM,)), Signal("dark", ())))
    if time_s == 0.0:  # five seconds before the program begins it is at 15 s
        state = "ru"
    assert by_programs(road_map)(time_s) == [state, ""]


@pytest.mark.parametrize(
    ("letter", "meaning"),
    [
        *(("G", GO), ("g", GIVE_WAY), ("o", GIVE_WAY), ("O", GIVE_WAY)),
        *(("y", STOP_IF_POSSIBLE), ("Y", STOP_IF_POSSIBLE), ("r", STOP), ("R", STOP), ("u", STOP), ("s", STOP)),
    ],
)
def test_what_a_letter_asks(letter: str, meaning: int) -> None:
    one, *others = straight_map().connections
    linked: tuple[Connection, ...] = (one._replace(signal=0, link=1), *others)
    lights = Lights(straight_map()._replace(connections=linked), lambda time_s: ["r" + letter])
    assert lights.at(3.0).tolist() == [meaning, *(GIVE_WAY for _ in others)]


def test_link_that_a_signal_does_not_have_is_as_without_signal() -> None:
    one, *others = straight_map().connections
    road_map = straight_map()._replace(connections=(one._replace(signal=0, link=9), *others))
    assert Lights(road_map, lambda time_s: ["rr"]).at(0.0)[0] == GIVE_WAY
    assert Lights(road_map, lambda time_s: []).at(0.0)[0] == GIVE_WAY
