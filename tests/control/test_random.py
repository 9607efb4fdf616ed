"""Random drives through arbitration and gate, compiled: what must hold whatever happens, in any order."""

import itertools
from typing import Final, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from simconsole.compiling import compiled, plain
from simconsole.control.arbitration import arbitrate
from simconsole.control.commander import ECU
from simconsole.control.gate import gate, limits_of
from simconsole.control.moment import Moment
from simconsole.control.settings import ControlSettings, settings
from simconsole.kernels import Row, kernel, put, take
from simconsole.profiles.control import ControlProfile
from simconsole.signals import (
    NEVER_TICKS,
    ArbiterMemory,
    Arbitration,
    Button,
    Commander,
    DriverInput,
    Event,
    EventInput,
    Link,
    Mode,
    Reason,
    RemoteCommand,
    Validity,
    VehicleCommand,
    VehicleState,
)

Rows = NDArray[np.float64]
SEED: Final = 20_260_301
STEPS: Final = 350_000
DRIVER_WIDTH: Final = len(DriverInput._fields)
REMOTE_WIDTH: Final = len(RemoteCommand._fields)
VEHICLE_WIDTH: Final = len(VehicleState._fields)
MEMORY_WIDTH: Final = len(ArbiterMemory._fields)
LINK_WIDTH: Final = len(Link._fields)
ARBITRATION_WIDTH: Final = len(Arbitration._fields)
COMMAND_WIDTH: Final = len(VehicleCommand._fields)
SETTINGS_WIDTH: Final = len(ControlSettings._fields)
REMOTE_AT: Final = DRIVER_WIDTH
VEHICLE_AT: Final = REMOTE_AT + REMOTE_WIDTH
EVENT_AT: Final = VEHICLE_AT + VEHICLE_WIDTH
ECU_EVENT_AT: Final = EVENT_AT + 1
ECU_AT: Final = ECU_EVENT_AT + 1
HUMAN_AT: Final = ECU_AT + REMOTE_WIDTH
INPUT_WIDTH: Final = HUMAN_AT + 1
ROS_LINK_AT: Final = MEMORY_WIDTH
ECU_LINK_AT: Final = ROS_LINK_AT + LINK_WIDTH
ARBITRATION_AT: Final = ECU_LINK_AT + LINK_WIDTH
COMMAND_AT: Final = ARBITRATION_AT + ARBITRATION_WIDTH
SPEED_AT: Final = COMMAND_AT + COMMAND_WIDTH
OUTPUT_WIDTH: Final = SPEED_AT + 1
VX: Final = VEHICLE_AT + VehicleState._fields.index("vx_mps")
COLUMNS: Final = (
    *DriverInput._fields, *RemoteCommand._fields, *VehicleState._fields, "events", "ecu_events",
    *(f"ecu_{name}" for name in RemoteCommand._fields), "human_nm",
)  # fmt: skip
KEEP_SPEED: Final = 12345.0
"""In the column of vx: the speed follows from the pedals. Anything else is what the vehicle reports."""

OFTEN: Final = {
    Event.RESET: 6.0,
    Event.REQUEST_MANUAL: 4.0,
    Event.REQUEST_AUTONOMOUS: 8.0,
    Event.REQUEST_TAKEOVER: 3.0,
    Event.REQUEST_SHARED: 4.0,
}


@kernel
def drive(inputs: Row, outputs: Row, row: Row, tick_s: float) -> None:
    """Run rows of driver, remote, vehicle and event through arbitration and gate; speed follows the pedals."""
    s = ControlSettings(*take(row, 0, SETTINGS_WIDTH))
    before = np.zeros(OUTPUT_WIDTH)
    speed = 0.0
    for index in range(inputs.shape[0]):
        given = inputs[index]
        vehicle_row = given[VEHICLE_AT : VEHICLE_AT + VEHICLE_WIDTH].copy()
        if given[VX] == KEEP_SPEED:
            vehicle_row[VX - VEHICLE_AT] = speed
        vehicle = VehicleState(*take(vehicle_row, 0, VEHICLE_WIDTH))
        ros = RemoteCommand(*take(given, REMOTE_AT, REMOTE_WIDTH))
        ecu = RemoteCommand(*take(given, ECU_AT, REMOTE_WIDTH))
        command = VehicleCommand(*take(before, COMMAND_AT, COMMAND_WIDTH))
        now = Moment(
            DriverInput(*take(given, 0, DRIVER_WIDTH)),
            ros,
            ecu,
            EventInput(given[EVENT_AT], 0.0, given[ECU_EVENT_AT]),
            vehicle,
            ArbiterMemory(*take(before, 0, MEMORY_WIDTH)),
            Link(*take(before, ROS_LINK_AT, LINK_WIDTH)),
            Link(*take(before, ECU_LINK_AT, LINK_WIDTH)),
            Arbitration(*take(before, ARBITRATION_AT, ARBITRATION_WIDTH)),
            command,
            0.0,
            0.0,
            given[HUMAN_AT],
            s,
            tick_s,
        )
        memory, ros_link, ecu_link, arbitration, request = arbitrate(now)
        remote = ecu if arbitration.commander == ECU else ros
        command = gate(request, remote, arbitration, command, vehicle, s, tick_s)
        put(before, 0, memory)
        put(before, ROS_LINK_AT, ros_link)
        put(before, ECU_LINK_AT, ecu_link)
        put(before, ARBITRATION_AT, arbitration)
        put(before, COMMAND_AT, command)
        before[SPEED_AT] = speed
        outputs[index] = before
        speed = speed + (4.0 * command.throttle - 9.0 * command.brake - 0.2) * tick_s
        if speed < 0.0:
            speed = 0.0


class Drive(NamedTuple):
    """A random drive, by column."""

    settings: ControlSettings
    tick_s: float
    inputs: Rows
    outputs: Rows

    def given(self, name: str) -> Rows:
        return self.inputs[:, COLUMNS.index(name)]

    def of(self, record: type, name: str) -> Rows:
        at = {ArbiterMemory: 0, Arbitration: ARBITRATION_AT, VehicleCommand: COMMAND_AT}[record]
        return self.outputs[:, at + record._fields.index(name)]

    @property
    def events(self) -> NDArray[np.int64]:
        return self.inputs[:, EVENT_AT].astype(np.int64)

    @property
    def heard(self) -> NDArray[np.int64]:
        """Events of operators and, as far as they count, of the ECU."""
        given = np.nan_to_num(self.given("ecu_events"), nan=0.0, posinf=0.0, neginf=0.0)
        ecu = np.where((given >= 0.0) & (given <= 2147483647.0), given, 0.0).astype(np.int64)
        heard = np.where(self.of(Arbitration, "commander") == Commander.ECU, -1, Event.EMERGENCY_STOP | Event.MARK)
        return self.events | (ecu & heard)

    @property
    def age_ticks(self) -> Rows:
        """Of the commander's command."""
        by_ecu = self.of(Arbitration, "commander") == Commander.ECU
        return np.where(by_ecu, self.given("ecu_age_ticks"), self.given("age_ticks"))

    @property
    def modes(self) -> Rows:
        return self.of(Arbitration, "mode")


def lasting(rng: np.random.Generator, steps: int, mean_ticks: float, values: Rows) -> Rows:
    """Choose a value now and then, and keep it meanwhile."""
    change = rng.random(steps) < 1.0 / mean_ticks
    change[0] = True
    return values[rng.integers(len(values), size=steps)][np.maximum.accumulate(np.where(change, np.arange(steps), 0))]


def random_inputs(rng: np.random.Generator, steps: int, stale_ticks: float) -> Rows:
    """Return inputs with long quiet stretches in which modes can last, and nonsense of every kind between them."""
    inputs = np.zeros((steps, INPUT_WIDTH))

    def put_column(name: str, values: Rows) -> None:
        inputs[:, COLUMNS.index(name)] = values

    released = np.array([0.0] * 80 + [0.03, 0.05, 0.3, 1.0])
    put_column("hand_wheel_rad", lasting(rng, steps, 600, rng.normal(0.0, 0.5, 50)))
    put_column("hand_wheel_radps", lasting(rng, steps, 100, np.array([0.0] * 20 + [0.5, -2.0])))
    put_column("throttle", lasting(rng, steps, 60, released))
    put_column("brake", lasting(rng, steps, 60, released))
    put_column("clutch", lasting(rng, steps, 60, np.array([0.0, 0.0, 0.5, 1.0])))
    put_column("gear", lasting(rng, steps, 200, np.array([-1.0, 0.0, 1.0, 2.0, 3.0])))
    put_column("pressed", lasting(rng, steps, 40, np.array([0.0] * 150 + [float(Button.EMERGENCY_STOP)])))
    edge_bits = [Button.AUTONOMOUS, Button.MANUAL, Button.RESET, Button.EMERGENCY_STOP, Button.MARK]
    edges = np.where(rng.random(steps) < 0.02, rng.choice(np.array(edge_bits, dtype=float), steps), 0.0)
    put_column("edges", edges)
    for name in ("wheel_validity", "throttle_validity", "brake_validity"):
        put_column(name, lasting(rng, steps, 150, np.array([2.0] * 60 + [0.0, 1.0, 3.0, 4.0])))
    for name, values in random_commands(rng, steps, stale_ticks).items():
        put_column(name, values)  # the first of two columns of one name is the command's, as `index` finds it
    inputs[:, VX] = KEEP_SPEED
    put_column("ay_mps2", lasting(rng, steps, 200, np.array([0.0] * 6 + [3.0])))
    put_column("coast_accel_mps2", np.full(steps, -0.2))
    put_column("full_throttle_accel_mps2", np.full(steps, 3.8))
    put_column("full_brake_accel_mps2", np.full(steps, -9.2))
    weights = np.array([OFTEN.get(event, 1.0) for event in Event])
    bits = rng.choice(np.array(list(Event), dtype=float), steps, p=weights / weights.sum())
    put_column("events", np.where(rng.random(steps) < 0.02, bits, 0.0))
    put_column("human_nm", lasting(rng, steps, 200, np.array([0.0, 1.0, 3.0, -3.0])))
    nasty = np.array([np.nan, np.inf, -np.inf, 1e308, -1e308, -0.0, 5e-324, 1e9, -1.0, 0.5])
    hit = np.flatnonzero(rng.random(steps) < 0.001)
    inputs[hit, rng.integers(EVENT_AT, size=len(hit))] = rng.choice(nasty, len(hit))
    for name, values in random_commands(rng, steps, stale_ticks).items():
        put_column(f"ecu_{name}", values)
    put_column("ecu_events", np.where(rng.random(steps) < 0.01, rng.choice(np.array(list(Event)), steps), 0.0))
    hit = np.flatnonzero(rng.random(steps) < 0.0005)
    inputs[hit, rng.integers(ECU_EVENT_AT, INPUT_WIDTH, size=len(hit))] = rng.choice(nasty, len(hit))
    return inputs


def random_commands(rng: np.random.Generator, steps: int, stale_ticks: float) -> dict[str, Rows]:
    """Return the columns of one controller: now fresh, now refused, now silent."""
    sent = rng.random(steps) < min(0.6, 5.0 / stale_ticks)
    last = np.maximum.accumulate(np.where(sent, np.arange(steps), -1))
    silent = lasting(rng, steps, 300, np.array([0.0] * 12 + [NEVER_TICKS, 60.0]))
    refused = rng.random(steps) < lasting(rng, steps, 300, np.array([0.0] * 5 + [0.3]))
    return {
        "kind": lasting(rng, steps, 500, np.array([1.0, 2.0, 3.0, 4.0, 5.0, 1.0, 2.0, 0.0, 2.5, 9.0])),
        "sequence": np.cumsum(sent).astype(float),
        "refused": np.cumsum(refused).astype(float),
        "age_ticks": np.where(last < 0, NEVER_TICKS, np.arange(steps) - last) + silent,
        "road_wheel_rad": lasting(rng, steps, 50, rng.normal(0.0, 0.1, 50)),
        "speed_mps": lasting(rng, steps, 200, np.array([0.0, 3.0, 8.0, 12.0, -2.0])),
        "accel_mps2": lasting(rng, steps, 50, rng.normal(0.0, 1.5, 50)),
        "yaw_rate_radps": lasting(rng, steps, 50, rng.normal(0.0, 0.3, 50)),
        "direction": lasting(rng, steps, 400, np.array([1.0] * 8 + [0.0, -1.0])),
        **{name: lasting(rng, steps, 50, rng.normal(0.0, 3.0, 50)) for name in ("x_m", "y_m", "yaw_rad")},
    }


def random_drive(tick_hz: int, seed: int, steps: int, execution: object = compiled, **profile: object) -> Drive:
    print(f"seed {seed}")
    s = settings(ControlProfile(**profile), 15.0, 0.6, 2.6, tick_hz)  # type: ignore[arg-type]
    inputs = random_inputs(np.random.default_rng(seed), steps, s.stale_ticks)
    outputs = np.empty((steps, OUTPUT_WIDTH))
    execution(drive)(inputs, outputs, np.array(s), 1.0 / tick_hz)  # type: ignore[operator]
    return Drive(s, 1.0 / tick_hz, inputs, outputs)


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
    assert reasons >= {
        float(reason) for reason in Reason if 1 <= reason < 20 and reason is not Reason.THROTTLE_OVERRIDE
    }


def test_every_output_is_finite_and_in_its_range(long_drive: Drive) -> None:
    s = long_drive.settings
    assert np.isfinite(long_drive.outputs).all()
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
    speed = long_drive.outputs[1:, SPEED_AT]
    smooth = (jerk_step > 0.0) & (speed > 0.1) & (long_drive.inputs[1:, VX] == KEEP_SPEED)
    assert smooth.sum() > 1_000
    jerk = np.abs(np.diff(angle)) * speed**2 / (long_drive.settings.wheelbase_m * np.cos(angle[:-1]) ** 2)
    assert (jerk[smooth] <= jerk_step[smooth] + 1e-9).all()
    assert (np.abs(np.diff(long_drive.of(VehicleCommand, "brake"))) <= brake_step + tiny).all()
    assert (np.diff(long_drive.of(VehicleCommand, "throttle")) <= throttle_step + tiny).all()
    assert (np.abs(np.diff(long_drive.of(VehicleCommand, "target_speed_mps"))) <= speed_step + tiny).all()
    hand = long_drive.settings.manual_pedal_slew_per_s * long_drive.tick_s + tiny
    assert (np.abs(np.diff(long_drive.of(VehicleCommand, "clutch"))) <= hand).all()


def test_the_brake_beats_the_throttle(long_drive: Drive) -> None:
    throttle = long_drive.of(VehicleCommand, "throttle")
    assert (throttle[long_drive.of(VehicleCommand, "brake") >= long_drive.settings.brake_override] == 0.0).all()
    modes = long_drive.modes
    assert (throttle[(modes >= Mode.MINIMAL_RISK) | (modes == Mode.PARKED)] == 0.0).all()


def asked(long_drive: Drive, event: Event, button: Button | None) -> NDArray[np.bool_]:
    """Return in which ticks a person or an operator asked."""
    by_event = long_drive.heard & int(event) != 0
    if button is None:
        return by_event
    given = np.nan_to_num(long_drive.given("edges"), nan=0.0, posinf=0.0, neginf=0.0)
    known = (given >= 0.0) & (given <= 2147483647.0)
    return by_event | (np.where(known, given, 0.0).astype(np.int64) & int(button) != 0)


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
    driver = DriverInput(*(0.0,) * DRIVER_WIDTH)._replace(**person)
    remote = RemoteCommand(*(0.0,) * REMOTE_WIDTH)._replace(age_ticks=NEVER_TICKS)
    vehicle = VehicleState(*(0.0,) * VEHICLE_WIDTH)
    s = long_drive.settings
    for mode in Mode:
        for index in rng.choice(np.flatnonzero(long_drive.modes == mode), 5):
            row = long_drive.outputs[index]
            ros_link = Link(*row[ROS_LINK_AT:ECU_LINK_AT].tolist())
            ecu_link = Link(*row[ECU_LINK_AT:ARBITRATION_AT].tolist())
            memory, arbitration, command = (
                ArbiterMemory(*row[:ROS_LINK_AT].tolist()),
                Arbitration(*row[ARBITRATION_AT:COMMAND_AT].tolist()),
                VehicleCommand(*row[COMMAND_AT:SPEED_AT].tolist()),
            )
            for tick in range(int(2.0 / long_drive.tick_s)):
                event = Event.REQUEST_MANUAL if tick % 2 else Event.RESET
                happened = EventInput(float(event))
                now = Moment(
                    driver, remote, remote, happened, vehicle, memory, ros_link, ecu_link, arbitration, command,
                    0.0, 0.0, 0.0, s, long_drive.tick_s,
                )  # fmt: skip
                memory, ros_link, ecu_link, arbitration, request = arbitrate(now)
                command = gate(request, remote, arbitration, command, vehicle, s, long_drive.tick_s)
                if arbitration.mode == Mode.MANUAL:
                    break
            assert arbitration.mode == Mode.MANUAL, mode


@pytest.mark.parametrize("tick_hz", [50, 1000])
def test_plain_and_compiled_give_equal_bits(tick_hz: int) -> None:
    drives = [random_drive(tick_hz, SEED - tick_hz, 3000, execution) for execution in (plain, compiled)]
    assert drives[0].outputs.tobytes() == drives[1].outputs.tobytes()
    assert len(set(drives[0].modes)) >= 6
