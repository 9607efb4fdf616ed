"""Every mode met with every trigger, and with every pair of triggers, raised by real inputs and not by its number."""

import itertools
import math
from collections.abc import Callable
from copy import copy
from typing import Any

import pytest

from simconsole.control.modes.mode_table import REACTIONS, REASONS, Trigger
from simconsole.values.signals import Button, Event, Mode, Reason, Validity

PAIRS = list(itertools.product(Mode, Trigger))


def brake(rig: Any) -> None:
    rig.driver = rig.driver._replace(brake=0.2)
    rig.tick()


def steer(rig: Any) -> None:
    rig.driver = rig.driver._replace(hand_wheel_rad=rig.driver.hand_wheel_rad + math.radians(9.0))
    rig.run(0.06)


def lose_wheel(rig: Any) -> None:
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.STALE))
    rig.tick()


def go_silent(rig: Any) -> None:
    rig.sending = False
    rig.run(0.21)


def refuse(rig: Any) -> None:
    rig.sending = False
    for _ in range(5):
        rig.refuse()
        rig.tick()


def wait(rig: Any) -> None:
    rig.run(10.1)


def stand(rig: Any) -> None:
    rig.vehicle = rig.vehicle._replace(vx_mps=0.0, full_throttle_accel_mps2=0.0, coast_accel_mps2=0.0)
    rig.run(0.4)


def reset(rig: Any) -> None:
    if rig.mode is Mode.EMERGENCY_STOP:
        stand(rig)
    rig.tick(Event.RESET)


def get_ready(rig: Any) -> None:
    rig.driver = rig.driver._replace(
        wheel_validity=float(Validity.LIVE),
        throttle_validity=float(Validity.LIVE),
        brake_validity=float(Validity.LIVE),
    )
    rig.tick()


CAUSES: dict[Trigger, Callable[[Any], None]] = {
    Trigger.EMERGENCY: lambda rig: rig.tick(Event.EMERGENCY_STOP),
    Trigger.BRAKE: brake,
    Trigger.STEERING: steer,
    Trigger.MANUAL_ASKED: lambda rig: rig.tick(Event.REQUEST_MANUAL),
    Trigger.LOOP_STALL: lambda rig: rig.tick(Event.LOOP_STALL),
    Trigger.DEVICE_LOST: lose_wheel,
    Trigger.COMMANDER_LOST: lambda rig: rig.tick(Event.COMMANDER_LOST),
    Trigger.COMMAND_STALE: go_silent,
    Trigger.COMMAND_INVALID: refuse,
    Trigger.TAKEOVER_ASKED: lambda rig: rig.tick(Event.REQUEST_TAKEOVER),
    Trigger.NO_REACTION: wait,
    Trigger.STANDSTILL: stand,
    Trigger.RESET: reset,
    Trigger.AUTONOMOUS_ASKED: lambda rig: rig.tick(Event.REQUEST_AUTONOMOUS),
    Trigger.SHARED_ASKED: lambda rig: rig.tick(Event.REQUEST_SHARED),
    Trigger.PERSON_READY: get_ready,
}
ALONE_IN_THE_SEAT = {Trigger.MANUAL_ASKED, Trigger.AUTONOMOUS_ASKED}


@pytest.mark.parametrize(("mode", "trigger"), PAIRS, ids=[f"{mode.name}-{trigger.name}" for mode, trigger in PAIRS])
def test_pair(mode: Mode, trigger: Trigger, make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(mode)
    if mode in (Mode.PARKED, Mode.STOPPED, Mode.TAKEOVER_REQUESTED):
        rig.send()
        rig.run(1.2)
    if mode is Mode.PARKED and trigger in ALONE_IN_THE_SEAT:
        # A person in the seat is never left parked for as long as it takes to ask.
        rig.driver = rig.driver._replace(wheel_validity=2.0, throttle_validity=2.0, brake_validity=2.0)
        rig.settings = rig.settings._replace(person_required=0.0)
    if mode is Mode.MINIMAL_RISK and trigger in (Trigger.NO_REACTION, Trigger.PERSON_READY):
        rig.vehicle = rig.vehicle._replace(vx_mps=100.0)
    before = rig.mode
    CAUSES[trigger](rig)
    assert rig.mode is REACTIONS[mode].get(trigger, before)


# What can be true in one tick. Each sets inputs and memory so that the coming tick has the trigger.
def _brake(rig: Any) -> None:
    rig.driver = rig.driver._replace(brake=0.2)


def _steer(rig: Any) -> None:
    rig.driver = rig.driver._replace(hand_wheel_rad=rig.memory.engage_hand_wheel_rad + math.radians(9.0))
    rig.memory = rig.memory._replace(steering_ticks=rig.settings.steering_override_ticks)


def _lose_wheel(rig: Any) -> None:
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.STALE))


def _stale(rig: Any) -> None:
    rig.sending = False
    rig.remote = rig.remote._replace(age_ticks=rig.settings.stale_ticks)


def _no_reaction(rig: Any) -> None:
    rig.memory = rig.memory._replace(mode_ticks=rig.settings.minimal_risk_ticks)


def _stand(rig: Any) -> None:
    rig.vehicle = rig.vehicle._replace(vx_mps=0.0)
    rig.memory = rig.memory._replace(standstill_ticks=rig.settings.standstill_ticks)


def _ready(rig: Any) -> None:
    live = dict.fromkeys(("wheel_validity", "throttle_validity", "brake_validity"), float(Validity.LIVE))
    rig.driver = rig.driver._replace(**live)


AT_ONCE: dict[Trigger, Callable[[Any], None] | Event] = {
    Trigger.EMERGENCY: Event.EMERGENCY_STOP,
    Trigger.BRAKE: _brake,
    Trigger.STEERING: _steer,
    Trigger.MANUAL_ASKED: Event.REQUEST_MANUAL,
    Trigger.LOOP_STALL: Event.LOOP_STALL,
    Trigger.DEVICE_LOST: _lose_wheel,
    Trigger.COMMANDER_LOST: Event.COMMANDER_LOST,
    Trigger.COMMAND_STALE: _stale,
    Trigger.COMMAND_INVALID: lambda rig: rig.refuse(5),
    Trigger.TAKEOVER_ASKED: Event.REQUEST_TAKEOVER,
    Trigger.NO_REACTION: _no_reaction,
    Trigger.STANDSTILL: _stand,
    Trigger.RESET: Event.RESET,
    Trigger.AUTONOMOUS_ASKED: Event.REQUEST_AUTONOMOUS,
    Trigger.SHARED_ASKED: Event.REQUEST_SHARED,
    Trigger.PERSON_READY: _ready,
}
PERSONS = {Trigger.BRAKE, Trigger.STEERING, Trigger.MANUAL_ASKED, Trigger.SHARED_ASKED, Trigger.AUTONOMOUS_ASKED}
"""These need wheel and pedals: with the wheel lost they are not there (`DEVICE_LOST` hides them)."""
ENGAGING = {Trigger.AUTONOMOUS_ASKED, Trigger.SHARED_ASKED}
HIDES: dict[Trigger, set[Trigger]] = {
    Trigger.EMERGENCY: {Trigger.RESET},
    Trigger.BRAKE: ENGAGING,
    Trigger.DEVICE_LOST: PERSONS | {Trigger.PERSON_READY},
    Trigger.COMMAND_STALE: ENGAGING,
    Trigger.COMMAND_INVALID: ENGAGING | {Trigger.COMMAND_STALE},
}
WATCHED = (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.MINIMAL_RISK)
TAKING = [trigger for trigger in Trigger if trigger <= Trigger.NO_REACTION]


def expected(mode: Mode, present: set[Trigger]) -> tuple[Mode, Trigger | None]:
    """The rule of docs/modes.md: the mode after this tick, and the trigger that decided it."""

    def takers(where: Mode) -> list[Trigger]:
        still = where in (Mode.PARKED, Mode.STOPPED)
        return [trigger for trigger in TAKING if trigger in present and not (still and trigger is Trigger.MANUAL_ASKED)]

    now, decisive = mode, None
    for trigger in TAKING:
        if trigger in takers(now) and trigger in REACTIONS[now]:
            now, decisive = REACTIONS[now][trigger], trigger
    if decisive is not None:
        return now, decisive
    for trigger in sorted(present):
        target = REACTIONS[mode].get(trigger)
        if target is not None and not any(taker in REACTIONS[target] for taker in takers(target)):
            return target, trigger
    return mode, None


def alone(mode: Mode, trigger: Trigger) -> set[Trigger]:
    """What is true in this tick besides: who stands in these modes is ready, and what only counts in some modes."""
    if trigger is Trigger.STEERING and mode not in WATCHED:
        return set()
    if trigger is Trigger.NO_REACTION and mode is not Mode.TAKEOVER_REQUESTED:
        return set()
    if trigger is Trigger.RESET and mode is Mode.EMERGENCY_STOP:
        return set()  # it moves still: where STANDSTILL is raised as well, the pair has both
    return {trigger}


@pytest.mark.parametrize("mode", Mode, ids=lambda mode: mode.name)
def test_every_pair_of_triggers_in_one_tick(mode: Mode, make_rig: Callable[..., Any]) -> None:
    """Both take effect in their tick, or the weaker one is refused by name; the tick after has nothing left of it."""
    start = make_rig().drive(mode)
    if mode is not Mode.PARKED:
        start.send()
        start.run(0.3 if mode is Mode.STOPPED else 0.1)
    start.ros_link = start.ros_link._replace(fresh_ticks=1e6)
    if mode is Mode.MINIMAL_RISK:
        start.vehicle = start.vehicle._replace(vx_mps=5.0)
    assert start.mode is mode
    for first, second in itertools.combinations(Trigger, 2):
        rig = copy(start)  # it holds nothing but values
        events = 0
        for trigger in (second, first):  # what makes somebody ready goes before what makes them not
            cause = AT_ONCE[trigger]
            if isinstance(cause, Event):
                events |= int(cause)
            else:
                cause(rig)
        before = rig.arbitration
        present = alone(mode, first) | alone(mode, second) | ambient(rig, mode, {first, second})
        hidden = {weak for strong in present for weak in HIDES.get(strong, set())}
        rig.tick(events)
        after, decisive = expected(mode, present - hidden)
        told = (mode.name, first.name, second.name, rig.mode.name, rig.reason.name)
        assert rig.mode is after, told
        asks = {Trigger.MANUAL_ASKED, Trigger.AUTONOMOUS_ASKED, Trigger.SHARED_ASKED} & {first, second}
        targets = {Trigger.MANUAL_ASKED: Mode.MANUAL, Trigger.AUTONOMOUS_ASKED: Mode.AUTONOMOUS}
        unmet = [ask for ask in asks if targets.get(ask, Mode.SHARED) is not after]
        assert (rig.refusal is not None) >= bool(unmet), told
        asked_again = Trigger.TAKEOVER_ASKED in present and after is Mode.TAKEOVER_REQUESTED
        if asked_again:
            assert rig.reason is Reason.REMOTE_ASKED, told
        elif decisive is None:
            assert rig.arbitration.reason == before.reason, told
        elif decisive not in asks:
            assert rig.reason is REASONS[decisive] or rig.reason is Reason.OPERATOR_ASKED, told


def ambient(rig: Any, mode: Mode, raised: set[Trigger]) -> set[Trigger]:
    """What is true whoever raises what: of the person who sits there, the car that stands, the silent controller."""
    present = set()
    if rig.remote.sequence == 0.0 or mode is Mode.PARKED:
        present.add(Trigger.COMMAND_STALE)
    gone = rig.driver.wheel_validity not in (1.0, 2.0)
    if gone:
        present.add(Trigger.DEVICE_LOST)
    else:
        present.add(Trigger.PERSON_READY)
    if mode in (Mode.STOPPED, Mode.PARKED) or Trigger.STANDSTILL in raised:
        present.add(Trigger.STANDSTILL)
    if mode is Mode.EMERGENCY_STOP and raised >= {Trigger.STANDSTILL, Trigger.RESET}:
        present.add(Trigger.RESET)
    if mode is Mode.PARKED and Trigger.RESET in raised:
        present.add(Trigger.RESET)
    return present


def test_a_request_beside_a_lost_wheel_stays_when_the_wheel_is_back(make_rig: Callable[..., Any]) -> None:
    """Swallowed once: TAKEOVER_REQUESTED stayed to the end of the drive."""
    rig = make_rig().drive(Mode.AUTONOMOUS, speed_mps=8.0)
    there = rig.driver
    lose_wheel_and_ask = rig.driver._replace(wheel_validity=float(Validity.LOST))
    rig.driver = lose_wheel_and_ask
    rig.tick(Event.REQUEST_TAKEOVER)
    assert (rig.mode, rig.reason) == (Mode.TAKEOVER_REQUESTED, Reason.REMOTE_ASKED)
    rig.run(1.0)
    rig.driver = there
    limit = round((rig.settings.minimal_risk_ticks) - rig.memory.mode_ticks)
    assert rig.until(Mode.MINIMAL_RISK, limit + 1) <= limit
    assert rig.reason is Reason.NO_REACTION


def test_a_request_after_the_wheel_is_back_waits_as_long_as_any(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS, speed_mps=8.0)
    rig._move = lambda: None
    there = rig.driver
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.LOST))
    rig.run(1.0)
    rig.driver = there
    rig.run(12.0)
    assert (rig.mode, rig.reason) == (Mode.TAKEOVER_REQUESTED, Reason.DEVICE_LOST)
    rig.tick(Event.REQUEST_TAKEOVER)
    assert (rig.mode, rig.reason) == (Mode.TAKEOVER_REQUESTED, Reason.REMOTE_ASKED)
    rig.run(5.0)
    rig.tick(Event.REQUEST_TAKEOVER)
    assert rig.until(Mode.MINIMAL_RISK) == pytest.approx(5.0 * rig.tick_hz, abs=2.0), "asking again waits no longer"


@pytest.mark.parametrize("event", [Event.COMMANDER_LOST, Event.NO_ANSWER])
def test_a_lost_controller_beside_a_lost_wheel_is_a_stop_in_that_tick(
    event: Event, make_rig: Callable[..., Any]
) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    lose = rig.driver._replace(wheel_validity=float(Validity.LOST))
    rig.driver = lose
    rig.tick(event)
    assert rig.mode is Mode.MINIMAL_RISK
    assert rig.memory.stop_steered == 0.0, "nobody steers by the last word of a controller that is gone"


def test_a_stop_that_the_controller_steers_ends_its_part_when_it_leaves(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.tick(Event.LOOP_STALL)
    assert (rig.mode, rig.memory.stop_steered) == (Mode.MINIMAL_RISK, 1.0)
    rig.tick(Event.COMMANDER_LOST)
    assert rig.memory.stop_steered == 0.0
    rig.run(0.1)
    assert rig.memory.stop_steered == 0.0


@pytest.mark.parametrize(
    ("button", "mode", "after", "reason"),
    [
        (Button.EMERGENCY_STOP, Mode.AUTONOMOUS, Mode.EMERGENCY_STOP, Reason.EMERGENCY),
        (Button.MANUAL, Mode.AUTONOMOUS, Mode.MANUAL, Reason.PERSON_ASKED),
        (Button.AUTONOMOUS, Mode.MANUAL, Mode.AUTONOMOUS, Reason.PERSON_ASKED),
        (Button.RESET, Mode.STOPPED, Mode.PARKED, Reason.RESET),
        (Button.MARK, Mode.MANUAL, Mode.MANUAL, Reason.ARMED),
    ],
)
def test_the_wheels_buttons_do_what_events_do(
    button: Button, mode: Mode, after: Mode, reason: Reason, make_rig: Callable[..., Any]
) -> None:
    rig = make_rig().drive(mode)
    rig.tick(edge=button)
    assert (rig.mode, rig.reason) == (after, reason)


def test_an_operator_is_named_as_such(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert rig.reason is Reason.OPERATOR_ASKED
    rig.tick(Event.REQUEST_TAKEOVER)
    assert rig.reason is Reason.REMOTE_ASKED
    rig.tick(Event.REQUEST_MANUAL)
    assert rig.reason is Reason.OPERATOR_ASKED


@pytest.mark.parametrize(
    ("button", "event", "mode", "persons", "operators", "others"),
    [
        (Button.EMERGENCY_STOP, Event.EMERGENCY_STOP, Mode.AUTONOMOUS, "EMERGENCY", "OPERATOR_EMERGENCY", "EMERGENCY"),
        (Button.RESET, Event.RESET, Mode.STOPPED, "RESET", "OPERATOR_RESET", "RESET"),
        (Button.TAKEOVER, Event.REQUEST_TAKEOVER, Mode.AUTONOMOUS, "PERSON_ASKED", "OPERATOR_ASKED", "REMOTE_ASKED"),
        (Button.TAKEOVER, Event.REQUEST_TAKEOVER, Mode.SHARED, "PERSON_ASKED", "OPERATOR_ASKED", "REMOTE_ASKED"),
    ],
)
def test_each_act_is_told_as_the_act_of_whoever_did_it(
    button: Button,
    event: Event,
    mode: Mode,
    persons: str,
    operators: str,
    others: str,
    make_rig: Callable[..., Any],
) -> None:
    told = []
    operator = event | Event.OPERATOR
    for edge, events in ((button, Event(0)), (Button(0), operator), (Button(0), event), (button, operator)):
        rig = make_rig().drive(mode)
        rig.tick(events, edge)
        assert rig.mode is not mode
        told.append(rig.reason.name)
    assert told == [persons, operators, others, persons]


def test_a_held_emergency_button_is_enough(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS)
    rig.driver = rig.driver._replace(pressed=float(Button.EMERGENCY_STOP))
    rig.tick()
    assert rig.mode is Mode.EMERGENCY_STOP
