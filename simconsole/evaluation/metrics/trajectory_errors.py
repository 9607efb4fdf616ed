"""How far a trajectory is from the true one: absolutely, and from step to step (Sturm et al., IROS 2012)."""

from typing import NamedTuple

import numpy as np

from simconsole.evaluation.metrics.table import Array


class TrajectoryErrors(NamedTuple):
    """Of a trajectory as it is, without fitting it to the true one: it must be given in the same frame."""

    absolute_rms_m: float
    absolute_max_m: float
    heading_rms_rad: float
    relative_rms_m: float  # of the way over so many samples
    relative_rms_rad: float  # of the turn


def trajectory_errors(found: Array, true: Array, step: int) -> TrajectoryErrors:
    """Return the errors of poses.

    Args:
        found: float64 [N, 3]: x, y in m, yaw in rad.
        true: the same, at the same times.
        step: samples from one pose to that with which it is compared for the relative errors.

    Raises:
        ValueError: the shapes differ, or there are not more than `step` poses.
    """
    if found.shape != true.shape or len(found) <= step or step < 1:
        raise ValueError(f"{found.shape} and {true.shape} poses for steps of {step}: as many of both, more than a step")
    away = np.hypot(found[:, 0] - true[:, 0], found[:, 1] - true[:, 1])
    ways, true_ways = _ways(found, step), _ways(true, step)
    return TrajectoryErrors(
        absolute_rms_m=_rms(away),
        absolute_max_m=float(away.max()),
        heading_rms_rad=_rms(_wrapped(found[:, 2] - true[:, 2])),
        relative_rms_m=_rms(np.hypot(ways[:, 0] - true_ways[:, 0], ways[:, 1] - true_ways[:, 1])),
        relative_rms_rad=_rms(_wrapped(ways[:, 2] - true_ways[:, 2])),
    )


def fitted(found: Array, true: Array) -> Array:
    """Return poses [N, 3], turned and moved as a whole so that their places fit the true ones best (Horn, 1987)."""
    middle, true_middle = found[:, :2].mean(axis=0), true[:, :2].mean(axis=0)
    a, b = found[:, :2] - middle, true[:, :2] - true_middle
    turn = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
    cosine, sine = np.cos(turn), np.sin(turn)
    places = a @ np.array(((cosine, sine), (-sine, cosine))) + true_middle
    return np.column_stack((places, found[:, 2] + turn))


def _ways(poses: Array, step: int) -> Array:
    """Return each pose `step` samples later, in the frame of the pose before."""
    x, y = (poses[step:, :2] - poses[:-step, :2]).T
    cosine, sine = np.cos(poses[:-step, 2]), np.sin(poses[:-step, 2])
    return np.column_stack((cosine * x + sine * y, cosine * y - sine * x, poses[step:, 2] - poses[:-step, 2]))


def _wrapped(angles_rad: Array) -> Array:
    return np.asarray((angles_rad + np.pi) % (2.0 * np.pi) - np.pi)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values * values)))
