"""The bench of the set-up commands: guarded, and let go of by any key."""

from collections import deque
from collections.abc import Callable
from contextlib import ExitStack

import pytest

from simconsole.devices.force_feedback.gentle_push import Gentle, Turn, gentle, move
from simconsole.devices.force_feedback.motor import SimulatedWheelPort
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


def test_key_ends_a_force_that_is_left_to_end_by_itself(t500: CockpitProfile, monkeypatch: pytest.MonkeyPatch) -> None:
    """For a quarter of a second nothing is written, so that the device's own time-out shows: a key ends that, too."""
    left: list[int] = []
    levels: list[float] = []
    ticks: list[int] = []
    write = SimulatedWheelPort.write

    def moved(turn: Turn, rules: Gentle, target_rad: float, sense: float, *, moving: bool = False) -> float:
        at = move(turn, rules, target_rad, sense, moving=moving)
        if moving:
            left.append(len(ticks))
        return at

    def noted(port: SimulatedWheelPort, level: float) -> None:
        levels.append(level)
        write(port, level)

    def pace(tick_hz: int) -> Callable[[int], None]:
        return ticks.append

    monkeypatch.setattr("simconsole.devices.setup.wheel_bench.move", moved)
    monkeypatch.setattr(SimulatedWheelPort, "write", noted)
    force = t500.force_feedback
    assert force is not None
    with ExitStack() as stack:
        opened = WheelBench(t500, force, True, 250, pace, lambda: bool(left), lambda line: None, stack)
        opened.rest(0.1)
        with pytest.raises(KeyboardInterrupt):
            opened.abandon(gentle(force, 0.25, 250))
        assert levels[-2] != 0.0 == levels[-1]
        assert len(ticks) == left[0] + 1


def test_key_ends_it(t500: CockpitProfile) -> None:
    with ExitStack() as stack, pytest.raises(KeyboardInterrupt):
        bench(t500, stack, pressed=True).turn(0.1)
