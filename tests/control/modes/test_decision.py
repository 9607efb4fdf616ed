"""The decision number by number: what is refused, how long it is shown, and what a change carries."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.control.arbitration import arbitrate
from simconsole.control.modes.decision import decide
from simconsole.control.requests.commander import assess
from simconsole.control.requests.person import Person
from simconsole.control.requests.tick_context import TickContext
from simconsole.values.signals import Commander, Event, Link, LinkState, Mode, Reason, RemoteKind

THERE = Person(1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
STEADY = Link(7.0, 0.0, 0.0, 900.0, 1.0, 0.0, 100.0, float(LinkState.STEADY), 0.0, 0.0)
START = float(Reason.START)


@pytest.fixture
def now(make_rig: Callable[..., Any]) -> TickContext:
    moment = make_rig().moment()
    ros = moment.ros._replace(kind=float(RemoteKind.ACTUATION), sequence=7.0, age_ticks=1.0, direction=1.0)
    manual = moment.before._replace(mode=float(Mode.MANUAL), commander=float(Commander.ROS))
    return moment._replace(ros=ros, ros_before=STEADY, before=manual)  # type: ignore[no-any-return]


def decided(
    now: TickContext, event: Event | int = 0, person: Person = THERE, ecu_event: Event | int = 0
) -> tuple[float, ...]:
    asked = now._replace(events=now.events._replace(events=float(event), ecu_events=float(ecu_event)))
    return decide(asked, person, assess(asked), False, False)


def test_nothing_happens(now: TickContext) -> None:
    assert decided(now) == (Mode.MANUAL, START, 0.0, 0.0, 0.0, 0.0)


def test_each_request_has_its_own_refusal(now: TickContext) -> None:
    fast = now._replace(vehicle=now.vehicle._replace(vx_mps=30.0))
    too_fast = float(Reason.REFUSED_TOO_FAST)
    for event in (Event.REQUEST_AUTONOMOUS, Event.REQUEST_SHARED):
        assert decided(fast, event) == (Mode.MANUAL, START, 0.0, too_fast, 0.0, 0.0)
    stopped = now._replace(before=now.before._replace(mode=float(Mode.STOPPED)))
    assert decided(stopped, Event.RESET) == (Mode.STOPPED, START, 0.0, float(Reason.REFUSED_MOVING), 0.0, 0.0)
    foot = THERE._replace(accelerator=0.9)
    assert decided(stopped, Event.REQUEST_MANUAL, foot)[3] == Reason.REFUSED_THROTTLE_PRESSED
    alone = now._replace(settings=now.settings._replace(person_required=0.0))
    absent = THERE._replace(trusted=0.0)
    driven = alone._replace(before=now.before._replace(mode=float(Mode.AUTONOMOUS)))
    assert decided(driven, Event.REQUEST_SHARED, absent)[3] == Reason.REFUSED_NOT_ARMED
    assert decided(fast, Event.REQUEST_AUTONOMOUS | Event.REQUEST_SHARED)[3] == too_fast


def test_requests_that_are_granted(now: TickContext) -> None:
    for event, mode in ((Event.REQUEST_AUTONOMOUS, Mode.AUTONOMOUS), (Event.REQUEST_SHARED, Mode.SHARED)):
        assert decided(now, event) == (mode, Reason.OPERATOR_ASKED, 1.0, 0.0, 0.0, 1.0)
    driven = now._replace(before=now.before._replace(mode=float(Mode.AUTONOMOUS)))
    assert decided(driven, Event.REQUEST_MANUAL) == (Mode.MANUAL, Reason.OPERATOR_ASKED, 1.0, 0.0, 0.0, 1.0)
    shown = now._replace(before=now.before._replace(refusal=float(Reason.REFUSED_MOVING)))
    assert decided(shown, Event.EMERGENCY_STOP) == (Mode.EMERGENCY_STOP, Reason.EMERGENCY, 1.0, 0.0, 0.0, 1.0)


def test_a_person_is_needed_where_the_profile_says_so(now: TickContext) -> None:
    driven = now._replace(before=now.before._replace(mode=float(Mode.AUTONOMOUS)))
    absent = THERE._replace(trusted=0.0)
    assert decided(driven, person=absent)[:2] == (Mode.TAKEOVER_REQUESTED, Reason.DEVICE_LOST)
    alone = driven._replace(settings=now.settings._replace(person_required=0.0))
    assert decided(alone, person=absent)[0] == Mode.AUTONOMOUS


def test_in_manual_a_person_is_needed_whatever_the_profile_says(now: TickContext) -> None:
    alone = now._replace(settings=now.settings._replace(person_required=0.0))
    assert decided(alone, person=THERE._replace(trusted=0.0))[:2] == (Mode.MINIMAL_RISK, Reason.DEVICE_LOST)


def asked_to_take_over(now: TickContext, reason: Reason, mode_ticks: float) -> TickContext:
    before = now.before._replace(mode=float(Mode.TAKEOVER_REQUESTED), reason=float(reason))
    return now._replace(before=before, memory=now.memory._replace(mode_ticks=mode_ticks))


def test_a_takeover_asked_for_again_is_from_then_on_the_askers(now: TickContext) -> None:
    requested = asked_to_take_over(now, Reason.DEVICE_LOST, 5.0)
    requested = requested._replace(before=requested.before._replace(refusal=float(Reason.REFUSED_MOVING)))
    again = decided(requested, Event.REQUEST_TAKEOVER)
    assert again == (Mode.TAKEOVER_REQUESTED, Reason.REMOTE_ASKED, 0.0, Reason.REFUSED_MOVING, 1.0, 1.0)
    assert decided(requested)[:2] == (Mode.TAKEOVER_REQUESTED, Reason.DEVICE_LOST)
    assert decided(now, Event.REQUEST_TAKEOVER)[:3] == (Mode.MANUAL, START, 0.0)


@pytest.mark.parametrize("mode_ticks", [5.0, 1e6])
def test_a_request_after_a_device_wait_begins_a_wait_of_its_own(mode_ticks: float, now: TickContext) -> None:
    """Only where the device is back, so that nobody is waited for; a wait that runs is never made longer."""
    back = asked_to_take_over(now, Reason.DEVICE_LOST, mode_ticks)
    assert decided(back, Event.REQUEST_TAKEOVER)[::5] == (Mode.TAKEOVER_REQUESTED, 1.0)
    running = asked_to_take_over(now, Reason.REMOTE_ASKED, 5.0)
    assert decided(running, Event.REQUEST_TAKEOVER)[::5] == (Mode.TAKEOVER_REQUESTED, 0.0)
    lost = asked_to_take_over(now, Reason.DEVICE_LOST, 5.0)
    assert decided(lost, Event.REQUEST_TAKEOVER, THERE._replace(trusted=0.0))[::5] == (Mode.TAKEOVER_REQUESTED, 0.0)


def test_a_request_and_a_lost_device_in_one_tick_are_both_kept(now: TickContext) -> None:
    driven = now._replace(before=now.before._replace(mode=float(Mode.AUTONOMOUS)))
    absent = THERE._replace(trusted=0.0)
    both = decided(driven, Event.REQUEST_TAKEOVER, absent)
    assert both == (Mode.TAKEOVER_REQUESTED, Reason.REMOTE_ASKED, 1.0, 0.0, 0.0, 1.0)
    for event, reason in (
        (Event.COMMANDER_LOST, Reason.COMMANDER_LOST),
        (Event.NO_ANSWER, Reason.COMMAND_STALE),
        (Event.REQUEST_TAKEOVER | Event.NO_ANSWER, Reason.COMMAND_STALE),
    ):
        assert decided(driven, event, absent)[:3] == (Mode.MINIMAL_RISK, reason, 1.0)


def test_an_ask_that_meets_something_stronger_is_refused_and_named(now: TickContext) -> None:
    overruled = float(Reason.REFUSED_OVERRULED)
    for event in (Event.REQUEST_MANUAL, Event.COMMANDER_LOST, Event.NO_ANSWER, Event.REQUEST_TAKEOVER):
        for ask in (Event.REQUEST_AUTONOMOUS, Event.REQUEST_SHARED):
            assert decided(now, event | ask) == (Mode.MANUAL, START, 0.0, overruled, 0.0, 0.0)
    stalled = decided(now, Event.LOOP_STALL | Event.REQUEST_AUTONOMOUS)
    assert stalled == (Mode.MINIMAL_RISK, Reason.LOOP_STALL, 1.0, overruled, 0.0, 1.0)
    both = decided(now, Event.REQUEST_AUTONOMOUS | Event.REQUEST_SHARED)
    assert both == (Mode.AUTONOMOUS, Reason.OPERATOR_ASKED, 1.0, overruled, 0.0, 1.0)
    emergency = decided(now, Event.EMERGENCY_STOP | Event.REQUEST_MANUAL | Event.RESET)
    assert emergency == (Mode.EMERGENCY_STOP, Reason.EMERGENCY, 1.0, Reason.REFUSED_EMERGENCY, 0.0, 1.0)
    reset = decided(now, Event.EMERGENCY_STOP | Event.RESET)
    assert reset[:4] == (Mode.EMERGENCY_STOP, Reason.EMERGENCY, 1.0, Reason.REFUSED_EMERGENCY)
    asked = asked_to_take_over(now, Reason.REMOTE_ASKED, 5.0)
    again = decided(asked, Event.REQUEST_TAKEOVER | Event.REQUEST_AUTONOMOUS)
    assert again == (Mode.TAKEOVER_REQUESTED, Reason.REMOTE_ASKED, 0.0, overruled, 0.0, 0.0)
    unheard = decided(now, Event.EMERGENCY_STOP, ecu_event=Event.REQUEST_AUTONOMOUS)
    assert unheard[:4] == (Mode.EMERGENCY_STOP, Reason.EMERGENCY, 1.0, Reason.REFUSED_NOT_COMMANDER)


def test_a_car_that_stands_stopped_is_reset_or_given_to_the_person_but_not_both(now: TickContext) -> None:
    stopped = now._replace(before=now.before._replace(mode=float(Mode.STOPPED)))
    standing = {"person": THERE, "steering": False, "standing": True}

    def stood(event: Event) -> tuple[float, ...]:
        asked = stopped._replace(events=now.events._replace(events=float(event)))
        return decide(asked, controllers=assess(asked), **standing)  # type: ignore[arg-type]

    assert stood(Event.RESET)[:4] == (Mode.PARKED, Reason.RESET, 1.0, 0.0)
    assert stood(Event.RESET | Event.REQUEST_TAKEOVER | Event.COMMANDER_LOST)[:4] == (
        Mode.PARKED,
        Reason.RESET,
        1.0,
        0.0,
    )
    both = stood(Event.RESET | Event.REQUEST_MANUAL)
    assert both[:4] == (Mode.MANUAL, Reason.OPERATOR_ASKED, 1.0, Reason.REFUSED_OVERRULED)
    held_up = stood(Event.LOOP_STALL | Event.REQUEST_MANUAL)
    assert held_up[:4] == (Mode.STOPPED, START, 0.0, Reason.REFUSED_OVERRULED)


@pytest.mark.parametrize("reason", [Reason.DEVICE_LOST, Reason.REMOTE_ASKED])
@pytest.mark.parametrize("trusted", [0.0, 1.0])
def test_nobodys_reaction_ends_in_a_stop_unless_what_was_lost_is_back(
    reason: Reason, trusted: float, now: TickContext
) -> None:
    person = THERE._replace(trusted=trusted)
    last = now.settings.minimal_risk_ticks - 1.0
    back = reason is Reason.DEVICE_LOST and trusted > 0.0
    after = decided(asked_to_take_over(now, reason, last), person=person)
    assert after[:2] == ((Mode.TAKEOVER_REQUESTED, reason) if back else (Mode.MINIMAL_RISK, Reason.NO_REACTION))
    assert decided(asked_to_take_over(now, reason, last - 1.0), person=person)[0] == Mode.TAKEOVER_REQUESTED


@pytest.mark.parametrize("mode", [Mode.MANUAL, Mode.AUTONOMOUS, Mode.SHARED])
def test_a_command_that_steers_too_hard_is_refused_whole_and_may_only_slow_down(mode: Mode, now: TickContext) -> None:
    """What is in force is held; in SHARED the controller's own part: what is in force is the person's, too."""
    before = now.before._replace(mode=float(mode), remote_road_wheel_rad=0.03, remote_throttle=0.04, remote_brake=0.05)
    fast = now._replace(before=before, vehicle=now.vehicle._replace(vx_mps=20.0, ax_mps2=1.0))
    in_force = {"road_wheel_rad": 0.02, "throttle": 0.06, "brake": 0.07}
    fast = fast._replace(command_before=now.command_before._replace(**in_force))
    fast = fast._replace(memory=now.memory._replace(speed_integral_mps2=0.25))
    command = now.ros._replace(direction=1.0, road_wheel_rad=0.5)
    angle, throttle, brake = (0.03, 0.04, 0.05) if mode is Mode.SHARED else (0.02, 0.06, 0.07)
    assert assess(fast._replace(ros=command._replace(road_wheel_rad=0.01))).ros_offered[:3] == (0.01, 0.0, 0.0)
    for asked, pedals in (
        ({"throttle": 0.9}, (throttle, brake)),
        ({"throttle": 0.01}, (0.01, brake)),
        ({"brake": 0.9}, (0.0, 0.9)),
        ({"brake": 0.01}, (0.0, brake)),
    ):
        wild = assess(fast._replace(ros=command._replace(**asked))).ros_offered
        assert wild == (angle, *pedals, 1.0, 0.25)
    automatic = fast._replace(command_before=fast.command_before._replace(automatic=1.0, gear=-1.0))
    assert assess(automatic._replace(ros=command)).ros_offered.direction == -1.0


def test_what_the_commanding_ecu_asks_for_is_heard(now: TickContext) -> None:
    before = now.before._replace(mode=float(Mode.AUTONOMOUS), commander=float(Commander.ECU))
    driven = now._replace(before=before, ecu=now.ros, ecu_before=STEADY)
    assert decided(driven, ecu_event=Event.REQUEST_AUTONOMOUS)[:4] == (Mode.AUTONOMOUS, START, 0.0, 0.0)


def test_an_ecu_that_does_not_command_is_refused_in_words(now: TickContext) -> None:
    unheard = decided(now, ecu_event=Event.REQUEST_AUTONOMOUS)
    assert unheard == (Mode.MANUAL, START, 0.0, float(Reason.REFUSED_NOT_COMMANDER), 0.0, 0.0)
    fast = now._replace(vehicle=now.vehicle._replace(vx_mps=30.0))
    both = decided(fast, Event.REQUEST_AUTONOMOUS, ecu_event=Event.REQUEST_SHARED)
    assert both[3] == Reason.REFUSED_TOO_FAST


def test_a_refusal_is_shown_and_counted_until_its_time_is_over(now: TickContext) -> None:
    refusal = float(Reason.REFUSED_MOVING)
    reason = float(Reason.ARMED)
    before = now.before._replace(refusal=refusal, reason=reason)
    shown = now._replace(before=before, memory=now.memory._replace(refusal_ticks=10.0))
    assert decided(shown) == (Mode.MANUAL, reason, 0.0, refusal, 11.0, 0.0)
    last = now.settings.refusal_ticks - 1.0
    over = now._replace(before=before, memory=now.memory._replace(refusal_ticks=last))
    assert decided(over) == (Mode.MANUAL, reason, 0.0, 0.0, 0.0, 0.0)
    nearly = now._replace(before=before, memory=now.memory._replace(refusal_ticks=last - 1.0))
    assert decided(nearly) == (Mode.MANUAL, reason, 0.0, refusal, last, 0.0)


def test_who_commands_and_what_the_other_asks_for(now: TickContext) -> None:
    held = now.command_before._replace(road_wheel_rad=0.2)
    ecu = now.ros._replace(road_wheel_rad=0.04, throttle=0.5, sequence=1.0)
    both = now._replace(ecu=ecu, ecu_before=STEADY, command_before=held, ros=now.ros._replace(road_wheel_rad=0.03))
    seen = assess(both)
    assert (seen.commander, seen.remote, seen.offered.road_wheel_rad) == (Commander.ROS, both.ros, 0.03)
    assert (seen.ecu_offered.road_wheel_rad, seen.ecu_offered.throttle) == (0.04, 0.5)
    by_ecu = assess(both._replace(settings=now.settings._replace(preferred_commander=float(Commander.ECU))))
    assert (by_ecu.commander, by_ecu.remote, by_ecu.offered.road_wheel_rad) == (Commander.ECU, ecu, 0.04)
    assert by_ecu.link == by_ecu.ecu_link
    silent = assess(both._replace(ecu=ecu._replace(sequence=0.0)))
    assert silent.ecu_offered == (0.2, 0.0, 0.0, 0.0, 0.0)
    last = STEADY._replace(lease_ticks=2.0)
    leased = assess(now._replace(ros=now.ros._replace(age_ticks=1e9), ros_before=last))
    assert leased.commander == Commander.ROS
    over = assess(now._replace(ros=now.ros._replace(age_ticks=1e9), ros_before=last._replace(lease_ticks=1.0)))
    assert over.commander == Commander.NOBODY
    ecu_alone = now._replace(ros=now.ros._replace(age_ticks=1e9), ros_before=STEADY._replace(lease_ticks=0.0))
    ecu_alone = ecu_alone._replace(ecu=ecu._replace(age_ticks=1e9), ecu_before=last)
    assert assess(ecu_alone).commander == Commander.ECU


def test_only_the_commanders_integral_goes_on(now: TickContext) -> None:
    speed = now.ros._replace(kind=float(RemoteKind.SPEED), speed_mps=10.1)
    moving = now.vehicle._replace(vx_mps=10.0, coast_accel_mps2=-0.3, full_throttle_accel_mps2=3.0)
    both = now._replace(ros=speed, ecu=speed, ecu_before=STEADY, vehicle=moving)
    both = both._replace(memory=now.memory._replace(speed_integral_mps2=0.5))
    for commander in (Commander.ROS, Commander.ECU):
        seen = assess(both._replace(settings=now.settings._replace(preferred_commander=float(commander))))
        step = now.settings.integral_gain_per_s * 0.1 * now.tick_s
        mine, other = seen.ros_offered, seen.ecu_offered
        if commander is Commander.ECU:
            mine, other = other, mine
        assert mine.speed_integral_mps2 == pytest.approx(0.5 + step)
        assert other.speed_integral_mps2 == pytest.approx(step)


def test_a_twist_of_standing_keeps_the_angle_in_force(now: TickContext) -> None:
    twist = now.ros._replace(kind=float(RemoteKind.TWIST), speed_mps=0.0, yaw_rate_radps=1.0)
    held = now._replace(ros=twist, command_before=now.command_before._replace(road_wheel_rad=0.2))
    assert assess(held).ros_offered.road_wheel_rad == 0.2
    assert arbitrate(held)[3].ros_road_wheel_rad == 0.2
