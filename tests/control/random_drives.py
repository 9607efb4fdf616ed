"""Random drives through arbitration and gate: inputs of every kind, and one kernel that runs them."""

from collections.abc import Iterable
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.control.arbitration import arbitrate
from simconsole.control.gate import gate
from simconsole.control.requests.control_settings import ControlSettings, settings
from simconsole.control.requests.tick_context import TickContext
from simconsole.profiles.control import ControlProfile
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import Row, kernel
from simconsole.values.layout import Part, read, write
from simconsole.values.signals import (
    NEVER_TICKS,
    ArbiterMemory,
    Arbitration,
    Button,
    Commander,
    DriverInput,
    Event,
    EventInput,
    Link,
    RemoteCommand,
    RemoteKind,
    Validity,
    VehicleCommand,
    VehicleState,
)

Rows = NDArray[np.float64]
SEED: Final = 20_260_302
STEPS: Final = 350_000
PIECE: Final = 50_000
DRIVER: Final = Part(DriverInput)
ROS: Final = Part(RemoteCommand, DRIVER.stop)
VEHICLE: Final = Part(VehicleState, ROS.stop)
EVENT_AT: Final = VEHICLE.stop
ECU_EVENT_AT: Final = EVENT_AT + 1
ECU_COMMAND: Final = Part(RemoteCommand, ECU_EVENT_AT + 1)
HUMAN_AT: Final = ECU_COMMAND.stop
INPUT_WIDTH: Final = HUMAN_AT + 1
MEMORY: Final = Part(ArbiterMemory)
ROS_LINK: Final = Part(Link, MEMORY.stop)
ECU_LINK: Final = Part(Link, ROS_LINK.stop)
ARBITRATION: Final = Part(Arbitration, ECU_LINK.stop)
COMMAND: Final = Part(VehicleCommand, ARBITRATION.stop)
SPEED_AT: Final = COMMAND.stop
OUTPUT_WIDTH: Final = SPEED_AT + 1
SETTINGS: Final = Part(ControlSettings)
SEEN: Final = Part(VehicleState)
VX_SEEN: Final = SEEN.at("vx_mps")
VX: Final = VEHICLE.at("vx_mps")
COLUMNS: Final = (
    *DriverInput._fields, *RemoteCommand._fields, *VehicleState._fields, "events", "ecu_events",
    *(f"ecu_{name}" for name in RemoteCommand._fields), "human_nm",
)  # fmt: skip
GIVEN: Final = ("hand_wheel_rad", "pressed", "edges", "age_ticks", "vx_mps", "events", "ecu_events", "ecu_age_ticks")
DECIDED: Final = (
    *("mode", "reason", "commander", "remote_lateral", "remote_longitudinal", "remote_guidance"),
    *("person_road_wheel_rad", "remote_road_wheel_rad", "person_brake"),
)
COMMANDED: Final = (
    *("road_wheel_rad", "throttle", "brake", "clutch", "handbrake", "gear", "automatic", "target_speed_mps"),
    "gate_active",
)
KEPT: Final = (
    MEMORY.at("mode_ticks"),
    *(ARBITRATION.at(name) for name in DECIDED),
    *(COMMAND.at(name) for name in COMMANDED),
    SPEED_AT,
)
"""The columns that a drive keeps, as those GIVEN of its inputs: all of a long one are 430 MB."""
EVERY: Final = 97
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
def drive(inputs: Row, outputs: Row, row: Row, before: Row, vehicle_row: Row, tick_s: float) -> None:
    """Run rows of driver, remote, vehicle and event through arbitration and gate; speed follows the pedals.

    Kernels make and copy no arrays: `before`, all zeros for the first piece of a drive, and `vehicle_row` are for what
    passes from row to row.
    """
    s = read(row, SETTINGS)
    speed = before[SPEED_AT]
    ros_age_before = ecu_age_before = NEVER_TICKS
    for index in range(inputs.shape[0]):
        given = inputs[index]
        for at in range(len(vehicle_row)):
            vehicle_row[at] = given[VX - VX_SEEN + at]
        if given[VX] == KEEP_SPEED:
            vehicle_row[VX_SEEN] = speed
        vehicle = read(vehicle_row, SEEN)
        ros = read(given, ROS)
        ecu = read(given, ECU_COMMAND)
        command = read(before, COMMAND)
        now = TickContext(
            read(given, DRIVER),
            ros,
            ecu,
            EventInput(given[EVENT_AT], 0.0, given[ECU_EVENT_AT]),
            vehicle,
            read(before, MEMORY),
            read(before, ROS_LINK),
            read(before, ECU_LINK),
            ros_age_before,
            ecu_age_before,
            read(before, ARBITRATION),
            command,
            0.0,
            0.0,
            given[HUMAN_AT],
            0.0,
            0.0,
            1.0,
            s,
            tick_s,
        )
        ros_age_before, ecu_age_before = ros.age_ticks, ecu.age_ticks
        memory, ros_link, ecu_link, arbitration, request = arbitrate(now)
        remote = ecu if arbitration.commander == Commander.ECU else ros
        command = gate(request, remote, arbitration, command, vehicle, s, tick_s, 0.0)
        write(before, MEMORY, memory)
        write(before, ROS_LINK, ros_link)
        write(before, ECU_LINK, ecu_link)
        write(before, ARBITRATION, arbitration)
        write(before, COMMAND, command)
        before[SPEED_AT] = speed
        for at in range(len(before)):
            outputs[index, at] = before[at]
        speed = speed + (4.0 * command.throttle - 9.0 * command.brake - 0.2) * tick_s
        if speed < 0.0:
            speed = 0.0
    before[SPEED_AT] = speed


class Drive(NamedTuple):
    """A random drive, by column."""

    settings: ControlSettings
    tick_s: float
    inputs: dict[str, Rows]
    outputs: dict[int, Rows]
    finite: bool  # all of them, those that are not kept, too
    some: Rows  # every so many rows whole

    def given(self, name: str) -> Rows:
        return self.inputs[name]

    def of(self, record: type[tuple[float, ...]], name: str) -> Rows:
        part = next(part for part in (MEMORY, ARBITRATION, COMMAND) if part.record is record)
        return self.outputs[part.at(name)]

    @property
    def speed_mps(self) -> Rows:
        return self.outputs[SPEED_AT]

    @property
    def events(self) -> NDArray[np.int64]:
        return self.given("events").astype(np.int64)

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
    edge_bits += [Button.INDICATOR_LEFT, Button.INDICATOR_RIGHT, Button.HAZARD]
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
        "turn_indicators": lasting(rng, steps, 400, np.array([0.0, 0.0, 1.0, -1.0, 0.5])),
        "hazard_lights": lasting(rng, steps, 400, np.array([0.0, 0.0, 0.0, 1.0])),
        "direction": lasting(rng, steps, 400, np.array([1.0] * 8 + [0.0, -1.0])),
        **{name: lasting(rng, steps, 50, rng.normal(0.0, 3.0, 50)) for name in ("x_m", "y_m", "yaw_rad")},
    }


def random_drive(
    tick_hz: int, seed: int, steps: int, execution: object = compiled, every: int = EVERY, **profile: object
) -> Drive:
    print(f"seed {seed}")
    s = settings(ControlProfile(**profile), 15.0, 0.6, 2.6, tick_hz)  # type: ignore[arg-type]
    rng = np.random.default_rng(seed)
    pieces = (random_inputs(rng, min(PIECE, steps - first), s.stale_ticks) for first in range(0, steps, PIECE))
    return driven(pieces, s, tick_hz, execution, every)


def driven(
    pieces: Iterable[Rows], s: ControlSettings, tick_hz: int, execution: object = compiled, every: int = EVERY
) -> Drive:
    """Return the drive that all pieces are, one after the other, with the columns that somebody looks at.

    Of its rows each `every`th is kept whole.
    """
    before, vehicle_row, row = np.zeros(OUTPUT_WIDTH), np.zeros(EVENT_AT - VX + VX_SEEN), np.array(s)
    columns = [COLUMNS.index(name) for name in GIVEN]
    inputs, outputs, some, finite = [], [], [], True
    for piece in pieces:
        rows = np.empty((len(piece), OUTPUT_WIDTH))
        execution(drive)(piece, rows, row, before, vehicle_row, 1.0 / tick_hz)  # type: ignore[operator]
        inputs.append(piece[:, columns].T)
        outputs.append(rows[:, KEPT].T)
        some.append(rows[::every].copy())
        finite = finite and bool(np.isfinite(rows).all())
    given = dict(zip(GIVEN, np.concatenate(inputs, axis=1), strict=True))
    kept = dict(zip(KEPT, np.concatenate(outputs, axis=1), strict=True))
    return Drive(s, 1.0 / tick_hz, given, kept, finite, np.concatenate(some))


def calm_inputs(ticks: int, first: int = 0) -> Rows:
    """Return a person who does nothing, a car that can drive, and a controller on the ROS side that commands 10 m/s."""
    inputs = np.zeros((ticks, INPUT_WIDTH))
    values = dict.fromkeys(("wheel_validity", "throttle_validity", "brake_validity"), float(Validity.LIVE))
    values |= {"kind": float(RemoteKind.SPEED), "speed_mps": 10.0, "direction": 1.0, "vx_mps": KEEP_SPEED}
    values |= {"coast_accel_mps2": -0.2, "full_throttle_accel_mps2": 3.8, "full_brake_accel_mps2": -9.2}
    for name, value in {**values, "ecu_age_ticks": NEVER_TICKS}.items():
        inputs[:, COLUMNS.index(name)] = value
    inputs[:, COLUMNS.index("sequence")] = first + np.arange(1.0, ticks + 1.0)
    return inputs
