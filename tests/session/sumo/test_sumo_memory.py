"""What the core and SUMO's worker share."""

from pathlib import Path

import numpy as np

from simconsole.session.sumo.sumo_memory import How, SumoMemory, signal_bytes, signals_within
from simconsole.world.roads.road_map import Phase
from simconsole.world.roads.running import NONE_RUNNING, Running, changed
from tests.world.nets import CITY, generated_map


def test_both_sides_see_what_the_other_writes(tmp_path: Path) -> None:
    road_map = generated_map(*CITY)
    core = SumoMemory.create(tmp_path, road_map)
    worker = SumoMemory.open(tmp_path)
    core.asked.write(np.arange(6.0))
    assert worker.asked.since(0)[0].values.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    assert core.said.newest() is None
    worker.say(How.LOST, "x" * 2000)
    said = core.said.newest()
    assert said is not None
    assert said.number == How.LOST
    assert said.content == b"x" * 512


def test_signals_of_a_map_have_room_and_too_long_programs_go_without_what_comes_next() -> None:
    road_map = generated_map(*CITY)
    room = signal_bytes(road_map)
    now = {
        one.id: Running(one.programs[0].phases[0].state, one.programs[0].phases, 0, 500.0) for one in road_map.signals
    }
    assert changed(NONE_RUNNING, signals_within(now, room)) == now
    name, one = next(iter(now.items()))
    long = {**now, name: one._replace(phases=(Phase(1.0, one.letters),) * 100_000)}
    content = signals_within(long, room)
    assert len(content) <= room
    assert {key: value.letters for key, value in changed(NONE_RUNNING, content).items()} == {
        key: value.letters for key, value in now.items()
    }
    assert signals_within({}, room) == b"{}"
