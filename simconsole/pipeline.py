"""The life of one tick, in order. The only place that knows the order of the stages.

`advance` is pure: no clock, no files, no randomness. A seated drive, a headless run, a replay and a benchmark are
this same function; only where inputs come from, how ticks are paced and who reads the snapshots differ.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from simconsole.control.decide import decide
from simconsole.devices.calibration import calibrate
from simconsole.kernels import Row, kernel, put
from simconsole.rows import INPUT_WIDTH, PLATFORM_AT, VEHICLE_AT, Snapshot, TickInputs, columns, input_row
from simconsole.vehicle.platform import Platform


class Console(NamedTuple):
    """What stays constant over a drive: the configuration that `advance` works under."""

    tick_hz: int
    settings: Row  # CockpitSettings and ControlSettings, flattened
    platform: Platform
    decide: Callable[[Row, Row, Row, int], None]
    step: Callable[[Row, Row, Row, int], None]

    @property
    def columns(self) -> tuple[str, ...]:
        """Name of every column of a row of this drive."""
        return columns(self.platform.state)


class ConsoleState(NamedTuple):
    """Everything one tick hands to the next."""

    tick: int
    row: Row
