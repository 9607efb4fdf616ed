"""The bench of the set-up commands: guarded, and let go of by any key."""

from collections import deque
from contextlib import ExitStack

import pytest

from simconsole.devices.setup.device_commands import unpaced
from simconsole.devices.setup.wheel_bench import WheelBench
from simconsole.profiles.device import CockpitProfile
from simconsole.values.errors import DeviceError

pytestmark = pytest.mark.usefixtures("sdl")


def bench(cockpit: CockpitProfile, stack: ExitStack, pressed: bool = False) -> WheelBench:
    assert cockpit.force_feedback is not None
    return WheelBench(cockpit, cockpit.force_feedback, True, 250, unpaced, lambda: pressed, lambda line: None, stack)


def test_wheel_that_goes_too_far_is_let_go_of(t500: CockpitProfile) -> None:
    with ExitStack() as stack:
        opened = bench(t500, stack)
        with pytest.raises(DeviceError, match="beyond 12 deg"):
            deque((opened.turn(2.0) for _ in range(500)), maxlen=0)


def test_weight_pulls_the_wheel_to_the_right(t500: CockpitProfile) -> None:
    with ExitStack() as stack:
        opened = bench(t500, stack)
        opened.hung_nm = 0.5
        assert min(opened.turn(0.0) for _ in range(350)) < -0.01


def test_key_ends_it(t500: CockpitProfile) -> None:
    with ExitStack() as stack, pytest.raises(KeyboardInterrupt):
        bench(t500, stack, pressed=True).turn(0.1)
