import math

import numpy as np
import pytest

from simconsole.drivers.robots.slam.planar import ORIGIN, composed, inverse, seen_from, wrapped
from simconsole.values.platform import Pose
from tests.samples import Sample


def test_a_pose_and_its_inverse_cancel(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    for _ in range(50):
        a, b = (Pose(*rng.uniform(-3.0, 3.0, 3).tolist()) for _ in range(2))
        assert composed(a, inverse(a)) == pytest.approx(ORIGIN, abs=1e-12)
        assert composed(a, seen_from(a, b)) == pytest.approx(b, abs=1e-12)


def test_what_is_ahead_of_a_turned_frame_is_aside() -> None:
    assert composed(Pose(1.0, 2.0, 0.5 * math.pi), Pose(3.0, 0.0, 0.1)) == pytest.approx(
        (1.0, 5.0, 0.5 * math.pi + 0.1)
    )


def test_angles_stay_within_half_a_turn() -> None:
    assert wrapped(1.5 * math.pi) == pytest.approx(-0.5 * math.pi)
    assert composed(Pose(0.0, 0.0, 3.0), Pose(0.0, 0.0, 3.0)).yaw_rad == pytest.approx(6.0 - math.tau)
