"""SUMO's vehicles without its leaps: who is on the other lane within a step is told on its way there. Pure.

Without sublanes SUMO changes lanes at once, 3 m to the side in a step, and turns at the corners of its lines. A
vehicle that has leapt is told where its speed would have brought it, and comes from there to where SUMO has it, no
faster than its speed allows; its heading turns no faster than a car does. Who stands stays where it is told.

SUMO names a vehicle by its front bumper, which in a bend moves aside from where the vehicle looks; its middle does not,
for SUMO has both ends on the lane. So a leap is one of the middle.
"""

from typing import Final

import numpy as np

from simconsole.values.numerics.array_functions import cosine, sine
from simconsole.world.roads.road_map import Array
from simconsole.world.sumo_traffic.subscriptions import LENGTH, MOTION, PLACE

LEAP_M: Final = 0.1
"""Further than this from where its speed has brought it, the middle of a vehicle has leapt."""
ASIDE_SHARE: Final = 0.2
"""Of its speed, with which a vehicle comes to where SUMO has it: 11 degrees across its lane."""
ASIDE_MPS: Final = 1.5
"""That, at most: a lane in two seconds."""
TURN_DEGPS: Final = 115.0
"""A car at 7 m/s on a radius of 3.5 m."""
LOST_M: Final = 15.0
"""Further than this a vehicle has been put elsewhere, as SUMO does after a teleport: it is told there at once."""


class Smooth:
    """Where vehicles are told to be, step after step."""

    def __init__(self, period_s: float) -> None:
        """Take how long a step is."""
        self._period_s = period_s
        self._known = np.zeros(0)  # whose rows these are
        self._was = np.zeros((0, 4))  # as SUMO had them: x, y, angle, speed
        self._told = np.zeros((0, 3))  # as they were told: x, y, angle

    def step(self, rows: Array) -> None:
        """Put the vehicles of `subscriptions.VehicleReader` after SUMO's step where they are told to be."""
        numbers, now, told = rows[:, 0], rows[:, MOTION].copy(), rows[:, PLACE].copy()
        both, here, there = np.intersect1d(numbers, self._known, assume_unique=True, return_indices=True)
        if len(both):
            told[here] = followed(self._was[there], self._told[there], now[here], rows[here, LENGTH], self._period_s)
        self._known, self._was, self._told = numbers, now, told
        rows[:, PLACE] = told


def followed(was: Array, told: Array, now: Array, lengths_m: Array, period_s: float) -> Array:
    """Return where vehicles are told to be, float64 [vehicles, 3]: x and y of the front bumper (m), angle (degrees).

    Args:
        was: where SUMO had them a step ago: x, y, angle and speed (m/s), [vehicles, 4].
        told: where they were told to be then, [vehicles, 3].
        now: where SUMO has them, [vehicles, 4].
        lengths_m: how long they are, [vehicles].
        period_s: how long a step is.
    """
    way_m = 0.5 * period_s * (was[:, 3] + now[:, 3])
    angles = np.radians(was[:, 2] + 0.5 * _turned(now[:, 2] - was[:, 2]))
    ahead_m = 0.5 * lengths_m[:, None]  # of the middle; what turns goes round it
    looked, looks, told_looking = (ahead_m * _looking(np.radians(rows[:, 2])) for rows in (was, now, told))
    leap = now[:, :2] - was[:, :2] - (looks - looked) - way_m[:, None] * _looking(angles)
    leaps = np.hypot(leap[:, 0], leap[:, 1]) > LEAP_M
    beside = told[:, :2] - was[:, :2] - (told_looking - looked) - np.where(leaps[:, None], leap, 0.0)
    away_m = np.hypot(beside[:, 0], beside[:, 1])
    nearer_m = np.minimum(ASIDE_MPS * period_s, ASIDE_SHARE * way_m)
    left = np.where((away_m > nearer_m) & (away_m < LOST_M), 1.0 - nearer_m / np.maximum(away_m, 1e-9), 0.0)
    turn, most = _turned(now[:, 2] - told[:, 2]), TURN_DEGPS * period_s
    sudden = (np.abs(turn) > most) & (away_m < LOST_M)
    turned = np.where(sudden, (told[:, 2] + np.clip(turn, -most, most)) % 360.0, now[:, 2])
    turning = ahead_m * _looking(np.radians(turned)) - looks
    return np.column_stack((now[:, :2] + beside * left[:, None] + turning, turned))


def _looking(angles_rad: Array) -> Array:
    """Return the directions of navigational angles, float64 [angles, 2]."""
    return np.column_stack((sine(angles_rad), cosine(angles_rad)))


def _turned(angles_deg: Array) -> Array:
    """Return angles between -180 and 180 degrees."""
    return np.asarray((angles_deg + 180.0) % 360.0 - 180.0)
