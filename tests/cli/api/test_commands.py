"""What the constructors ask for, as the arbiter reads it."""

import pytest

from simconsole.cli.api import commands
from simconsole.cli.api.commands import Command
from simconsole.values.signals import NO_COMMAND, RemoteKind


@pytest.mark.parametrize(
    ("command", "kind", "said"),
    [
        (commands.accelerate(1.5, 0.1), RemoteKind.ACCELERATION, {"accel_mps2": 1.5, "road_wheel_rad": 0.1}),
        (commands.accelerate(1.5, reverse=True), RemoteKind.ACCELERATION, {"accel_mps2": 1.5, "direction": -1.0}),
        (commands.hold_speed(8.0, -0.1), RemoteKind.SPEED, {"speed_mps": 8.0, "road_wheel_rad": -0.1}),
        (commands.twist(0.2, 1.0), RemoteKind.TWIST, {"speed_mps": 0.2, "yaw_rate_radps": 1.0}),
        (commands.actuate(0.3, 0.0, 0.2), RemoteKind.ACTUATION, {"throttle": 0.3, "road_wheel_rad": 0.2}),
        (
            commands.go_to(1.0, 2.0, 0.5, 0.8),
            RemoteKind.POSE,
            {"x_m": 1.0, "y_m": 2.0, "yaw_rad": 0.5, "speed_mps": 0.8},
        ),
    ],
)
def test_a_command_says_this_and_nothing_else(command: Command, kind: RemoteKind, said: dict[str, float]) -> None:
    assert command == NO_COMMAND._replace(kind=float(kind), **said)
