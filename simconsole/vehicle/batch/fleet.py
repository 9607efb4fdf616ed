"""Many vehicles in one compiled call: fleets, parameter sweeps, the predictions of a predictive controller.

A plain loop over vehicles on all cores of the machine; every vehicle gets exactly the bits of its own single
step, whatever the number of threads (`NUMBA_NUM_THREADS`).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from simconsole.values.host.jit import compiled_for_each
from simconsole.values.kernels import put
from simconsole.values.platform import Platform
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT

Table = NDArray[np.float64]


class Fleet:
    """Vehicles of one platform, each with its own state, command and parameters."""

    def __init__(self, platforms: Sequence[Platform]) -> None:
        """Put the vehicles at their start.

        Args:
            platforms: one for each vehicle; all of the same kind, with any parameters.

        Raises:
            ValueError: no vehicle, or vehicles of different kinds.
        """
        if len({platform.step for platform in platforms}) != 1:
            raise ValueError("a fleet must have at least one vehicle, and all of one kind")
        self.platforms = tuple(platforms)
        self._parameters = np.array([platform.parameters for platform in platforms])
        self._grounds, self._on = _grounds(platforms)
        self._rows = np.zeros((len(platforms), PLATFORM_AT + len(platforms[0].initial_state)))
        for row, platform in zip(self._rows, platforms, strict=True):
            put(row, LAYOUT.vehicle.start, platform.initial_vehicle)
            put(row, PLATFORM_AT, platform.initial_state)
        self._before = self._rows.copy()
        self._step = compiled_for_each(platforms[0].step)

    def __len__(self) -> int:
        """Return how many vehicles there are."""
        return len(self.platforms)

    @property
    def vehicles(self) -> Table:
        """What others see: float64 [vehicles, fields of VehicleState], a copy."""
        return self._rows[:, LAYOUT.vehicle.slice].copy()

    @property
    def states(self) -> Table:
        """The platforms' own states: float64 [vehicles, fields of the platform's state], a copy."""
        return self._rows[:, PLATFORM_AT:].copy()

    def command(self, commands: ArrayLike) -> None:
        """Give every vehicle its command, float64 [vehicles, fields of VehicleCommand]; it holds until the next.

        Raises:
            ValueError: another shape.
        """
        _write(self._rows[:, LAYOUT.command.slice], commands)

    def restore(self, states: ArrayLike) -> None:
        """Put every vehicle into a state, float64 as `states`: to predict again from the same state, or from another.

        Raises:
            ValueError: another shape.
        """
        _write(self._rows[:, PLATFORM_AT:], states)

    def step(self, substeps: int) -> None:
        """Advance every vehicle by `substeps` steps of 1 ms under its command."""
        self._before[...] = self._rows
        self._step(self._before, self._rows, self._parameters, self._grounds, self._on, substeps)


def _grounds(platforms: Sequence[Platform]) -> tuple[Table, NDArray[np.int64]]:
    """Return the different grounds, filled up to one length, and which of them each vehicle is on."""
    found: dict[bytes, int] = {}
    on = [found.setdefault(platform.ground.tobytes(), len(found)) for platform in platforms]
    grounds = np.zeros((len(found), max(len(platform.ground) for platform in platforms)))
    for place, platform in zip(on, platforms, strict=True):
        grounds[place, : len(platform.ground)] = platform.ground
    return grounds, np.array(on)


def _write(columns: Table, values: ArrayLike) -> None:
    table = np.asarray(values, dtype=np.float64)
    if table.shape != columns.shape:
        raise ValueError(f"values of shape {table.shape}, must be {columns.shape}")
    columns[...] = table
