"""Lamps that shine, for the operators' scene."""

import numpy as np

from simconsole.profiles.files.world_files import load_world
from simconsole.scene.entities import light_places
from simconsole.scene.lamp_shapes import LIT, LOOKS_HZ, LampChanges
from simconsole.values.signals import FAR
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.running import Running
from simconsole.world.rules.lamps import GREEN, RED, Lamps
from simconsole.world.traffic.road_users import NOBODY, RoadUsersAt

HZ = 250


def test_every_change_is_there_once_and_at_its_time() -> None:
    drawing = open_world(load_world("urban_signals")).drawing
    changes, lamps = LampChanges(drawing, HZ), Lamps(drawing.lights)
    centres = light_places(drawing)[1]
    times, counts, shown = [], [], []
    for tick in range(0, 200 * HZ, 777):
        found = changes.until(tick)
        if found is not None:
            times += found.times_ns.tolist()
            counts += found.counts
            shown += list(zip(found.centres.tolist(), found.colours, strict=True))
    assert times[0] == 0
    assert times == sorted(set(times))
    assert 4 < len(times) < 40, "programs of 90 s with six phases"
    at = 0
    for time_ns, count in zip(times, counts, strict=True):
        lit = lamps.lit(time_ns * HZ // 1_000_000_000, HZ)
        assert shown[at : at + count] == [(centres[one.light, one.lamp].tolist(), LIT[one.lamp]) for one in lit]
        at += count
    assert all(time_ns % (1_000_000_000 // LOOKS_HZ) == 0 for time_ns in times)


def test_another_simulators_signals_change_with_its_steps() -> None:
    drawing = open_world(load_world("urban_signals")).drawing
    changes = LampChanges(drawing, HZ)
    names = {one.program.signal for one in drawing.lights if one.program is not None}

    def step(tick: int, letter: str) -> RoadUsersAt:
        return RoadUsersAt(tick, NOBODY, {name: Running(letter * 40, (), 0, FAR) for name in names})

    first = changes.until(100, [step(0, "r"), step(50, "G")])
    assert first is not None
    assert first.times_ns.tolist() == [0, 200_000_000]
    assert set(first.colours[: first.counts[0]]) == {LIT[RED]}
    assert set(first.colours[first.counts[0] :]) == {LIT[GREEN]}
    assert changes.until(200) is None, "no step, no change"
    later = changes.until(300, [step(240, "y"), RoadUsersAt(270, NOBODY)])
    assert later is not None
    assert later.times_ns.tolist() == [1_000_000_000, 1_100_000_000], "then the programs of the map"


def test_nothing_shines_without_a_world_or_programs() -> None:
    assert LampChanges(None, HZ).until(1000) is None
    assert LampChanges(open_world(load_world("urban")).drawing, HZ).until(1000) is None
    assert np.shape(light_places(open_world(load_world("urban")).drawing)[1])[1:] == (3, 3)
