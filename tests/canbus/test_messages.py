"""What the console's messages say."""

import math
from collections.abc import Callable

import pytest

from simconsole.canbus.codec import CONSOLE, Codec
from simconsole.canbus.ecu import Listener
from simconsole.canbus.messages import BUILDERS, WHEEL_COLUMNS, wheel_columns
from simconsole.canbus.node import CanNode
from simconsole.session.resolution import load_session, resolve
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import plain
from simconsole.values.signals import Mode, Reason
from simconsole.values.state_vector import Snapshot

Snapshots = Callable[[int], Snapshot]


def test_values_arrive_as_the_snapshot_says(codec: Codec, node: CanNode, snapshot: Snapshots) -> None:
    heard = {}
    listener = Listener(codec, CONSOLE)
    for tick in range(60):
        for frame in node.transmit(snapshot(tick), 0):
            found = listener.take(frame, 0)
            assert found is not None
            if found.values is not None:
                heard[found.name] = found.values
    near = {key: pytest.approx(value, abs=0.13) for key, value in _EXPECTED.items()}
    assert {f"{name}.{signal}": value for name, values in heard.items() for signal, value in values.items()} == near


_EXPECTED = {
    "SC_STEERING.WHEEL_VALIDITY": 2.0,
    "SC_STEERING.HAND_WHEEL_ANGLE": -3.0,
    "SC_STEERING.HAND_WHEEL_RATE": 1.5,
    "SC_STEERING.ROAD_WHEEL_ANGLE": 0.29,
    "SC_PEDALS.THROTTLE": 0.25,
    "SC_PEDALS.BRAKE": 0.5,
    "SC_PEDALS.CLUTCH": 1.0,
    "SC_PEDALS.HANDBRAKE": 0.0,
    "SC_PEDALS.THROTTLE_LIVE": 1.0,
    "SC_PEDALS.BRAKE_LIVE": 0.0,
    "SC_ACTUATION.ROAD_WHEEL_COMMAND": 0.3,
    "SC_ACTUATION.THROTTLE_COMMAND": 0.75,
    "SC_ACTUATION.BRAKE_COMMAND": 0.1,
    "SC_ACTUATION.GATE_LIMITS": 5.0,
    "SC_ACTUATION.TURN_INDICATORS": -1.0,
    "SC_ACTUATION.HAZARD_LIGHTS": 1.0,
    "SC_TORQUE.HANDS_ON": 1.0,
    "SC_TORQUE.MOTOR_ENABLED": 1.0,
    "SC_TORQUE.MOTOR_TORQUE": -1.5,
    "SC_TORQUE.DRIVER_TORQUE": 2.25,
    "SC_TORQUE.CAR_TORQUE": -2.0,
    "SC_MOTION.SPEED": 15.0,
    "SC_MOTION.YAW_RATE": -0.4,
    "SC_MOTION.ACCEL_X": 1.25,
    "SC_MOTION.ACCEL_Y": -6.0,
    "SC_WHEELS.FRONT_LEFT_SPEED": 48.0,
    "SC_WHEELS.FRONT_RIGHT_SPEED": 50.0,
    "SC_WHEELS.REAR_LEFT_SPEED": 48.0,
    "SC_WHEELS.REAR_RIGHT_SPEED": 50.0,
    "SC_POWERTRAIN.GEAR": 3.0,
    "SC_POWERTRAIN.LEVER": -1.0,
    "SC_POWERTRAIN.ENGINE_RUNNING": 1.0,
    "SC_POWERTRAIN.AUTOMATIC": 1.0,
    "SC_POWERTRAIN.ENGINE_SPEED": 300.0 * 30.0 / math.pi,
    "SC_POWERTRAIN.CLUTCH_OPEN": 0.4,
    "SC_STATUS.MODE": float(Mode.AUTONOMOUS),
    "SC_STATUS.REASON": float(Reason.REMOTE_ASKED),
    "SC_STATUS.REFUSAL": 0.0,
    "SC_STATUS.REMOTE_LATERAL": 0.6,
    "SC_STATUS.REMOTE_LONGITUDINAL": 1.0,
    "SC_STATUS.TAKEOVER_STAGE": 1.0,
    "SC_STATUS.COMMAND_STATE": 0.0,
    "SC_STATUS.COMMAND_AGE": 1020.0,
    "SC_STATUS.COMMANDER": 2,
}


def test_every_message_of_the_console_has_a_builder(codec: Codec) -> None:
    assert {info.name for info in codec.sent_by(CONSOLE)} == set(BUILDERS)


def test_columns_of_the_wheels() -> None:
    assert wheel_columns(("a", *WHEEL_COLUMNS)) == (1, 2, 3, 4)
    assert wheel_columns(("a", WHEEL_COLUMNS[0])) is None


def test_shipped_car_has_wheel_speeds_to_send_and_the_ball_has_none() -> None:
    car, _ = assemble(resolve(load_session("can")), plain)
    ball, _ = assemble(resolve(load_session("roll_a_ball")), plain)
    assert wheel_columns(car.columns) is not None
    assert wheel_columns(ball.columns) is None
