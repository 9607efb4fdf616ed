"""Drives whose answer is known, for the evaluation of manoeuvres."""

import numpy as np

from simconsole.evaluation.metrics.table import Array, Drive, drive_of
from tests.vehicle.driving import platform

HZ = 250
CAR = platform()


def drive(seconds: float, **columns: Array) -> Drive:
    """Return a drive with these columns; a dot in a name is a double underscore."""
    count = round(seconds * HZ)
    names = [name.replace("__", ".") for name in columns]
    rows = np.column_stack([np.broadcast_to(column, count) for column in columns.values()])
    return drive_of(rows, names, HZ)
