from typing import get_args

import pytest

from simconsole.drivers.scripted_controller import ScriptedCommands
from simconsole.profiles.faults import EdgeName
from simconsole.profiles.files.loader import load
from simconsole.profiles.scenario import EventStep, RemoteStep
from simconsole.profiles.session import SessionProfile
from simconsole.session.resolution import resolve
from simconsole.tick.advance import advance
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import compiled
from simconsole.values.signals import NEVER_TICKS, NO_SAMPLE, Event, RemoteKind
from simconsole.values.state_vector import TickInputs


def commands(**keys: object) -> ScriptedCommands:
    step = RemoteStep(start_s=0.1, end_s=0.2, kind="acceleration", accel_mps2=1.0, period_ms=20, **keys)  # type: ignore[arg-type]
    return ScriptedCommands([step], [EventStep(at_s=0.15, event="mark")], 100)


def test_nothing_before_the_first_step() -> None:
    remote, events = commands().take(9)
    assert (remote.kind, remote.age_ticks, events.events) == (RemoteKind.NONE, NEVER_TICKS, 0.0)


def test_a_command_repeats_each_period_and_ages_between_and_after() -> None:
    source = commands()
    seen = [source.take(tick)[0] for tick in range(30)]
    assert [command.age_ticks for command in seen[10:24]] == [0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 2, 3, 4, 5]
    assert seen[10].kind == RemoteKind.ACCELERATION
    assert [command.sequence for command in seen[10:20]] == [1, 1, 2, 2, 3, 3, 4, 4, 5, 5]


def test_an_event_lasts_one_tick() -> None:
    source = commands()
    masks = [int(source.take(tick)[1].events) for tick in range(30)]
    assert masks == [int(Event.MARK) if tick == 15 else 0 for tick in range(30)]


def test_degrees_become_radians() -> None:
    assert abs(commands(road_wheel_deg=10.0).take(10)[0].road_wheel_rad - 0.17453292519943295) < 1e-16


@pytest.mark.parametrize("name", get_args(EdgeName))
def test_every_name_of_an_event_is_one(name: str) -> None:
    source = ScriptedCommands([], [EventStep(at_s=0.0, event=name)], 100)  # type: ignore[arg-type]  # of the Literal
    assert int(source.take(0)[1].events) == Event[name.upper()]


def test_a_scripted_event_switches_stability_control_off_in_the_car_of_a_drive() -> None:
    console, state = assemble(resolve(load("sessions", "seated", SessionProfile)), compiled)
    script = [EventStep(at_s=0.02, event="toggle_stability"), EventStep(at_s=0.1, event="toggle_stability")]
    source = ScriptedCommands([], script, console.tick_hz)
    off = []
    for tick in range(50):
        state, snapshot = advance(state, TickInputs(NO_SAMPLE, *source.take(tick)), console)
        off.append(snapshot.command.stability_off)
    assert off == [float(5 <= tick < 25) for tick in range(50)]
