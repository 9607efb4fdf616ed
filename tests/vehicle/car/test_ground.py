"""The friction under each wheel."""

from simconsole.values.platform import Ground, Patch
from tests.vehicle.driving import TICK_S
from tests.vehicle.rolling import rolling


def test_each_wheel_has_the_friction_of_the_patch_it_stands_on() -> None:
    """Ice under the left wheels only: braked without ABS the car turns to the side that grips."""
    ice = Patch(-1e3, 1e3, 0.1, 10.0, 0.2)
    drive = rolling(20.0, Ground(1.0, 0.0, 0.0, patches=(ice,)), anti_lock=False, stability_control=False)
    assert drive.hold(0.6, brake=1.0, clutch=1.0).yaw_rate_radps < -0.05
    there = rolling(20.0, Ground(1.0, 0.0, 0.0, patches=(Patch(*ice[:2], 3.0, 10.0, 0.2),)), anti_lock=False)
    assert there.hold(0.6, brake=1.0, clutch=1.0).yaw_rate_radps == 0.0, "the ice is beside the car"


def test_a_patch_ends_where_it_ends_and_the_later_one_counts() -> None:
    strip = (Patch(10.0, 50.0, -5.0, 5.0, 0.1), Patch(20.0, 30.0, -5.0, 5.0, 1.0))
    drive = rolling(25.0, Ground(1.0, 0.0, 0.0, patches=strip), anti_lock=False)
    seen = {}
    for _ in range(250):
        now = drive.hold(TICK_S, brake=0.9, clutch=1.0)
        seen[round(now.x_m)] = now.ax_mps2
    assert seen[5] < -7.0, "the front wheels are 2.6 m ahead of base_link"
    assert -2.0 < seen[14] < 0.0
    assert seen[21] < -7.0
