"""The empty forms of what the loop needs: a drive with them has nobody in the seat and nobody at the controls."""

from simconsole.control.requests.control_settings import settings
from simconsole.control.requests.link import watch_link
from simconsole.profiles.control import ControlProfile
from simconsole.values.protocols import NobodyCommands, NobodySeated
from simconsole.values.signals import NEVER_TICKS, Link, LinkState, VehicleState

LINK = Link(*(0.0,) * len(Link._fields))
VEHICLE = VehicleState(*(0.0,) * len(VehicleState._fields))


def test_a_cockpit_of_nobody_stays_gone_also_after_it_is_closed() -> None:
    seat = NobodySeated()
    first = seat.poll(1)
    ages = [value for name, value in first._asdict().items() if name.endswith("_age_ticks")]
    assert len(ages) == 4
    assert min(ages) > 1000 * 86_400.0, "more ticks than any drive has"
    seat.close()
    assert seat.poll(10**6) == first


def test_commands_of_nobody_are_none_and_raise_nothing() -> None:
    command, events = NobodyCommands().take(1)
    assert (events.events, events.ecu_events, events.faults) == (0.0, 0.0, 0.0)
    link = watch_link(command, LINK, NEVER_TICKS, VEHICLE, settings(ControlProfile(), 15.0, 0.6, 2.6, 250))
    assert (link.fresh, link.invalid, link.state) == (0.0, 0.0, LinkState.NEVER)
