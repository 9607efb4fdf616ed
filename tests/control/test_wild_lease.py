"""A command that cannot be meant renews nothing: neither the controller's health nor its lease."""

from collections.abc import Callable

from simconsole.values.signals import Commander, LinkState, Mode
from tests.control.conftest import Rig


def test_a_wild_command_after_a_silence_leaves_the_controller_silent(make_rig: Callable[..., Rig]) -> None:
    rig = make_rig().drive(Mode.MANUAL, speed_mps=13.0)
    rig.sending = False
    rig.run(2.0)
    assert rig.arbitration.commander == Commander.NOBODY
    rig.remote = rig.remote._replace(sequence=rig.remote.sequence + 1.0, age_ticks=-1.0, road_wheel_rad=0.5)
    rig.tick()
    assert rig.ros_link.state in (LinkState.STALE, LinkState.INVALID)
    assert rig.arbitration.commander == Commander.NOBODY
