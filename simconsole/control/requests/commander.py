"""Which controller is the remote side: the one on the ROS side, or the ECU on the CAN bus.

Both are watched every tick by the same kernels. The rule:

1. While the remote side has a part in driving, the commander stays the same. When it fails, the car reacts to that
   fault; the other controller never takes its place unasked.
2. Otherwise the preferred controller (the session's `features.commander`) commands while it holds a lease, which every
   fresh command renews for `commander_lease_s`; else the other one, while that one holds a lease; else nobody.
3. The commander's requests count. Of an ECU that does not command only its emergency stop and its mark count; any
   other request of it is refused, and the refusal is shown. Requests on the ROS side may come from an operator and
   always count.
"""

from typing import Final, NamedTuple

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.link import watch_link
from simconsole.control.requests.person import mask
from simconsole.control.requests.remote import RemoteRequest, command_finite, remote_request
from simconsole.control.requests.tick_context import TickContext
from simconsole.values.kernels import kernel
from simconsole.values.signals import Arbitration, Commander, Event, EventInput, Link, Mode, RemoteCommand

_OF_THE_LINK: Final = int(Event.COMMANDER_LOST | Event.NO_ANSWER)
_ALWAYS: Final = int(Event.EMERGENCY_STOP | Event.MARK)
_ASKS: Final = int(
    Event.REQUEST_AUTONOMOUS | Event.REQUEST_MANUAL | Event.REQUEST_SHARED | Event.REQUEST_TAKEOVER | Event.RESET
)


class Controllers(NamedTuple):
    """Both controllers in one tick."""

    commander: float  # `Commander`
    ros_link: Link
    ecu_link: Link
    ros_offered: RemoteRequest  # what its command means
    ecu_offered: RemoteRequest
    remote: RemoteCommand  # the commander's, and what belongs to it
    link: Link
    offered: RemoteRequest
    events: int  # the edges that count, whoever raised them
    unheard: bool  # the ECU asked for something that does not count


@kernel
def assess(now: TickContext) -> Controllers:
    """Follow both controllers by the same rules, and decide which of them commands."""
    ros_link = watch_link(now.ros, now.ros_before, now.ros_age_before_ticks, now.vehicle, now.settings)
    ecu_link = watch_link(now.ecu, now.ecu_before, now.ecu_age_before_ticks, now.vehicle, now.settings)
    commander = commander_of(now.before, ros_link, ecu_link, now.settings)
    by_ecu = commander == Commander.ECU
    integral_mps2 = now.memory.speed_integral_mps2
    ros_offered = _offered(now.ros, ros_link, 0.0 if by_ecu else integral_mps2, now)
    ecu_offered = _offered(now.ecu, ecu_link, integral_mps2 if by_ecu else 0.0, now)
    return Controllers(
        commander=commander,
        ros_link=ros_link,
        ecu_link=ecu_link,
        ros_offered=ros_offered,
        ecu_offered=ecu_offered,
        remote=now.ecu if by_ecu else now.ros,
        link=ecu_link if by_ecu else ros_link,
        offered=ecu_offered if by_ecu else ros_offered,
        events=events_of(now.events, commander),
        unheard=ecu_unheard(now.events, commander),
    )


@kernel
def _offered(command: RemoteCommand, link: Link, integral_mps2: float, now: TickContext) -> RemoteRequest:
    """Return what a controller asks for.

    A command that steers implausibly hard is refused whole: what is in force is held, except that it may slow the
    vehicle down.
    """
    held_rad = now.command_before.road_wheel_rad
    if command.sequence <= 0.0 or not command_finite(command):
        return RemoteRequest(held_rad, 0.0, 0.0, 0.0, 0.0)
    asked = remote_request(command, held_rad, integral_mps2, now.vehicle, now.settings, now.tick_s)
    if link.implausible_ticks == 0.0:
        return asked
    throttle, brake = now.command_before.throttle, now.command_before.brake
    if now.before.mode == Mode.SHARED:  # its own part: the steering in force is partly the person's
        held_rad = now.before.remote_road_wheel_rad
        throttle, brake = now.before.remote_throttle, now.before.remote_brake
    direction = now.command_before.gear if now.command_before.automatic > 0.0 else asked.direction
    return RemoteRequest(
        held_rad,
        asked.throttle if asked.throttle < throttle else throttle,
        asked.brake if asked.brake > brake else brake,
        direction,
        integral_mps2,
    )


@kernel
def commander_of(before: Arbitration, ros: Link, ecu: Link, settings: ControlSettings) -> float:
    """Return the `Commander` of this tick.

    Args:
        before: Mode and commander of the tick before.
        ros: The ROS side in this tick.
        ecu: The ECU in this tick.
        settings: Whose commands are preferred.
    """
    driven = before.mode in (Mode.SHARED, Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED, Mode.MINIMAL_RISK)
    if driven and before.commander != Commander.NOBODY:
        return before.commander
    by_ros = ros.lease_ticks > 0.0
    by_ecu = ecu.lease_ticks > 0.0
    if by_ros and by_ecu:
        return settings.preferred_commander
    if by_ros:
        return Commander.ROS
    return Commander.ECU if by_ecu else Commander.NOBODY


@kernel
def events_of(events: EventInput, commander: float) -> int:
    """Return the edges that count, as a mask of `Event`: a link that does not command cannot be lost."""
    ros = mask(events.events)
    ecu = mask(events.ecu_events)
    if commander == Commander.ECU:
        return (ros & ~_OF_THE_LINK) | ecu
    return ros | (ecu & _ALWAYS)


@kernel
def ecu_unheard(events: EventInput, commander: float) -> bool:
    """Return whether the ECU asked for something that does not count because it does not command."""
    return commander != Commander.ECU and mask(events.ecu_events) & _ASKS != 0
