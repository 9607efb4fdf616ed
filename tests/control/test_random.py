"""Long drives through arbitration and gate, compiled: what holds whatever happens, in any order; an hour of calm."""

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray

from simconsole.control.arbitration import arbitrate
from simconsole.control.gate import gate, limits_of
from simconsole.control.requests.control_settings import settings
from simconsole.control.requests.tick_context import TickContext
from simconsole.profiles.control import ControlProfile
from simconsole.values.host.jit import compiled, plain
from simconsole.values.layout import read
from simconsole.values.signals import (
    NEVER_TICKS,
    ArbiterMemory,
    Arbitration,
    Button,
    Commander,
    DriverInput,
    Event,
    EventInput,
    Mode,
    Reason,
    RemoteCommand,
    Validity,
    VehicleCommand,
    VehicleState,
)
from tests.bits import difference
from tests.control.random_drives import (
    ARBITRATION,
    COLUMNS,
    COMMAND,
    DRIVER,
    ECU_LINK,
    KEEP_SPEED,
    MEMORY,
    PIECE,
    ROS,
    ROS_LINK,
    SEED,
    STEPS,
    VEHICLE,
    Drive,
    calm_inputs,
    driven,
    random_drive,
)


def test_hands_resting_on_a_still_wheel_are_no_takeover_in_an_hour() -> None:
    """They come within a degree of the threshold again and again.

    The hour with a motor that turns the wheel under the hands: tests/devices/test_closed_loop.py.
    """
    tick_hz, engage = 50, 25
    s, steps = settings(ControlProfile(), 15.0, 0.6, 2.6, tick_hz), engage + 3600 * tick_hz
    slow, tremor = 2.0 * np.pi * 0.05, 2.0 * np.pi * 1.5

    def resting(first: int) -> NDArray[np.float64]:
        inputs = calm_inputs(min(PIECE, steps - first), first)
        time_s = (first + np.arange(len(inputs)) - engage) / tick_hz
        angle_deg = 5.0 * np.sin(slow * time_s) + 2.0 * np.sin(tremor * time_s)
        rate_degps = 5.0 * slow * np.cos(slow * time_s) + 2.0 * tremor * np.cos(tremor * time_s)
        inputs[:, COLUMNS.index("hand_wheel_rad")] = np.radians(angle_deg)
        inputs[:, COLUMNS.index("hand_wheel_radps")] = np.radians(rate_degps)
        if first == 0:
            inputs[engage, COLUMNS.index("events")] = float(Event.REQUEST_AUTONOMOUS)
        return inputs

    hour = driven((resting(first) for first in range(0, steps, PIECE)), s, tick_hz)
    assert (hour.modes[:engage] == Mode.MANUAL).all()
    assert (hour.modes[engage:] == Mode.AUTONOMOUS).all()
    assert len(hour.modes) - engage == 3600 * tick_hz
    moved_rad = np.abs(hour.given("hand_wheel_rad")).max()
    assert s.steering_override_rad - np.radians(1.1) < moved_rad < s.steering_override_rad
    assert hour.speed_mps[-1] == pytest.approx(10.0, abs=0.05)


@pytest.fixture(scope="module", params=[50, 250, 1000])
def long_drive(request: pytest.FixtureRequest) -> Drive:
    # Short times, so that what takes seconds happens in a random drive too.
    short = {
        "minimal_risk_after_s": 40 / request.param,
        "escalation_s": 20 / request.param,
        "standstill_s": 10 / request.param,
        "reengage_stable_s": 30 / request.param,
        "fade_s": 60 / request.param,
        "engage_lateral_accel_mps2": 2.0,
        "shared_authority": {50: "fixed", 250: "line_crossing", 1000: "traded"}[request.param],
        "shared_steering": "haptic" if request.param == 50 else "blended",
    }
    return random_drive(request.param, SEED + request.param, STEPS, **short)


def test_the_random_drive_gets_everywhere(long_drive: Drive) -> None:
    modes = long_drive.modes
    pairs = set(itertools.pairwise(modes))
    print({Mode(int(mode)).name: int((modes == mode).sum()) for mode in set(modes)})
    assert {float(mode) for mode in Mode} == set(modes)
    assert {(float(mode), float(Mode.EMERGENCY_STOP)) for mode in Mode} <= pairs
    assert {(float(Mode.AUTONOMOUS), float(mode)) for mode in Mode if mode not in (Mode.PARKED, Mode.STOPPED)} <= pairs
    reasons = set(long_drive.of(Arbitration, "reason"))
    elsewhere = (Reason.THROTTLE_OVERRIDE, Reason.OPERATOR_EMERGENCY, Reason.OPERATOR_RESET)  # tests/control/modes
    assert reasons >= {float(reason) for reason in Reason if 1 <= reason < 20 and reason not in elsewhere}


def test_every_output_is_finite_and_in_its_range(long_drive: Drive) -> None:
    s = long_drive.settings
    assert long_drive.finite
    assert (np.abs(long_drive.of(VehicleCommand, "road_wheel_rad")) <= s.max_road_wheel_rad).all()
    for name in ("throttle", "brake", "clutch", "handbrake"):
        pedal = long_drive.of(VehicleCommand, name)
        assert ((pedal >= 0.0) & (pedal <= 1.0)).all()
    assert set(long_drive.of(VehicleCommand, "gear")) <= {float(gear) for gear in range(-1, 8)}
    assert set(long_drive.of(VehicleCommand, "automatic")) <= {0.0, 1.0}
    assert (np.abs(long_drive.of(VehicleCommand, "target_speed_mps")) <= s.target_speed_max_mps).all()
    for name in ("remote_lateral", "remote_longitudinal", "remote_guidance"):
        share = long_drive.of(Arbitration, name)
        assert ((share >= 0.0) & (share <= 1.0)).all()


def test_steering_is_the_weighted_sum_of_both_sides_and_the_weights_sum_to_one(long_drive: Drive) -> None:
    """Where the gate changes nothing, the command is person + share * (remote - person), in every mode."""
    free = long_drive.of(VehicleCommand, "gate_active") == 0.0
    share = long_drive.of(Arbitration, "remote_lateral")
    person, remote = (long_drive.of(Arbitration, f"{side}_road_wheel_rad") for side in ("person", "remote"))
    error = long_drive.of(VehicleCommand, "road_wheel_rad") - (person + share * (remote - person))
    shared = free & (long_drive.modes == Mode.SHARED)
    assert shared.sum() > 1000
    assert len(set(long_drive.of(Arbitration, "remote_guidance")[shared])) > 20
    assert np.abs(error[free]).max() < 1e-12


def test_never_more_than_one_rate_step(long_drive: Drive) -> None:
    modes = long_drive.modes[1:].astype(int)
    limits = np.array([limits_of(float(mode), long_drive.settings) for mode in Mode])[modes] * long_drive.tick_s
    _, wheel_step, _, jerk_step, throttle_step, brake_step, speed_step = limits.T
    tiny = 1e-12
    angle = long_drive.of(VehicleCommand, "road_wheel_rad")
    assert (np.abs(np.diff(angle)) <= wheel_step + tiny).all()
    speed = long_drive.speed_mps[1:]
    smooth = (jerk_step > 0.0) & (speed > 0.1) & (long_drive.given("vx_mps")[1:] == KEEP_SPEED)
    assert smooth.sum() > 1_000
    jerk = np.abs(np.diff(angle)) * speed**2 / (long_drive.settings.wheelbase_m * np.cos(angle[:-1]) ** 2)
    assert (jerk[smooth] <= jerk_step[smooth] + 1e-9).all()
    braked = np.diff(long_drive.of(VehicleCommand, "brake"))
    hand = long_drive.settings.manual_pedal_slew_per_s * long_drive.tick_s
    asks = long_drive.of(Arbitration, "person_brake")[1:] > long_drive.of(VehicleCommand, "brake")[:-1]
    assert (braked <= np.where(asks, np.maximum(brake_step, hand), brake_step) + tiny).all(), "a foot may be faster"
    assert (-braked <= brake_step + tiny).all()
    assert (braked > brake_step + tiny).any(), "some feet are"
    assert (np.diff(long_drive.of(VehicleCommand, "throttle")) <= throttle_step + tiny).all()
    assert (np.abs(np.diff(long_drive.of(VehicleCommand, "target_speed_mps"))) <= speed_step + tiny).all()
    assert (np.abs(np.diff(long_drive.of(VehicleCommand, "clutch"))) <= hand + tiny).all()


def test_the_brake_beats_the_throttle(long_drive: Drive) -> None:
    throttle = long_drive.of(VehicleCommand, "throttle")
    assert (throttle[long_drive.of(VehicleCommand, "brake") >= long_drive.settings.brake_override] == 0.0).all()
    modes = long_drive.modes
    assert (throttle[(modes >= Mode.MINIMAL_RISK) | (modes == Mode.PARKED)] == 0.0).all()


def asked(long_drive: Drive, event: Event, button: Button | None) -> NDArray[np.bool_]:
    """Return in which ticks a person or an operator asked."""
    by_event = long_drive.heard & int(event) != 0
    if button is None:
        return by_event  # type: ignore[no-any-return]
    given = np.nan_to_num(long_drive.given("edges"), nan=0.0, posinf=0.0, neginf=0.0)
    known = (given >= 0.0) & (given <= 2147483647.0)
    return by_event | (np.where(known, given, 0.0).astype(np.int64) & int(button) != 0)  # type: ignore[no-any-return]


def test_emergency_stop_is_obeyed_at_once_and_latches(long_drive: Drive) -> None:
    modes = long_drive.modes
    emergency = long_drive.heard & int(Event.EMERGENCY_STOP) != 0
    assert (long_drive.heard != long_drive.events).any()
    assert emergency.sum() > 100
    assert (modes[emergency] == Mode.EMERGENCY_STOP).all()
    held = long_drive.given("pressed") == Button.EMERGENCY_STOP
    assert (modes[held] == Mode.EMERGENCY_STOP).all()
    left = np.flatnonzero((modes[:-1] == Mode.EMERGENCY_STOP) & (modes[1:] != Mode.EMERGENCY_STOP)) + 1
    assert len(left) > 20
    assert (modes[left] == Mode.PARKED).all()
    assert asked(long_drive, Event.RESET, Button.RESET)[left].all()
    assert not held[left].any()


def test_autonomy_is_engaged_by_an_act_only(long_drive: Drive) -> None:
    modes = long_drive.modes
    entered = np.flatnonzero((modes[:-1] != Mode.AUTONOMOUS) & (modes[1:] == Mode.AUTONOMOUS)) + 1
    assert len(entered) > 50
    assert asked(long_drive, Event.REQUEST_AUTONOMOUS, Button.AUTONOMOUS)[entered].all()
    assert (long_drive.age_ticks[entered] < long_drive.settings.stale_ticks).all()
    shared = np.flatnonzero((modes[:-1] != Mode.SHARED) & (modes[1:] == Mode.SHARED)) + 1
    assert asked(long_drive, Event.REQUEST_SHARED, None)[shared].all()
    requested = np.flatnonzero((modes[:-1] != Mode.TAKEOVER_REQUESTED) & (modes[1:] == Mode.TAKEOVER_REQUESTED))
    assert (modes[requested] == Mode.AUTONOMOUS).all()
    driven = np.isin(modes, [Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.SHARED])
    age = long_drive.age_ticks[driven]
    assert (age < long_drive.settings.stale_ticks).all()


def test_the_commander_never_changes_while_the_remote_side_drives(long_drive: Drive) -> None:
    modes, commander = long_drive.modes, long_drive.of(Arbitration, "commander")
    held = np.isin(modes[:-1], [Mode.SHARED, Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.MINIMAL_RISK])
    held &= commander[:-1] != Commander.NOBODY
    assert (commander[1:][held] == commander[:-1][held]).all()
    driven = np.isin(modes, [Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.SHARED])
    assert set(commander[driven]) == {Commander.ROS, Commander.ECU}
    assert set(commander) == set(Commander)


def test_with_nobody_driving_the_remote_side_has_no_authority_in_manual(long_drive: Drive) -> None:
    settled = (long_drive.modes == Mode.MANUAL) & (
        long_drive.of(ArbiterMemory, "mode_ticks") * long_drive.settings.fade_per_tick >= 1.0
    )
    assert settled.sum() > 500
    assert (long_drive.of(Arbitration, "remote_lateral")[settled] < 1e-12).all()
    assert (long_drive.of(Arbitration, "remote_longitudinal")[settled] < 1e-12).all()


def test_from_every_mode_a_person_gets_back_to_manual(long_drive: Drive) -> None:
    """No dead state: whatever the memory holds, a present, calm person and a reset end in MANUAL within seconds."""
    rng = np.random.default_rng(SEED)
    person = dict.fromkeys(("wheel_validity", "throttle_validity", "brake_validity"), float(Validity.LIVE))
    driver = DriverInput(*(0.0,) * DRIVER.width)._replace(**person)
    remote = RemoteCommand(*(0.0,) * ROS.width)._replace(age_ticks=NEVER_TICKS)
    vehicle = VehicleState(*(0.0,) * VEHICLE.width)
    s, some = long_drive.settings, long_drive.some
    for mode in Mode:
        for row in rng.choice(some[some[:, ARBITRATION.at("mode")] == mode], 5):
            ros_link = read(row, ROS_LINK)
            ecu_link = read(row, ECU_LINK)
            memory, arbitration, command = (
                read(row, MEMORY),
                read(row, ARBITRATION),
                read(row, COMMAND),
            )
            for tick in range(int(2.0 / long_drive.tick_s)):
                event = Event.REQUEST_MANUAL if tick % 2 else Event.RESET
                happened = EventInput(float(event))
                now = TickContext(
                    driver, remote, remote, happened, vehicle, memory, ros_link, ecu_link, NEVER_TICKS, NEVER_TICKS,
                    arbitration, command,
                    0.0, 0.0, 0.0, 0.0, 0.0, 0.0, s, long_drive.tick_s,
                )  # fmt: skip
                memory, ros_link, ecu_link, arbitration, request = arbitrate(now)
                command = gate(request, remote, arbitration, command, vehicle, s, long_drive.tick_s, 0.0)
                if arbitration.mode == Mode.MANUAL:
                    break
            assert arbitration.mode == Mode.MANUAL, mode


@pytest.mark.parametrize("tick_hz", [50, 1000])
def test_plain_and_compiled_give_equal_bits(tick_hz: int) -> None:
    drives = [random_drive(tick_hz, SEED - tick_hz, 6000, execution, every=1) for execution in (plain, compiled)]
    assert not difference(drives[0].some, drives[1].some)
    assert len(set(drives[0].modes)) >= 6
