"""The effect on the device: written on change and at its rate, started again only while ticks come.

What every port must do stands in test_every_motor.py.
"""

import numpy as np
import pytest

from simconsole.devices.force_feedback.motor import (
    EFFECT_S,
    Capability,
    HapticPort,
    MotorisedSource,
    NoHaptics,
    SimulatedWheelPort,
    WheelMotor,
)
from simconsole.devices.force_feedback.simulated_wheel import HANDS_OFF, SimulatedWheel
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from simconsole.values.signals import NO_SAMPLE, NO_TORQUE, DeviceSample
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot

FORCE = ForceFeedback(max_torque_nm=4.0)
HZ = 250


class Log:
    """A port that notes what it is told, and fails when asked to."""

    def __init__(self) -> None:
        self.calls: list[tuple[str, float]] = []
        self.broken = False

    capability = Capability("log", constant=True)

    def _note(self, what: str, value: float = 0.0) -> None:
        if self.broken:
            raise DeviceError("log: motor: value unplugged: plugged in")
        self.calls.append((what, value))

    def write(self, level: float) -> None:
        self._note("write", level)

    def start(self) -> None:
        self._note("start")

    def stop(self) -> None:
        self._note("stop")

    def close(self) -> None:
        self._note("close")


def shot(tick: int, torque_nm: float, enabled: float = 1.0) -> Snapshot:
    row = np.zeros(PLATFORM_AT)
    row[LAYOUT.torque.slice] = NO_TORQUE._replace(torque_nm=torque_nm, ramp=1.0, enabled=enabled)
    return Snapshot(tick, HZ, row)


def motor(port: HapticPort, force: ForceFeedback = FORCE) -> WheelMotor:
    return WheelMotor(port, force, lambda snapshot: snapshot.t_s)


def test_level_is_written_on_change_and_at_most_125_times_a_second() -> None:
    log = Log()
    wheel = motor(log)
    for tick in range(HZ):
        wheel.publish(shot(tick, 0.01 * tick))
    writes = [value for what, value in log.calls if what == "write"]
    assert 60 <= len(writes) <= 125
    assert len(set(writes)) == len(writes)
    assert writes == sorted(writes)
    steps = np.array(writes) * 127.0
    assert np.allclose(steps, np.round(steps))
    log.calls.clear()
    for tick in range(HZ, 2 * HZ):
        wheel.publish(shot(tick, 2.49))
    assert [what for what, _ in log.calls].count("write") <= 1


def test_effect_is_started_again_every_50_ms() -> None:
    log = Log()
    wheel = motor(log)
    for tick in range(HZ):
        wheel.publish(shot(tick, 1.0))
    assert 19 <= [what for what, _ in log.calls].count("start") <= 21


def test_torque_that_is_off_stops_the_effect_at_once() -> None:
    log = Log()
    wheel = motor(log)
    wheel.publish(shot(0, 3.0))
    wheel.publish(shot(1, 0.0, enabled=0.0))
    assert log.calls[-2:] == [("stop", 0.0), ("write", 0.0)]
    log.calls.clear()
    wheel.publish(shot(2, 0.0, enabled=0.0))
    assert log.calls == []


def test_sign_of_the_device_is_the_profiles() -> None:
    log = Log()
    motor(log, ForceFeedback(max_torque_nm=4.0, level_pushes="right")).publish(shot(0, 4.0))
    assert ("write", -1.0) in log.calls


def test_device_that_fails_counts_as_one_without_a_motor() -> None:
    log = Log()
    wheel = motor(log)
    source = MotorisedSource(Still(), wheel, lambda: None)
    assert source.poll(1).wheel_motor == 1.0
    log.broken = True
    wheel.publish(shot(0, 1.0))
    assert wheel.failure is not None
    assert source.poll(2).wheel_motor == 0.0
    wheel.publish(shot(1, 1.0))
    wheel.exchange(Log())
    assert source.poll(3).wheel_motor == 1.0


def test_person_is_told_in_words_what_becomes_of_the_force() -> None:
    said: list[str] = []
    wheel = WheelMotor(NoHaptics("no driver"), FORCE, lambda snapshot: snapshot.t_s, said.append)
    assert said == ["no force feedback: no driver; everything else works"]
    log = Log()
    wheel.exchange(log)
    assert said[1:] == ["force feedback is back"]
    log.broken = True
    wheel.publish(shot(0, 1.0))
    wheel.publish(shot(1, 1.0))
    assert said[2:] == ["force feedback ends: log: motor: value unplugged: plugged in; everything else goes on"]


def test_wheel_that_gives_a_share_of_the_cars_torque_only_is_told_once() -> None:
    said: list[str] = []
    wheel = WheelMotor(Log(), FORCE, lambda snapshot: snapshot.t_s, said.append)
    for tick, (share, enabled) in enumerate(((1.0, 1.0), (0.7, 0.0), (0.0, 1.0), (0.74, 1.0), (0.6, 1.0))):
        row = shot(tick, 0.1, enabled)
        row.vector[LAYOUT.torque.at("car_share")] = share
        wheel.publish(row)
    assert said == ["force feedback eased to 74 %: more of the car's torque would make this wheel swing"]


class Still:
    """A cockpit at rest."""

    sample = NO_SAMPLE._replace(wheel_age_ticks=0.0)

    def poll(self, tick: int) -> DeviceSample:
        return self.sample

    def close(self) -> None: ...


def test_wheel_that_is_gone_has_no_motor() -> None:
    source = MotorisedSource(Still(), motor(Log()), lambda: None)
    source._source.sample = NO_SAMPLE  # type: ignore[attr-defined]
    assert source.poll(1).wheel_motor == 0.0
    assert MotorisedSource(Still(), motor(NoHaptics()), lambda: None).poll(1).wheel_motor == 0.0


def test_simulated_effect_ends_by_itself() -> None:
    wheel = SimulatedWheel(FORCE, 1080.0, tick_hz=HZ)
    port = SimulatedWheelPort(wheel)
    port.write(1.0)
    port.start()
    torques = []
    for _ in range(round(0.3 * HZ)):
        wheel.turn(HANDS_OFF)
        torques.append(wheel.state.motor_nm)
    assert max(torques) == pytest.approx(4.0, rel=0.01)
    after = round((EFFECT_S + FORCE.motor.delay_s + 0.02) * HZ)
    assert max(map(abs, torques[after:])) < 0.01


def test_simulated_motor_saturates_and_knows_only_whole_steps() -> None:
    wheel = SimulatedWheel(FORCE, 1080.0, tick_hz=HZ)
    wheel.write(5.0)
    assert wheel._torque_nm == 4.0
    wheel.write(0.5)
    assert wheel._torque_nm == pytest.approx(4.0 * 64 / 127)
