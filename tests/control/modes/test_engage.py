import math

import pytest

from simconsole.control.modes.engage import engage_refusal
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person
from simconsole.values.signals import Link, LinkState, Mode, Reason, RemoteCommand, RemoteKind, VehicleState

PERSON = Person(1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
LINK = Link(10.0, 0.0, 0.0, 1000.0, 1.0, 0.0, 125.0, float(LinkState.STEADY), 0.0, 0.0)
REMOTE = RemoteCommand(*(0.0,) * len(RemoteCommand._fields))._replace(kind=float(RemoteKind.SPEED), speed_mps=10.0)
VEHICLE = VehicleState(*(0.0,) * len(VehicleState._fields))._replace(vx_mps=10.0)


def refusal(
    control: ControlSettings,
    mode: Mode = Mode.MANUAL,
    person: Person = PERSON,
    link: Link = LINK,
    remote: RemoteCommand = REMOTE,
    offered_rad: float = 0.0,
    vehicle: VehicleState = VEHICLE,
) -> Reason | None:
    reason = engage_refusal(float(mode), person, link, remote, offered_rad, 0.0, vehicle, control)
    return Reason(int(reason)) if reason else None


def test_everything_in_order_engages(control: ControlSettings) -> None:
    assert refusal(control) is None


@pytest.mark.fault("R12")
def test_a_person_must_be_there_and_off_the_brake(control: ControlSettings) -> None:
    absent = PERSON._replace(trusted=0.0)
    assert refusal(control, person=absent) is Reason.REFUSED_NOT_ARMED
    assert refusal(control._replace(person_required=0.0), person=absent) is None
    assert refusal(control, person=PERSON._replace(brake=0.05)) is Reason.REFUSED_BRAKE_PRESSED
    assert refusal(control, person=PERSON._replace(brake=0.049)) is None


def test_commands_must_be_fresh_valid_and_steady(control: ControlSettings) -> None:
    assert refusal(control, link=LINK._replace(fresh=0.0)) is Reason.REFUSED_NO_COMMAND
    assert refusal(control, link=LINK._replace(invalid=1.0)) is Reason.REFUSED_NO_COMMAND
    for ticks, well, fault in (
        (24.0, Reason.REFUSED_NOT_STABLE, Reason.REFUSED_NOT_STABLE),
        (25.0, None, Reason.REFUSED_NOT_STABLE),
    ):
        link = LINK._replace(fresh_ticks=ticks)
        for mode in (Mode.PARKED, Mode.MANUAL, Mode.SHARED, Mode.AUTONOMOUS):
            assert refusal(control, mode, link=link) is well
        for mode in (Mode.TAKEOVER_REQUESTED, Mode.STOPPED):
            assert refusal(control, mode, link=link) is fault
    assert refusal(control, Mode.STOPPED, link=LINK._replace(fresh_ticks=250.0)) is None


@pytest.mark.fault("R12")
@pytest.mark.parametrize(
    ("field", "good", "bad", "reason"),
    [
        ("vx_mps", 20.0, 25.1, Reason.REFUSED_TOO_FAST),
        ("vx_mps", 3.0, -26.0, Reason.REFUSED_TOO_FAST),
        ("vx_mps", 3.0, math.nan, Reason.REFUSED_TOO_FAST),
        ("vx_mps", 3.0, math.inf, Reason.REFUSED_TOO_FAST),
        ("ay_mps2", 1.0, 1.01, Reason.REFUSED_LATERAL_ACCELERATION),
        ("ay_mps2", -1.0, -1.01, Reason.REFUSED_LATERAL_ACCELERATION),
        ("ay_mps2", 0.0, math.nan, Reason.REFUSED_LATERAL_ACCELERATION),
        ("vx_mps", 0.0, -0.1, Reason.REFUSED_DEVIATION),
        ("vx_mps", 20.0, 20.1, Reason.REFUSED_DEVIATION),
    ],
)
def test_the_vehicles_state(field: str, good: float, bad: float, reason: Reason, control: ControlSettings) -> None:
    assert refusal(control, vehicle=VEHICLE._replace(**{field: good})) is None
    assert refusal(control, vehicle=VEHICLE._replace(**{field: bad})) is reason


def test_only_commands_of_a_speed_are_compared_in_speed(control: ControlSettings) -> None:
    fast = VEHICLE._replace(vx_mps=24.0)
    for kind in RemoteKind:
        refused = kind in (RemoteKind.SPEED, RemoteKind.TWIST)
        assert (refusal(control, remote=REMOTE._replace(kind=float(kind)), vehicle=fast) is not None) == refused


def test_limits_themselves_are_still_good(control: ControlSettings) -> None:
    remote = REMOTE._replace(speed_mps=20.0)
    assert refusal(control, remote=remote, vehicle=VEHICLE._replace(vx_mps=25.0)) is None
    assert refusal(control, remote=remote, vehicle=VEHICLE._replace(vx_mps=-25.0)) is Reason.REFUSED_DEVIATION
    slow = VEHICLE._replace(vx_mps=control.engage_deviation_speed_mps)
    assert refusal(control, offered_rad=0.36, vehicle=slow) is Reason.REFUSED_DEVIATION


def test_the_commands_angle_is_compared_with_the_one_in_force(control: ControlSettings) -> None:
    for offered, in_force, reason in ((0.3, 0.3, 0.0), (0.3, -0.3, float(Reason.REFUSED_DEVIATION))):
        assert engage_refusal(float(Mode.MANUAL), PERSON, LINK, REMOTE, offered, in_force, VEHICLE, control) == reason


def test_the_wheels_must_agree_unless_nearly_standing(control: ControlSettings) -> None:
    for angle in (0.36, -0.36):
        assert refusal(control, offered_rad=angle) is Reason.REFUSED_DEVIATION
        assert refusal(control, offered_rad=angle, vehicle=VEHICLE._replace(vx_mps=0.9)) is None
    assert refusal(control, offered_rad=0.35) is None
