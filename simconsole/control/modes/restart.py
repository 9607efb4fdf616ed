"""Restart of the drive, and when it is refused: the hand wheel is centred first, then the pedals are released.

In a car that stands a restart waits for both: the wheel's motor centres the wheel (force_feedback/torque.py), or the
person is asked to. In a car that moves it never waits: the motor must not turn a wheel by which somebody steers.

A granted restart sets the drive back to its initial state: the vehicle at its start, nothing engaged; only the devices
stay armed. The tick goes on counting, and what was driven before stays in the recording.
"""

from typing import Final, NamedTuple

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person, mask
from simconsole.control.requests.stops import stands
from simconsole.control.requests.tick_context import TickContext
from simconsole.values.kernels import kernel
from simconsole.values.signals import Button, DriverInput, Event, Mode, Notice, Reason

NOT_ASKED: Final = -1.0
GRANTED: Final = 0.0


class Restart(NamedTuple):
    """State of a request to restart."""

    ticks: float  # for how long it has waited; 0: none waits
    granted: float
    refusal: float  # `Reason`; 0: not refused in this tick
    notice: float  # `Notice`: what it waits for


@kernel
def restart_of(now: TickContext, person: Person) -> Restart:
    """Grant a restart, refuse it, or let it wait, at most for the profile's time."""
    waited = now.memory.restart_ticks
    events = mask(now.events.events)
    if waited > 0.0:
        events |= Event.RESTART
    hindrance = restart_refusal(now.before.mode, now.driver, person, events, now.settings)
    if hindrance == NOT_ASKED:
        return Restart(0.0, 0.0, 0.0, 0.0)
    if hindrance == GRANTED:
        return Restart(0.0, 1.0, 0.0, 0.0)
    centred = abs(now.driver.hand_wheel_rad) <= now.settings.restart_wheel_rad
    stays = stands(now.vehicle, now.settings) or (centred and waited > 0.0)
    if hindrance == Reason.REFUSED_EMERGENCY or not stays or waited >= now.settings.restart_wait_ticks:
        return Restart(0.0, 0.0, hindrance, 0.0)
    notice = Notice.RELEASE_PEDALS
    if not centred:
        notice = Notice.CENTRING_WHEEL if now.wheel_motor == 1.0 else Notice.CENTRE_WHEEL
    return Restart(waited + 1.0, 0.0, 0.0, notice)


@kernel
def restart_refusal(mode: float, driver: DriverInput, person: Person, events: int, settings: ControlSettings) -> float:
    """Return NOT_ASKED, GRANTED, or the `Reason` against a restart now. A missing cockpit delays nothing.

    Args:
        mode: Of the tick before: a latched emergency stop is reset first.
        driver: The person's buttons and clutch in this tick.
        person: The rest of the person.
        events: Mask of `Event`.
        settings: How far off the centre a centred wheel may be.
    """
    if events & Event.RESTART == 0 and mask(driver.edges) & Button.RESTART == 0:
        return NOT_ASKED
    stop = events & Event.EMERGENCY_STOP != 0 or mask(driver.pressed) & Button.EMERGENCY_STOP != 0
    if mode == Mode.EMERGENCY_STOP or stop:
        return Reason.REFUSED_EMERGENCY
    if person.trusted == 0.0:
        return GRANTED
    if person.throttle >= settings.throttle_override or person.brake >= settings.brake_override:
        return Reason.REFUSED_PEDAL_PRESSED
    if not driver.clutch < settings.throttle_override:
        return Reason.REFUSED_PEDAL_PRESSED
    return GRANTED if abs(driver.hand_wheel_rad) <= settings.restart_wheel_rad else Reason.REFUSED_WHEEL_NOT_CENTRED
