"""The motor's torque: what it is made of, its limits, and when it lets go."""

import itertools
import math
import random
from typing import Any

import pytest

from simconsole.devices.force_feedback.estimator import WheelEstimate
from simconsole.devices.force_feedback.force_settings import NO_FORCE, ForceSettings, force_settings
from simconsole.devices.force_feedback.rim import Rim
from simconsole.devices.force_feedback.torque import (
    CENTRING_LEAD_RAD,
    CENTRING_RADPS,
    unattended_motion,
    wheel_torque,
)
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.host.jit import compiled
from simconsole.values.platform import NO_STIFFNESS
from simconsole.values.signals import (
    Arbitration,
    DriverInput,
    Event,
    Mode,
    MotorPipe,
    Notice,
    Validity,
    VehicleState,
    WheelMemory,
    WheelTorque,
)

RATIO, LOCK_RAD, HZ, TICK_S = 15.5, math.radians(36.0), 250, 0.004
PERSON = DriverInput(*(0.0,) * len(DriverInput._fields))._replace(wheel_validity=float(Validity.LIVE))
CAR = VehicleState(*(0.0,) * len(VehicleState._fields))._replace(vx_mps=15.0, hand_wheel_torque_nm=-2.0)
STRAIGHT = Rim(0.0, 0.0)
PULLING = NO_STIFFNESS._replace(pulls=1.0)
"""A car whose torque at the rim is given, whatever its stiffness."""


@pytest.fixture(scope="module")
def force() -> ForceSettings:
    return force_settings(load("devices", "t500rs_th8rs", CockpitProfile), RATIO, LOCK_RAD, HZ, PULLING)


class Motor:
    """Feeds ticks through `wheel_torque` and remembers what it must."""

    def __init__(self, force: ForceSettings, kernel: Any = wheel_torque) -> None:
        self.force, self.kernel = force, kernel
        self.torque = WheelTorque(*(0.0,) * len(WheelTorque._fields))
        self.memory = WheelMemory(*(0.0,) * len(WheelMemory._fields))
        self.pipe = MotorPipe(*(0.0,) * len(MotorPipe._fields))

    def tick(
        self,
        driver: DriverInput = PERSON,
        vehicle: VehicleState = CAR,
        mode: float = float(Mode.MANUAL),
        motor: float = 1.0,
        events: float = 0.0,
        ticks: int = 1,
        remote: tuple[float, float] = (0.0, 0.0),
        notice: Notice = Notice.NONE,
    ) -> WheelTorque:
        arbitration = Arbitration(*(0.0,) * len(Arbitration._fields))._replace(
            mode=mode, remote_road_wheel_rad=remote[0], remote_guidance=remote[1], notice=float(notice)
        )
        watching = mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.MINIMAL_RISK)
        for _ in range(ticks):
            self.torque, self.memory, self.pipe = self.kernel(
                driver,
                motor,
                arbitration,
                watching,
                events,
                vehicle,
                self.torque,
                self.memory,
                self.pipe,
                self.force,
                0.02,
                TICK_S,
            )
        return self.torque


@pytest.fixture
def motor(force: ForceSettings) -> Motor:
    return Motor(force)


def test_cockpit_without_the_section_has_no_motor() -> None:
    keyboard = load("devices", "keyboard", CockpitProfile)
    assert keyboard.force_feedback is None
    assert force_settings(keyboard, RATIO, LOCK_RAD, HZ) == NO_FORCE


def test_torque_comes_in_over_the_ramp_and_is_the_cars(motor: Motor, force: ForceSettings) -> None:
    ramp_ticks = round(0.7 * HZ)
    torques = [motor.tick().torque_nm for _ in range(ramp_ticks + 100)]
    assert abs(torques[0]) < 0.02
    assert all(later <= sooner + 1e-12 for sooner, later in itertools.pairwise(torques[:ramp_ticks]))
    rolling = 15.0 / (15.0 + force.fade_mps)
    assert torques[-1] == pytest.approx(-2.0 * rolling, rel=1e-4)
    assert torques[ramp_ticks // 2] == pytest.approx(torques[-1] / 2.0, rel=0.05)


@pytest.mark.parametrize(
    "why",
    [
        {"mode": float(Mode.STOPPED)},
        {"mode": float(Mode.EMERGENCY_STOP)},
        {"mode": float(Mode.PARKED)},
        {"mode": float(Mode.MINIMAL_RISK)},
        {"motor": 0.0},
        {"events": float(Event.LOOP_STALL)},
        {"driver": PERSON._replace(wheel_validity=float(Validity.STALE))},
        {"driver": PERSON._replace(wheel_validity=float(Validity.LOST))},
        {"driver": PERSON._replace(wheel_validity=float(Validity.UNKNOWN))},
    ],
    ids=str,
)
def test_motor_lets_go_at_once_and_comes_back_slowly(why: dict[str, Any], motor: Motor) -> None:
    assert abs(motor.tick(ticks=300).torque_nm) > 1.0
    gone = motor.tick(**why)
    assert (gone.torque_nm, gone.enabled, gone.ramp) == (0.0, 0.0, 0.0)
    assert abs(motor.tick().torque_nm) < 0.02


@pytest.mark.parametrize("field", ["hand_wheel_torque_nm", "road_wheel_rad", "vx_mps", "distance_m", "yaw_rate_radps"])
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_part_that_is_no_number_lets_go_and_leaves_nothing_behind(field: str, value: float, motor: Motor) -> None:
    for mode in (Mode.MANUAL, Mode.AUTONOMOUS):
        motor.tick(mode=float(mode), ticks=300)
        assert motor.tick(vehicle=CAR._replace(**{field: value}), mode=float(mode)).torque_nm == 0.0
        motor.tick(mode=float(mode))
        assert all(map(math.isfinite, (*motor.torque, *motor.memory)))


@pytest.mark.fault("D13")
@pytest.mark.parametrize("seed", range(3))
def test_no_drive_leaves_the_limits_and_both_executions_agree(seed: int, force: ForceSettings) -> None:
    """D13 in the kernel: bounded, slew-limited and equal in bits over wild inputs."""
    dice = random.Random(seed)
    print(f"seed {seed}")
    slow, fast = Motor(force), Motor(force, compiled(wheel_torque))
    odd = [0.0, 1.0, -3.0, 9.0, -60.0, 1e6, math.nan, math.inf]
    driver, vehicle, mode = PERSON, CAR, float(Mode.MANUAL)
    for _ in range(2000):
        if dice.random() < 0.2:
            mode = float(dice.choice(list(Mode)))
        vehicle = CAR._replace(
            hand_wheel_torque_nm=dice.choice(odd), road_wheel_rad=dice.choice(odd), vx_mps=dice.choice(odd)
        )
        driver = driver._replace(
            hand_wheel_rad=dice.uniform(-10.0, 10.0),
            wheel_validity=float(dice.choice([Validity.LIVE] * 9 + [Validity.STALE])),
        )
        before = slow.torque.torque_nm
        arguments: dict[str, Any] = {
            "driver": driver,
            "vehicle": vehicle,
            "mode": mode,
            "motor": float(dice.random() < 0.97),
        }
        torque = slow.tick(**arguments)
        assert tuple(map(float.hex, torque)) == tuple(map(float.hex, fast.tick(**arguments)))
        assert tuple(map(float.hex, slow.memory)) == tuple(map(float.hex, fast.memory))
        assert all(map(math.isfinite, (*torque, *slow.memory)))
        assert abs(torque.torque_nm) <= force.max_torque_nm
        assert torque.torque_nm == 0.0 or abs(torque.torque_nm - before) <= force.slew_nm * (1.0 + 1e-9)


@pytest.mark.parametrize("mode", [Mode.PARKED, Mode.MANUAL, Mode.STOPPED])
def test_a_wheel_that_is_centred_is_pulled_no_harder_than_its_lead(mode: Mode, motor: Motor) -> None:
    """Held fast a turn aside: the target goes ahead by its lead, and no further however long that lasts."""
    held = PERSON._replace(hand_wheel_rad=2.0 * math.pi)
    standing = CAR._replace(vx_mps=0.0, hand_wheel_torque_nm=0.0)
    torque = motor.tick(held, standing, float(mode), ticks=1500, notice=Notice.CENTRING_WHEEL)
    pull = -CENTRING_LEAD_RAD * motor.force.servo_nm_per_rad
    assert torque.torque_nm == pytest.approx(pull, abs=CENTRING_RADPS * motor.force.servo_damping_nms)
    assert abs(torque.torque_nm) < motor.force.max_torque_nm
    assert motor.tick(held, standing, float(mode), notice=Notice.CENTRE_WHEEL).servo_nm == 0.0


def test_a_centred_wheel_is_held_until_the_pedals_are_released(motor: Motor) -> None:
    aside = PERSON._replace(hand_wheel_rad=0.05)
    torque = motor.tick(aside, mode=float(Mode.MANUAL), ticks=500, notice=Notice.RELEASE_PEDALS)
    assert torque.torque_nm == pytest.approx(-0.05 * motor.force.servo_nm_per_rad, abs=0.1)
    assert motor.tick(aside, events=float(Event.PAUSE), notice=Notice.RELEASE_PEDALS).torque_nm == 0.0


@pytest.mark.parametrize(("radps2", "is_drawn"), [(-36.0, True), (0.0, False), (36.0, False)])
def test_torque_of_resting_hands_on_a_wheel_that_turns_fast_draws_the_model_to_it(
    radps2: float, is_drawn: bool, force: ForceSettings
) -> None:
    """1.5 N m are a push; but 0.7 of them hands that weigh 20 g m2 have in a wheel that spins up with 36 rad/s2."""
    before = WheelMemory(*(0.0,) * len(WheelMemory._fields))._replace(
        live=1.0, wheel_rad=0.8, wheel_radps=-2.0, model_rad=0.7, model_radps=-2.5
    )
    estimated = WheelEstimate(0.8, -2.0 + radps2 * TICK_S, 1.5, 1.5, 1.0)
    driver = PERSON._replace(hand_wheel_rad=0.8, hand_wheel_radps=-2.0)
    after = unattended_motion(driver, estimated, Rim(0.7, -2.5), 1.0, True, True, before, force, 0.02, TICK_S)
    alone = unattended_motion(
        driver, estimated._replace(human_nm=9.0), Rim(0.7, -2.5), 1.0, True, True, before, force, 0.02, TICK_S
    )
    assert (after.rad > alone.rad) == is_drawn
    assert (after.radps > alone.radps) == is_drawn
