import numpy as np
import pytest

from simconsole.drivers.robots.slam.odometry_track import KEPT_S, OdometryTrack
from simconsole.values.platform import Pose


def test_poses_between_two_messages_lie_between_them_and_outside_the_nearest_counts() -> None:
    track = OdometryTrack()
    track.add(1.0, Pose(0.0, 1.0, 3.1))
    track.add(1.1, Pose(0.2, 2.0, -3.1))
    found = track.at(np.array([0.0, 1.05, 2.0]))
    assert found[1] == pytest.approx((0.1, 1.5, np.pi)), "the short way over half a turn"
    assert found[0] == pytest.approx((0.0, 1.0, 3.1))
    assert found[2, :2] == pytest.approx((0.2, 2.0))


def test_old_poses_are_forgotten_and_late_ones_passed_over() -> None:
    track = OdometryTrack()
    with pytest.raises(ValueError, match="no odometry"):
        track.at(np.array([1.0]))
    for second in range(20):
        track.add(float(second), Pose(float(second), 0.0, 0.0))
    assert (track.oldest_s, track.newest_s) == (19.0 - KEPT_S, 19.0)
    track.add(18.5, Pose(99.0, 0.0, 0.0))
    assert track.at(np.array([18.5]))[0, 0] == pytest.approx(18.5)
