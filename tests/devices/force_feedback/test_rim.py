"""The rim: motion with friction."""

import pytest

from simconsole.devices.force_feedback.rim import Rim, turn


def test_rim_sticks_until_more_than_friction_pulls() -> None:
    rim = Rim(1.0, 0.0)
    assert turn(rim, 0.19, 0.05, 0.0, 0.2, 0.001) == rim
    assert turn(rim, 0.21, 0.05, 0.0, 0.2, 0.001).radps > 0.0
    coasting = Rim(0.0, 2.0)
    for _ in range(1000):
        coasting = turn(coasting, 0.0, 0.05, 0.0, 0.2, 0.001)
    assert coasting.radps == 0.0
    assert coasting.rad == pytest.approx(0.5 * 0.05 * 4.0 / 0.2, rel=0.01), "the energy went into friction"
