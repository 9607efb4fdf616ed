"""What the wheel's motor gave of the car's torque. Pure."""

from typing import Any, Final

import numpy as np

from simconsole.evaluation.metrics.table import Drive
from simconsole.values.labels import EASED_BELOW
from simconsole.values.units import KMH_PER_MPS

_COLUMNS: Final = ("torque.enabled", "torque.car_share", "vehicle.vx_mps")


def force_feedback(drive: Drive) -> dict[str, Any] | None:
    """Return the least share of the car's torque that the wheel gave, where, and how long it was eased.

    None where the wheel gave nothing of it: without a motor, or while the controller drove; and in a drive of a
    simconsole that did not record the share.
    """
    if not drive.names.issuperset(_COLUMNS):
        return None
    least, kmh, first, eased, at = np.inf, 0.0, -1, 0, 0
    for block in drive.read(_COLUMNS):
        enabled, share, speed_mps = block.T
        felt = np.where((enabled > 0.0) & (share > 0.0), share, np.inf)
        low = felt < EASED_BELOW
        if first < 0 and low.any():
            first = at + int(low.argmax())
        eased += int(low.sum())
        if felt.min() < least:
            least, kmh = float(felt.min()), abs(float(speed_mps[felt.argmin()])) * KMH_PER_MPS
        at += len(block)
    if not np.isfinite(least):
        return None
    return {
        "least_share": least,
        "least_at_kmh": kmh,
        "eased_s": eased / drive.tick_hz,
        "eased_from_s": None if first < 0 else (drive.first_tick + first) / drive.tick_hz,
    }
