"""The template of a metric of one's own, as a package that registers it. `$name` is what the user called it."""

from typing import Final

ENTRY: Final = ("simconsole.metrics", "METRIC")
"""The group of its entry point, and what that names in its module."""

METRIC: Final = '''\
"""$name: a metric of one's own. `pip install -e .` registers it.

From then on its figures stand as own.$name.* in reports, in `Drive.metrics`, in the `metrics:` of a scenario and in the
columns of a sweep. Equal drives must give equal figures: no clock, no chance.
"""

import numpy as np

from simconsole.evaluation.metrics.registered import Driven, Figure, OwnMetric

MOVING_MPS = 0.1


def measure(driven: Driven):
    """Return the figures of a drive by name; None where it has none."""
    drive = driven.drive
    speed_mps, accel_mps2 = drive.columns("vehicle.vx_mps", "vehicle.ax_mps2")
    moving = np.abs(speed_mps) > MOVING_MPS
    return {
        "standing_s": float((~moving).sum()) / drive.tick_hz,
        "accel_rms_mps2": float(np.sqrt(np.mean(accel_mps2[moving] ** 2))) if moving.any() else None,
    }


METRIC = OwnMetric(
    figures={
        "standing_s": Figure("Time at rest", 0.0),
        "accel_rms_mps2": Figure("Longitudinal acceleration while it moves, RMS", 0.0, 100.0),
    },
    measure=measure,
)
"""Each figure with what it says, and between which values it can be: one outside of them is an error."""
'''

TEST: Final = '''\
"""$name measures what its figures say. No installation is needed for this."""

from pathlib import Path
from runpy import run_path

import numpy as np

from simconsole.evaluation.metrics.registered import Driven, measured
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.metrics.track import track

METRIC = run_path(str(Path(__file__).with_name("$name.py")))["METRIC"]
COLUMNS = ("vehicle.x_m", "vehicle.y_m", "vehicle.vx_mps", "vehicle.vy_mps", "vehicle.ax_mps2", "arbitration.mode")


def figures(speed_mps, accel_mps2, tick_hz=100):
    rows = np.zeros((len(speed_mps), len(COLUMNS)))
    rows[:, 2], rows[:, 4] = speed_mps, accel_mps2
    rows[:, 0] = np.cumsum(rows[:, 2]) / tick_hz
    drive = drive_of(rows, COLUMNS, tick_hz)
    return measured("$name", METRIC, Driven(drive, track(drive, None), None))


def test_it_measures_what_its_figures_say():
    found = figures([0.0] * 50 + [5.0] * 100, [9.0] * 50 + [2.0, -2.0] * 50)
    assert found == {"standing_s": 0.5, "accel_rms_mps2": 2.0}


def test_a_drive_that_never_moves_has_no_acceleration():
    assert figures([0.0] * 100, [0.0] * 100) == {"standing_s": 1.0, "accel_rms_mps2": None}
'''
