"""One tick of arbitration from a moment in which every number is known and no two are equal."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.control.arbitration import arbitrate, watched
from simconsole.control.modes.decision import takeover_stage
from simconsole.control.requests.tick_context import TickContext
from simconsole.values.signals import Commander, Event, Link, LinkState, Mode, Notice, Reason, RemoteKind, Validity

MakeRig = Callable[..., Any]
STEADY = Link(7.0, 3.0, 0.0, 90.0, 1.0, 0.0, 100.0, float(LinkState.STEADY), 0.0, 0.0)


@pytest.fixture
def now(make_rig: MakeRig) -> TickContext:
    """AUTONOMOUS by the ECU, the person's accelerator pressed, the wheel on its way past the threshold."""
    moment = make_rig().moment()
    ros = moment.ros._replace(
        kind=float(RemoteKind.ACTUATION), sequence=7.0, refused=3.0, age_ticks=2.0,
        road_wheel_rad=0.03, throttle=0.31, brake=0.02, direction=1.0,
    )  # fmt: skip
    before = moment.before._replace(
        mode=float(Mode.AUTONOMOUS), reason=float(Reason.PERSON_ASKED), commander=float(Commander.ECU),
        remote_lateral=0.9, remote_longitudinal=0.8, remote_guidance=0.4,
    )  # fmt: skip
    return moment._replace(  # type: ignore[no-any-return]
        driver=moment.driver._replace(hand_wheel_rad=0.45, throttle=0.5, brake=0.04),
        ros=ros,
        ecu=ros._replace(turn_indicators=1.0, sequence=8.0, road_wheel_rad=0.04, throttle=0.0, brake=0.06),
        memory=moment.memory._replace(
            mode_ticks=41.0, engage_hand_wheel_rad=0.2, steering_ticks=5.0, refusal_ticks=9.0, standstill_ticks=0.0,
            hold_road_wheel_rad=0.07, shared_trade=0.25, stalk=-1.0, hazard_switch=1.0,
            throttle_held_ticks=30.0,
        ),
        vehicle=moment.vehicle._replace(vx_mps=12.0),
        ros_before=STEADY,
        ecu_before=STEADY._replace(sequence_seen=6.0),
        before=before,
        command_before=moment.command_before._replace(road_wheel_rad=0.02, gear=1.0, automatic=1.0),
    )  # fmt: skip


def test_what_is_remembered_and_shown(now: TickContext) -> None:
    memory, ros_link, ecu_link, shown, request = arbitrate(now)
    s = now.settings
    assert memory._asdict() == {
        "mode_ticks": 42.0,
        "engage_hand_wheel_rad": 0.2,
        "steering_ticks": 6.0,
        "throttle_override": 1.0,
        "refusal_ticks": 0.0,
        "standstill_ticks": 0.0,
        "speed_integral_mps2": 0.0,
        "stop_accel_mps2": 0.0,
        "hold_road_wheel_rad": 0.07,
        "shared_trade": 1.0,
        "stop_steered": 0.0,
        "stalk": -1.0,
        "hazard_switch": 1.0,
        "throttle_held_ticks": 31.0,
        "restart_ticks": 0.0,
    }
    fields = shown._asdict()
    assert fields["mode"] == Mode.AUTONOMOUS
    assert (fields["reason"], fields["refusal"], fields["takeover_stage"]) == (Reason.PERSON_ASKED, 0.0, 0.0)
    assert fields["remote_lateral"] == pytest.approx(0.9 + s.fade_per_tick)
    assert fields["remote_longitudinal"] == pytest.approx(0.8 - s.fade_per_tick)
    assert fields["remote_guidance"] == pytest.approx(0.4 - s.fade_per_tick)
    person = [fields[f"person_{name}"] for name in ("road_wheel_rad", "throttle", "brake")]
    assert person == [pytest.approx(0.03), 0.5, 0.04]
    for source, asked in (("remote", (0.04, 0.0, 0.06)), ("ecu", (0.04, 0.0, 0.06)), ("ros", (0.03, 0.31, 0.02))):
        assert tuple(fields[f"{source}_{name}"] for name in ("road_wheel_rad", "throttle", "brake")) == asked
    assert (fields["commander"], fields["restarted"], fields["notice"]) == (Commander.ECU, 0.0, 0.0)
    assert (ros_link.sequence_seen, ros_link.fresh_ticks) == (7.0, 91.0)
    assert (ecu_link.sequence_seen, ecu_link.fresh_ticks) == (8.0, 91.0)
    lateral, longitudinal = shown.remote_lateral, shown.remote_longitudinal
    assert request.road_wheel_rad == pytest.approx(0.03 + lateral * 0.01)
    assert request.throttle == pytest.approx((1.0 - longitudinal) * 0.5)
    assert request.brake == pytest.approx(longitudinal * 0.06 + (1.0 - longitudinal) * 0.04)
    assert (request.gear, request.automatic) == (1.0, 1.0)
    assert (request.turn_indicators, request.hazard_lights) == (1.0, 1.0)


def test_a_change_of_mode_begins_its_time_anew(now: TickContext) -> None:
    takeover = now._replace(events=now.events._replace(events=float(Event.REQUEST_TAKEOVER)))
    memory, _, _, shown, _ = arbitrate(takeover)
    assert (memory.mode_ticks, shown.mode, shown.takeover_stage) == (0.0, Mode.TAKEOVER_REQUESTED, 1.0)
    assert memory.hold_road_wheel_rad == 0.02


def test_a_controller_that_asks_for_what_the_person_steered_takes_over_their_stop(now: TickContext) -> None:
    stalled = now._replace(
        before=now.before._replace(mode=float(Mode.MANUAL)),
        events=now.events._replace(events=float(Event.LOOP_STALL)),
        driver=now.driver._replace(brake=0.0),
    )
    memory, _, _, shown, _ = arbitrate(stalled)
    assert (shown.mode, memory.stop_steered, memory.hold_road_wheel_rad) == (Mode.MINIMAL_RISK, 1.0, 0.03)
    other = stalled._replace(ros=now.ros._replace(road_wheel_rad=0.1))
    assert arbitrate(other)[0].stop_steered == 0.0


@pytest.mark.parametrize("event", [0, Event.COMMANDER_LOST, Event.NO_ANSWER])
def test_a_controller_that_is_gone_does_not_steer_the_stop_that_it_steered(event: Event, now: TickContext) -> None:
    """Its last command asks for 0.04 rad; without it the wheels go from where they are held to straight."""
    stopping = now.before._replace(mode=float(Mode.MINIMAL_RISK))
    steered = now._replace(before=stopping, memory=now.memory._replace(stop_steered=1.0, steering_ticks=0.0))
    calm = now.driver._replace(throttle=0.0, brake=0.0, hand_wheel_rad=0.2)
    ecu_events = now.events._replace(ecu_events=float(event))
    memory, *_, request = arbitrate(steered._replace(events=ecu_events, driver=calm))
    assert memory.stop_steered == (0.0 if event else 1.0)
    decay = now.settings.stop_road_wheel_decay_radps * now.tick_s
    assert request.road_wheel_rad == pytest.approx(0.07 - decay if event else 0.04)


def test_each_controllers_own_age_counts_where_it_steers_too_hard(now: TickContext) -> None:
    aged = now._replace(ros_age_before_ticks=11.0, ecu_age_before_ticks=22.0)
    wild = {"road_wheel_rad": 0.5, "sequence": 9.0}
    _, ros_link, ecu_link, *_ = arbitrate(aged._replace(ros=now.ros._replace(**wild), ecu=now.ecu._replace(**wild)))
    assert (ros_link.implausible_ticks, ecu_link.implausible_ticks) == (12.0, 23.0)


def test_a_restart_that_is_refused_says_so_and_changes_nothing_else(now: TickContext) -> None:
    """The wheel is off the centre and the car moves; whatever else was refused in this tick gives way."""
    plain = arbitrate(now)
    asked = now._replace(events=now.events._replace(events=float(Event.RESTART)))
    memory, _, _, shown, request = arbitrate(asked)
    assert shown == plain[3]._replace(refusal=float(Reason.REFUSED_PEDAL_PRESSED))
    assert (memory, request) == (plain[0]._replace(refusal_ticks=0.0), plain[4])
    off_centre = asked._replace(driver=now.driver._replace(throttle=0.0))
    assert arbitrate(off_centre)[3].refusal == Reason.REFUSED_WHEEL_NOT_CENTRED
    takeover = asked._replace(events=now.events._replace(events=float(Event.RESTART | Event.REQUEST_TAKEOVER)))
    memory, _, _, shown, _ = arbitrate(takeover)
    assert (shown.mode, shown.reason) == (Mode.TAKEOVER_REQUESTED, Reason.REMOTE_ASKED)
    assert (shown.refusal, memory.mode_ticks) == (Reason.REFUSED_PEDAL_PRESSED, 0.0)


def test_a_restart_is_granted_or_waits_and_says_for_what(now: TickContext) -> None:
    calm = now._replace(
        driver=now.driver._replace(hand_wheel_rad=0.0, throttle=0.0, brake=0.0),
        events=now.events._replace(events=float(Event.RESTART)),
        vehicle=now.vehicle._replace(vx_mps=0.0),
    )
    memory, _, _, shown, _ = arbitrate(calm)
    assert (memory.restart_ticks, shown.restarted, shown.notice, shown.refusal) == (0.0, 1.0, 0.0, 0.0)
    latched = arbitrate(calm._replace(before=now.before._replace(mode=float(Mode.EMERGENCY_STOP))))[3]
    assert (latched.restarted, latched.refusal) == (0.0, Reason.REFUSED_EMERGENCY)
    turned = calm._replace(driver=calm.driver._replace(hand_wheel_rad=0.2))
    for motor, notice in ((0.0, Notice.CENTRE_WHEEL), (1.0, Notice.CENTRING_WHEEL)):
        memory, _, _, shown, _ = arbitrate(turned._replace(wheel_motor=motor))
        assert (memory.restart_ticks, shown.restarted, shown.notice, shown.refusal) == (1.0, 0.0, notice, 0.0)


def test_an_accelerator_held_over_the_controller_is_told_after_its_time(now: TickContext) -> None:
    ticks = now.settings.throttle_held_ticks
    for before, notice in ((ticks - 1.0, 0.0), (ticks, float(Notice.THROTTLE_HELD))):
        memory, _, _, shown, _ = arbitrate(now._replace(memory=now.memory._replace(throttle_held_ticks=before)))
        assert (memory.throttle_held_ticks, shown.notice) == (before + 1.0, notice)


def test_the_motors_own_motion_is_taken_off_the_hand_wheels(now: TickContext) -> None:
    still = now._replace(memory=now.memory._replace(steering_ticks=0.0), explained_rad=0.25)
    assert arbitrate(still)[0].steering_ticks == 0.0
    assert arbitrate(still._replace(explained_rad=0.0))[0].steering_ticks == 1.0
    fast = still._replace(driver=still.driver._replace(hand_wheel_radps=2.0))
    assert arbitrate(fast)[0].steering_ticks == 1.0
    assert arbitrate(fast._replace(explained_radps=1.5))[0].steering_ticks == 0.0
    lost = now._replace(driver=now.driver._replace(wheel_validity=float(Validity.LOST)))
    assert arbitrate(lost)[0].steering_ticks == -1.0


@pytest.mark.parametrize("mode", Mode)
def test_only_from_what_drives_itself_the_wheel_takes_over(mode: Mode, now: TickContext) -> None:
    drives = mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.MINIMAL_RISK)
    assert watched(float(mode)) == drives
    memory = arbitrate(now._replace(before=now.before._replace(mode=float(mode))))[0]
    assert memory.engage_hand_wheel_rad == (0.2 if drives else 0.45)


def test_standing_is_counted_while_it_lasts(now: TickContext) -> None:
    standing = now._replace(vehicle=now.vehicle._replace(vx_mps=0.0))
    assert arbitrate(standing)[0].standstill_ticks == 1.0
    longer = standing._replace(memory=standing.memory._replace(standstill_ticks=30.0))
    assert arbitrate(longer)[0].standstill_ticks == 31.0
    rolling = now._replace(memory=now.memory._replace(standstill_ticks=30.0))
    assert arbitrate(rolling)[0].standstill_ticks == 0.0


def test_a_vehicle_stands_after_exactly_the_time_of_the_profile(now: TickContext) -> None:
    stop = now._replace(
        before=now.before._replace(mode=float(Mode.MINIMAL_RISK)),
        driver=now.driver._replace(hand_wheel_rad=0.2, brake=0.0),
        vehicle=now.vehicle._replace(vx_mps=0.0),
    )
    ticks = now.settings.standstill_ticks
    for before, mode in ((ticks - 2.0, Mode.MINIMAL_RISK), (ticks - 1.0, Mode.STOPPED)):
        moment = stop._replace(memory=stop.memory._replace(standstill_ticks=before, steering_ticks=0.0))
        assert arbitrate(moment)[3].mode == mode


def test_the_trade_is_remembered_in_shared_alone(now: TickContext) -> None:
    shared = now._replace(
        before=now.before._replace(mode=float(Mode.SHARED)),
        settings=now.settings._replace(shared_rule=2.0),
        human_nm=-9.0,
    )
    step = now.settings.shared_trade_per_tick
    memory, _, _, shown, _ = arbitrate(shared)
    assert (shown.mode, memory.shared_trade) == (Mode.SHARED, pytest.approx(0.25 - step))
    assert arbitrate(shared._replace(human_nm=0.0))[0].shared_trade == pytest.approx(0.25 + step)
    elsewhere = shared._replace(before=now.before)
    assert arbitrate(elsewhere)[0].shared_trade == 1.0


def test_a_torque_that_was_held_at_engagement_or_is_the_hands_mass_pulls_nobody_out(now: TickContext) -> None:
    driver = now.driver._replace(hand_wheel_rad=0.2, hand_wheel_radps=0.0)
    pulling = now._replace(driver=driver, human_nm=now.settings.steering_override_nm + 0.1)
    assert arbitrate(pulling)[0].steering_ticks == 6.0
    assert arbitrate(pulling._replace(carried_nm=0.2))[0].steering_ticks == 0.0
    assert arbitrate(pulling._replace(hand_wheel_radps2=-20.0))[0].steering_ticks == 0.0


def test_a_refusal_is_shown_for_its_time(now: TickContext) -> None:
    refused = now.before._replace(refusal=float(Reason.REFUSED_MOVING))
    last = now.settings.refusal_ticks - 1.0
    for before, refusal, ticks in ((last - 1.0, float(Reason.REFUSED_MOVING), last), (last, 0.0, 0.0)):
        memory, _, _, shown, _ = arbitrate(
            now._replace(before=refused, memory=now.memory._replace(refusal_ticks=before))
        )
        assert (shown.refusal, memory.refusal_ticks) == (refusal, ticks)


def test_a_takeover_escalates_and_ends_to_the_tick(now: TickContext) -> None:
    s = now.settings
    asked = float(Mode.TAKEOVER_REQUESTED)
    assert takeover_stage(asked, s.escalation_ticks - 1.0, s) == 1.0
    assert takeover_stage(asked, s.escalation_ticks, s) == 2.0
    assert takeover_stage(float(Mode.AUTONOMOUS), s.escalation_ticks, s) == 0.0
    calm = now._replace(
        before=now.before._replace(mode=asked), driver=now.driver._replace(hand_wheel_rad=0.2, brake=0.0, throttle=0.0)
    )
    for ticks, mode in ((s.minimal_risk_ticks - 2.0, asked), (s.minimal_risk_ticks - 1.0, float(Mode.MINIMAL_RISK))):
        moment = calm._replace(memory=calm.memory._replace(mode_ticks=ticks, steering_ticks=0.0))
        assert arbitrate(moment)[3].mode == mode
