"""Commands that steer too hard to be meant: not followed, told, and after five of them the controller is invalid."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from simconsole.values.signals import Commander, Event, GateLimit, LinkState, Mode, Reason, RemoteKind
from tests.control.conftest import LOCK_RAD, Rig
from tests.samples import Measured, Sample

DRIVEN = [Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.SHARED]


@pytest.mark.parametrize("tick_hz", [50, 250, 1000])
@pytest.mark.parametrize("mode", DRIVEN)
def test_five_in_a_row_are_not_followed_and_end_the_controllers_part(
    mode: Mode, tick_hz: int, make_rig: Callable[..., Rig]
) -> None:
    rig = make_rig(tick_hz).drive(mode, speed_mps=13.0)
    rig.send(road_wheel_rad=0.01)
    rig.run(1.0)
    angle, throttle = rig.command.road_wheel_rad, rig.command.throttle
    assert angle > 0.004
    rig.remote = rig.remote._replace(road_wheel_rad=LOCK_RAD)
    rig.run(0.02)
    began, ticks = rig.ros_link.implausible, 0
    assert began == 1.0
    while rig.mode is mode:
        assert rig.command.road_wheel_rad == pytest.approx(angle, abs=1e-12), "the angle in force is held"
        assert rig.refusal is Reason.REFUSED_IMPLAUSIBLE
        assert rig.command.throttle == pytest.approx(throttle, abs=0.1)
        assert rig.ros_link.state != LinkState.STEADY
        rig.tick()
        ticks += 1
    assert rig.reason is Reason.COMMAND_INVALID
    assert rig.mode is (Mode.MANUAL if mode is Mode.SHARED else Mode.MINIMAL_RISK)
    assert rig.ros_link.implausible == 5.0
    assert ticks / tick_hz <= 0.1
    if mode is not Mode.SHARED:
        rig.run(3.0)
        assert 0.0 <= rig.command.road_wheel_rad <= angle, "nor afterwards"


@pytest.mark.fault("R06")
@pytest.mark.parametrize("tick_hz", [50, 250, 1000])
@pytest.mark.parametrize("mode", DRIVEN)
@pytest.mark.parametrize("period_s", [0.02, 0.16, 0.196, 0.2, 0.25])
def test_whatever_comes_at_whatever_rate_the_last_plausible_command_counts(
    period_s: float, mode: Mode, tick_hz: int, make_rig: Callable[..., Rig]
) -> None:
    """A slow controller that goes wild: silence almost until it is stale, then one command, and so on."""
    rig = make_rig(tick_hz).drive(mode, speed_mps=13.0)
    rig._move = lambda: None  # type: ignore[method-assign]
    rig.sending = False
    rig.remote = rig.remote._replace(road_wheel_rad=0.01, sequence=rig.remote.sequence + 1.0, age_ticks=-1.0)
    rig.tick()
    since, period = 0, max(1, int(period_s * tick_hz))
    while rig.mode is mode:
        since += 1
        throttle = rig.command.throttle
        if since % period == 0:
            wild = {"road_wheel_rad": LOCK_RAD, "accel_mps2": 3.0}
            rig.remote = rig.remote._replace(**wild, sequence=rig.remote.sequence + 1.0, age_ticks=-1.0)
        rig.tick()
        if since >= period:
            assert rig.command.throttle <= throttle, "a refused command never speeds up"
    assert since <= rig.settings.stale_ticks
    assert rig.reason in (Reason.COMMAND_INVALID, Reason.COMMAND_STALE)


@pytest.mark.fault("R06")
def test_plausible_wild_and_missing_in_any_order_leave_in_time(
    make_rig: Callable[..., Rig], sample: Sample, measured: Measured
) -> None:
    """A plausible one in time goes on; nothing else does. The age is that of the newest plausible one."""
    rng = np.random.default_rng(sample.seed)
    left, longest_s = 0, 0.0
    for _ in range(sample.of(24, 1_000)):
        tick_hz = int(rng.choice([50, 100, 250, 1000]))
        rig = make_rig(tick_hz).drive(DRIVEN[rng.integers(3)], speed_mps=13.0)
        mode = rig.mode
        rig._move = lambda: None  # type: ignore[method-assign]
        rig.sending = False
        age, next_in, ticks = rig.remote.age_ticks, 1, 0
        while rig.mode is mode and ticks < 2 * tick_hz:
            ticks, age, next_in = ticks + 1, age + 1.0, next_in - 1
            if next_in <= 0:
                next_in = int(rng.integers(1, int(rig.settings.stale_ticks) + 3))
                late = float(rng.integers(int(rig.settings.stale_ticks))) if rng.random() < 0.3 else 0.0
                good = bool(rng.random() < 0.5)
                rig.remote = rig.remote._replace(
                    road_wheel_rad=0.0 if good else LOCK_RAD, sequence=rig.remote.sequence + 1.0, age_ticks=late - 1.0
                )
                age = late if good else age
            rig.tick()
            assert age < rig.settings.stale_ticks or rig.mode is not mode
        if rig.mode is not mode:
            left, longest_s = left + 1, max(longest_s, age / tick_hz)
    assert left > 10
    measured("R06", "last plausible command to leaving autonomy", f"{longest_s * 1e3:.0f} ms", "210 ms and a tick")


def test_full_lock_at_walking_pace_is_followed(make_rig: Callable[..., Rig]) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS, speed_mps=1.4)
    rig.send(RemoteKind.SPEED, road_wheel_rad=LOCK_RAD, speed_mps=1.4)
    rig.run(2.0)
    assert (rig.mode, rig.refusal, rig.command.road_wheel_rad) == (Mode.AUTONOMOUS, None, pytest.approx(LOCK_RAD))
    assert rig.ros_link.implausible == 0.0


def test_what_brakes_while_it_steers_too_hard_still_brakes(make_rig: Callable[..., Rig]) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS, speed_mps=13.0)
    rig.run(0.7)
    assert rig.command.brake == 0.0
    rig.send(road_wheel_rad=LOCK_RAD, accel_mps2=-6.0)
    rig.run(0.06)
    assert rig.refusal is Reason.REFUSED_IMPLAUSIBLE
    assert rig.command.brake > 0.3


@pytest.mark.parametrize("mode", [Mode.MANUAL, Mode.MINIMAL_RISK, Mode.STOPPED, Mode.PARKED])
def test_who_does_not_drive_is_not_told_of(mode: Mode, make_rig: Callable[..., Rig]) -> None:
    """It only cannot be engaged: it is not steady, and soon invalid."""
    rig = make_rig().drive(mode, speed_mps=13.0)
    rig.vehicle = rig.vehicle._replace(vx_mps=13.0)
    rig._move = lambda: None  # type: ignore[method-assign]
    rig.send(road_wheel_rad=LOCK_RAD)
    rig.run(0.05)
    assert (rig.mode, rig.refusal) == (mode, None)
    assert rig.ros_link.implausible_ticks > 0.0
    if mode is Mode.MANUAL:
        rig.tick(Event.REQUEST_AUTONOMOUS)
        assert (rig.mode, rig.refusal) == (mode, Reason.REFUSED_NOT_STABLE)
        rig.run(0.1)
        rig.tick(Event.REQUEST_AUTONOMOUS)
        assert (rig.mode, rig.refusal) == (mode, Reason.REFUSED_NO_COMMAND)


def test_only_the_commanders_count(make_rig: Callable[..., Rig]) -> None:
    for preferred, told in ((Commander.ROS, None), (Commander.ECU, Reason.REFUSED_IMPLAUSIBLE)):
        rig = make_rig(preferred=preferred)
        rig.run(1.0)
        rig.vehicle = rig.vehicle._replace(vx_mps=13.0)
        rig.send(road_wheel_rad=0.001)
        rig.send_ecu(road_wheel_rad=0.001)
        rig.run(0.3)
        rig.tick(Event.REQUEST_AUTONOMOUS)
        rig.ecu = rig.ecu._replace(road_wheel_rad=-LOCK_RAD)
        rig.run(0.036)
        in_force = rig.command.road_wheel_rad
        rig.tick()
        assert (rig.mode, rig.refusal) == (Mode.AUTONOMOUS, told)
        assert rig.ecu_link.implausible >= 1.0
        assert rig.ros_link.implausible == 0.0
        assert rig.arbitration.ecu_road_wheel_rad == in_force


def test_no_refused_command_ever_moves_the_wheels(make_rig: Callable[..., Rig], sample: Sample) -> None:
    """Random steering steps at random speeds: in a tick with a refused one, the angle is the one before."""
    rng = np.random.default_rng(sample.seed)

    def engaged() -> Rig:
        rig = make_rig().drive(Mode.AUTONOMOUS, speed_mps=10.0)
        rig._move = lambda: None  # type: ignore[method-assign]
        rig.run(0.7)
        return rig

    rig = engaged()
    refused = followed = 0
    for _ in range(sample.of(5_000, 200_000)):
        speed = float(rng.uniform(0.0, 25.0))
        rig.vehicle = rig.vehicle._replace(vx_mps=speed)
        rig.remote = rig.remote._replace(
            road_wheel_rad=float(rng.uniform(-1.2, 1.2)) * float(rng.choice([1.0, 0.1, 0.01])),
            sequence=rig.remote.sequence + 1.0,
            age_ticks=0.0,
        )
        before = rig.command.road_wheel_rad
        asked = speed**2 * math.tan(rig.remote.road_wheel_rad) / rig.settings.wheelbase_m
        rig.tick()
        if rig.mode is not Mode.AUTONOMOUS:
            rig = engaged()
        elif abs(asked) > 10.0:
            refused += 1
            gate = GateLimit(int(rig.command.gate_active))
            assert rig.command.road_wheel_rad == before or GateLimit.LATERAL_ACCELERATION in gate
            assert abs(rig.command.road_wheel_rad) <= abs(before)
        else:
            followed += 1
            assert rig.ros_link.implausible_ticks == 0.0
    assert min(refused, followed) > 1000
