"""An own controller in the bridge's place: when it is asked, what becomes of its answers, how it fails."""

import math

import numpy as np
import pytest

from simconsole.cli.api.commands import Command, hold_speed
from simconsole.drivers.own_controller import FunctionController, OwnCode, OwnParts
from simconsole.values.layout import write
from simconsole.values.signals import Event, LinkState, Mode
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot


def seen(tick: int, mode: Mode = Mode.PARKED, link: LinkState = LinkState.STEADY) -> Snapshot:
    vector = np.zeros(PLATFORM_AT)
    blank = Snapshot(tick, 250, vector)
    write(vector, LAYOUT.arbitration, blank.arbitration._replace(mode=float(mode)))
    write(vector, LAYOUT.ros_link, blank.ros_link._replace(state=float(link)))
    return Snapshot(tick, 250, vector)


def exchange(controller: FunctionController, snapshot: Snapshot) -> bool:
    return controller.exchange(snapshot, 2.0, lambda: False)


def test_answers_are_counted_and_grow_old() -> None:
    controller = FunctionController(lambda snapshot: hold_speed(float(snapshot.tick)), asks=False)
    assert controller.take(1)[0].sequence == 0.0
    for tick in (5, 10):
        assert exchange(controller, seen(tick))
    command, _ = controller.take(11)
    assert (command.sequence, command.speed_mps, command.age_ticks) == (2.0, 10.0, 0.0)
    assert controller.take(15)[0].age_ticks == 4.0


def test_who_says_nothing_has_answered_and_the_command_grows_old() -> None:
    answers = iter([hold_speed(1.0), None])
    controller = FunctionController(lambda snapshot: next(answers), asks=False)
    assert exchange(controller, seen(5))
    assert exchange(controller, seen(10))
    command, events = controller.take(11)
    assert (command.sequence, command.age_ticks, events.events) == (1.0, 5.0, 0.0)


@pytest.mark.parametrize("wrong", [math.nan, math.inf])
def test_what_is_not_finite_is_refused_as_over_the_bridge(wrong: float) -> None:
    controller = FunctionController(lambda snapshot: hold_speed(wrong), asks=False)
    exchange(controller, seen(5))
    command, _ = controller.take(6)
    assert (command.sequence, command.refused, command.speed_mps) == (0.0, 1.0, 0.0)
    assert controller.counts() == {"own_commands": 0, "own_refused": 1}


def test_lights_go_with_the_command() -> None:
    controller = FunctionController(lambda snapshot: hold_speed(1.0)._replace(turn_indicators=1.0, hazard_lights=1.0))
    exchange(controller, seen(5))
    command, _ = controller.take(6)
    assert (command.turn_indicators, command.hazard_lights) == (1.0, 1.0)


def test_autonomy_is_asked_for_while_parked_once_its_commands_are_steady_and_never_again() -> None:
    controller = FunctionController(lambda snapshot: hold_speed(1.0))
    asked = []
    for tick, snapshot in enumerate(
        [
            seen(1, link=LinkState.UNSTEADY),
            seen(2),
            seen(3),
            seen(4, Mode.AUTONOMOUS),
            seen(5, Mode.STOPPED),
            seen(6, Mode.PARKED),
        ],
        start=1,
    ):
        exchange(controller, snapshot)
        asked.append(int(controller.take(tick + 1)[1].events) == int(Event.REQUEST_AUTONOMOUS))
    assert asked == [False, True, True, False, False, False]


def test_without_asking_nobody_asks() -> None:
    controller = FunctionController(lambda snapshot: hold_speed(1.0), asks=False)
    exchange(controller, seen(5))
    assert controller.take(6)[1].events == 0.0


def test_what_it_raises_ends_the_drive_and_nothing_of_it_is_called_again() -> None:
    calls = []

    def controller(snapshot: Snapshot) -> Command:
        calls.append(snapshot.tick)
        raise ZeroDivisionError("gain")

    parts = OwnParts(OwnCode(controller=controller, observer=lambda snapshot: calls.append(-1)), period_ticks=5)
    assert parts.controller is not None
    assert parts.observer is not None
    assert not parts.ended(seen(0))
    for tick in (5, 10):
        exchange(parts.controller, seen(tick))
        parts.observer.publish(seen(tick))
    assert calls == [5]
    assert parts.ended(seen(10))
    assert isinstance(parts.failure, ZeroDivisionError)


def test_the_drive_ends_when_it_says_so_or_when_asking_that_fails() -> None:
    parts = OwnParts(OwnCode(until=lambda snapshot: snapshot.tick >= 10), period_ticks=5)
    assert [parts.ended(seen(tick)) for tick in (5, 10)] == [False, True]
    failing = OwnParts(OwnCode(until=lambda snapshot: [][0]), period_ticks=5)
    assert failing.ended(seen(5))
    assert isinstance(failing.failure, IndexError)


def test_an_observer_sees_the_ends_of_control_periods_only() -> None:
    ticks: list[int] = []
    parts = OwnParts(OwnCode(observer=lambda snapshot: ticks.append(snapshot.tick)), period_ticks=5)
    assert parts.observer is not None
    for tick in range(1, 16):
        parts.observer.publish(seen(tick))
    assert ticks == [5, 10, 15]
    assert [parts.observer.unseen(tick) for tick in (1, 5, 6)] == [4, 0, 4]
