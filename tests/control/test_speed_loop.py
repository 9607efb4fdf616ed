"""Speed commands over a whole drive: the loop through pedals and vehicle closes."""

from collections.abc import Callable
from typing import Any

from simconsole.values.signals import Event, Mode, RemoteKind


def settled_speed(rig: Any, seconds: float) -> float:
    rig.run(seconds)
    return float(rig.vehicle.vx_mps)


def test_speed_commands_close_the_loop_without_lasting_error(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.send(RemoteKind.SPEED, speed_mps=12.0)
    rig.run(0.3)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert abs(settled_speed(rig, 20.0) - 12.0) < 0.05
    # The vehicle is 0.5 m/s2 weaker than it states: the integral takes that up.
    move = rig._move

    def weaker() -> None:
        move()
        rig.vehicle = rig.vehicle._replace(vx_mps=max(0.0, rig.vehicle.vx_mps - 0.5 * rig.tick_s))

    rig._move = weaker
    assert abs(settled_speed(rig, 20.0) - 12.0) < 0.1


def test_a_speed_command_of_zero_ends_at_rest(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.send(RemoteKind.SPEED, speed_mps=10.0)
    rig.run(0.3)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    rig.send(RemoteKind.SPEED, speed_mps=0.0)
    assert settled_speed(rig, 12.0) == 0.0
    assert rig.command.brake == rig.settings.hold_brake
