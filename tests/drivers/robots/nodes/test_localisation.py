import numpy as np

from simconsole.drivers.robots.nodes.localisation import Localisation
from simconsole.values.platform import Pose
from simconsole.world.arena.occupancy import Grid

GRID = Grid(np.zeros((1, 1), dtype=np.int8), 0.05, 0.0, 0.0)


def at(x: float) -> Pose:
    return Pose(x, 0.0, 0.0)


def test_in_lockstep_what_was_made_of_a_scan_counts_from_the_next_one_on() -> None:
    said = Localisation(lockstep=True)
    said.scan(200)
    assert not said.waits, "nothing is known of a scan before the first"
    said.correct(200, at(1.0))
    said.see_map(200, GRID)
    assert said.take() is None
    assert said.correction is None
    said.scan(400)
    assert not said.waits
    assert said.take() is GRID
    assert (said.correction, said.corrected_ns) == (at(1.0), 200)
    said.scan(600)
    assert said.waits
    said.correct(400, at(2.0))
    said.correct(600, at(3.0))
    assert not said.waits
    said.take()
    assert said.correction == at(2.0), "that of the newest scan came early, and counts later all the same"


def test_beside_a_clock_everything_counts_at_once_and_nobody_waits() -> None:
    said = Localisation(lockstep=False)
    said.scan(200)
    said.scan(400)
    assert not said.waits
    said.correct(400, at(2.0))
    said.see_map(400, GRID)
    assert said.take() is GRID
    assert said.correction == at(2.0)
    assert said.take() is None
