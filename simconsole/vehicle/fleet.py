"""Many vehicles in one compiled call: fleets, parameter sweeps, the guesses of a predictive controller.

The numbers lie as a structure of arrays in blocks of LANES vehicles, so that one instruction works on LANES of them.
Every vehicle gets exactly the bits that its own step would give it alone.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from simconsole.kernels import put
from simconsole.lane_values import LANES
from simconsole.lanes import HOST, lane_step
from simconsole.rows import COMMAND_AT, COMMAND_WIDTH, PLATFORM_AT, VEHICLE_AT, VEHICLE_WIDTH
from simconsole.vehicle.platform import Platform

Table = NDArray[np.float64]

_COMMANDS: Final = slice(0, COMMAND_WIDTH)
_VEHICLES: Final = slice(VEHICLE_AT - COMMAND_AT, VEHICLE_AT - COMMAND_AT + VEHICLE_WIDTH)
_STATES: Final = slice(PLATFORM_AT - COMMAND_AT, None)


class Fleet:
    """Vehicles of one platform, each with its own state, command and, where they differ, parameters."""

    def __init__(self, platforms: Sequence[Platform], processor: str = HOST) -> None:
        """Put the vehicles at their start.

        Args:
            platforms: one for each vehicle; all of the same kind (`name`), with any parameters.
            processor: a name that LLVM knows, to check that another processor's code gives the same bits.

        Raises:
            ValueError: no vehicle, or vehicles of different kinds.
        """
        if len({platform.step for platform in platforms}) != 1:
            raise ValueError("a fleet must have at least one vehicle, and all of one kind")
        first = platforms[0]
        self.platforms = tuple(platforms)
        self._width = PLATFORM_AT + len(first.initial_state) - COMMAND_AT
        parameters = np.array([platform.parameters for platform in platforms])
        shared = bool((parameters == parameters[0]).all())
        self._parameters = parameters[0].copy() if shared else self._in_blocks(parameters)
        start = np.zeros((len(platforms), COMMAND_AT + self._width))
        for row, platform in zip(start, platforms, strict=True):
            put(row, VEHICLE_AT, platform.initial_vehicle)
            put(row, PLATFORM_AT, platform.initial_state)
        self._rows = self._in_blocks(start[:, COMMAND_AT:])
        self._step = lane_step(first.step, COMMAND_AT, self._width, parameters.shape[1], shared, processor)

    def __len__(self) -> int:
        """Return how many vehicles there are."""
        return len(self.platforms)

    @property
    def assembly(self) -> str:
        """The machine code, as text."""
        return self._step.assembly

    @property
    def vehicles(self) -> Table:
        """What others see: float64 [vehicles, fields of VehicleState], a copy."""
        return self._read(_VEHICLES)

    @property
    def states(self) -> Table:
        """The platforms' own states: float64 [vehicles, fields of the platform's state], a copy."""
        return self._read(_STATES)

    def command(self, commands: ArrayLike) -> None:
        """Give every vehicle its command, float64 [vehicles, fields of VehicleCommand]; it holds until the next.

        Raises:
            ValueError: another shape.
        """
        self._write(_COMMANDS, commands)

    def restore(self, states: ArrayLike) -> None:
        """Put every vehicle into a state, float64 as `states`: to guess again from the same one, or from another.

        Raises:
            ValueError: another shape.
        """
        self._write(_STATES, states)

    def step(self, substeps: int) -> None:
        """Advance every vehicle by `substeps` steps of 1 ms under its command."""
        self._step.run(self._rows.ctypes.data, self._parameters.ctypes.data, substeps, len(self._rows))

    def _in_blocks(self, table: Table) -> Table:
        """Return [blocks, columns, LANES] of [vehicles, columns]; the last block is filled up with its last vehicle."""
        blocks = -(-len(table) // LANES)
        filled = np.concatenate([table, np.repeat(table[-1:], blocks * LANES - len(table), axis=0)])
        return _aligned(filled.reshape(blocks, LANES, -1).transpose(0, 2, 1))

    def _read(self, columns: slice) -> Table:
        part = self._rows[:, columns].transpose(0, 2, 1)
        return part.reshape(-1, part.shape[2])[: len(self)].copy()

    def _write(self, columns: slice, values: ArrayLike) -> None:
        table = np.asarray(values, dtype=np.float64)
        wanted = (len(self), self._rows[:, columns].shape[1])
        if table.shape != wanted:
            raise ValueError(f"values of shape {table.shape}, must be {wanted}")
        self._rows[:, columns] = self._in_blocks(table)


def _aligned(table: Table) -> Table:
    """Return a copy whose vectors of LANES lie each in one line of the cache."""
    line = LANES * table.itemsize
    room = np.empty(table.nbytes + line, dtype=np.uint8)
    start = -room.ctypes.data % line
    copy = room[start : start + table.nbytes].view(table.dtype).reshape(table.shape)
    copy[...] = table
    return copy
