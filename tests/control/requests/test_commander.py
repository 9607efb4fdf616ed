"""Two controllers, one remote side: who commands, what counts of the other one, and what a fault does."""

from collections.abc import Callable

import pytest

from simconsole.values.signals import Commander, Event, LinkState, Mode, Reason, RemoteKind
from tests.control.conftest import Rig


def commander(rig: Rig) -> Commander:
    return Commander(int(rig.arbitration.commander))


def both(rig: Rig) -> Rig:
    """A person at the wheel, the car at speed, ROS steering left and the ECU right."""
    rig.run(1.0)
    rig.vehicle = rig.vehicle._replace(vx_mps=10.0)
    rig.send(road_wheel_rad=0.02, accel_mps2=0.5)
    rig.send_ecu(road_wheel_rad=-0.02, accel_mps2=-0.5)
    rig.run(0.3)
    return rig


@pytest.mark.parametrize("preferred", [Commander.ROS, Commander.ECU])
def test_the_preferred_one_commands_where_both_send(make_rig: Callable[..., Rig], preferred: Commander) -> None:
    rig = both(make_rig(preferred=preferred))
    assert commander(rig) is preferred
    decided = rig.arbitration
    assert (decided.ros_road_wheel_rad, decided.ecu_road_wheel_rad) == (0.02, -0.02)
    assert decided.ros_throttle > 0.0
    assert decided.ecu_brake > 0.0
    assert (rig.ros_link.state, rig.ecu_link.state) == (LinkState.STEADY, LinkState.STEADY)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    rig.run(1.0)
    assert rig.mode is Mode.AUTONOMOUS
    assert rig.command.road_wheel_rad == (0.02 if preferred is Commander.ROS else -0.02)


def test_nobody_commands_where_nobody_sends(rig: Rig) -> None:
    rig.run(1.0)
    assert commander(rig) is Commander.NOBODY
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.refusal) == (Mode.MANUAL, Reason.REFUSED_NO_COMMAND)


def test_the_other_one_commands_where_only_it_sends(rig: Rig) -> None:
    rig.run(1.0)
    rig.vehicle = rig.vehicle._replace(vx_mps=10.0)
    rig.send_ecu(accel_mps2=0.5)
    rig.run(0.3)
    assert commander(rig) is Commander.ECU
    rig.tick(ecu_event=Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.reason) == (Mode.AUTONOMOUS, Reason.OPERATOR_ASKED)


def test_a_lease_lasts_half_a_second_after_the_last_fresh_command(rig: Rig) -> None:
    both(rig)
    rig.sending = False
    rig.run(0.2 + 0.4)
    assert commander(rig) is Commander.ROS
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert (rig.mode, rig.refusal) == (Mode.MANUAL, Reason.REFUSED_NO_COMMAND)
    rig.run(0.12)
    assert commander(rig) is Commander.ECU
    rig.send()
    rig.tick()
    assert commander(rig) is Commander.ROS, "preferred, and nobody drives by the other one"


@pytest.mark.parametrize("mode", [Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.SHARED])
def test_the_other_one_never_takes_the_place_of_a_silent_commander(rig: Rig, mode: Mode) -> None:
    both(rig)
    rig.tick(Event.REQUEST_SHARED if mode is Mode.SHARED else Event.REQUEST_AUTONOMOUS)
    if mode is Mode.TAKEOVER_REQUESTED:
        rig.tick(Event.REQUEST_TAKEOVER)
    assert rig.mode is mode
    rig.sending = False
    ticks = rig.until(Mode.MANUAL if mode is Mode.SHARED else Mode.MINIMAL_RISK)
    assert rig.reason is Reason.COMMAND_STALE
    assert ticks <= 0.21 * rig.tick_hz
    assert commander(rig) is Commander.ROS
    if mode is not Mode.SHARED:
        rig.until(Mode.STOPPED)
        rig.run(1.0)
        assert commander(rig) is Commander.ECU, "once the car stands, autonomy may be asked for with the other one"
        rig.run(1.0)
        rig.tick(Event.REQUEST_AUTONOMOUS)
        assert rig.mode is Mode.AUTONOMOUS


def test_the_preferred_one_does_not_push_out_a_commander_that_drives(make_rig: Callable[..., Rig]) -> None:
    rig = make_rig()
    rig.run(1.0)
    rig.vehicle = rig.vehicle._replace(vx_mps=10.0)
    rig.send_ecu(road_wheel_rad=-0.02)
    rig.run(0.3)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    rig.send(road_wheel_rad=0.02)
    rig.run(1.0)
    assert (rig.mode, commander(rig), rig.command.road_wheel_rad) == (Mode.AUTONOMOUS, Commander.ECU, -0.02)


@pytest.mark.parametrize(
    "asked",
    [Event.REQUEST_AUTONOMOUS, Event.REQUEST_MANUAL, Event.REQUEST_SHARED, Event.REQUEST_TAKEOVER, Event.RESET],
)
def test_what_an_ecu_asks_for_that_does_not_command_is_refused_in_words(rig: Rig, asked: Event) -> None:
    both(rig)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    rig.tick(ecu_event=asked)
    assert (rig.mode, rig.refusal) == (Mode.AUTONOMOUS, Reason.REFUSED_NOT_COMMANDER)


def test_its_emergency_stop_and_its_mark_always_count(rig: Rig) -> None:
    both(rig)
    rig.tick(ecu_event=Event.MARK)
    assert rig.refusal is None
    rig.tick(ecu_event=Event.EMERGENCY_STOP)
    assert (rig.mode, rig.reason) == (Mode.EMERGENCY_STOP, Reason.EMERGENCY)


@pytest.mark.parametrize("preferred", [Commander.ROS, Commander.ECU])
def test_only_the_commanders_link_can_be_lost(make_rig: Callable[..., Rig], preferred: Commander) -> None:
    rig = both(make_rig(preferred=preferred))
    rig.tick(Event.REQUEST_AUTONOMOUS)
    events = {Commander.ROS: "event", Commander.ECU: "ecu_event"}
    other = Commander.ECU if preferred is Commander.ROS else Commander.ROS
    rig.tick(**{events[other]: Event.COMMANDER_LOST | Event.NO_ANSWER})
    assert rig.mode is Mode.AUTONOMOUS
    rig.tick(**{events[preferred]: Event.COMMANDER_LOST})
    assert (rig.mode, rig.reason) == (Mode.MINIMAL_RISK, Reason.COMMANDER_LOST)


def test_a_pose_of_the_commander_reaches_the_gate(make_rig: Callable[..., Rig]) -> None:
    rig = make_rig(preferred=Commander.ECU)
    rig.run(1.0)
    rig.send(RemoteKind.POSE, x_m=1.0)
    rig.send_ecu(RemoteKind.POSE, x_m=2.0)
    rig.run(0.3)
    rig.tick(Event.REQUEST_AUTONOMOUS)
    assert rig.command.target_x_m == 2.0
