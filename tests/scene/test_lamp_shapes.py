"""Lamps that shine, for the operators' scene."""

import numpy as np

from simconsole.profiles.files.world_files import load_world
from simconsole.scene.entities import light_places
from simconsole.scene.lamp_shapes import LIT, LOOKS_HZ, LampChanges
from simconsole.world.kinds.worlds import open_world
from simconsole.world.rules.lamps import Lamps

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


def test_nothing_shines_without_a_world_or_programs() -> None:
    assert LampChanges(None, HZ).until(1000) is None
    assert LampChanges(open_world(load_world("urban")).drawing, HZ).until(1000) is None
    assert np.shape(light_places(open_world(load_world("urban")).drawing)[1])[1:] == (3, 3)
