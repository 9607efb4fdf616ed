"""Back to the start, and when not: the hand wheel is centred and the pedals are released first.

A granted restart begins the drive anew from its first row: the vehicle at its start, everything engaged forgotten,
only the devices stay armed. The tick goes on counting, and what was driven before stays in the record.
"""

from typing import Final

from simconsole.control.person import Person, mask
from simconsole.control.settings import ControlSettings
from simconsole.kernels import kernel
from simconsole.signals import Button, DriverInput, Event, Mode, Reason

NOT_ASKED: Final = -1.0
GRANTED: Final = 0.0

_EVENT: Final = int(Event.RESTART)
_EVENT_EMERGENCY: Final = int(Event.EMERGENCY_STOP)
_BUTTON: Final = int(Button.RESTART)
_BUTTON_EMERGENCY: Final = int(Button.EMERGENCY_STOP)
_EMERGENCY_STOP: Final = float(Mode.EMERGENCY_STOP)
_REFUSED_EMERGENCY: Final = float(Reason.REFUSED_EMERGENCY)
_REFUSED_WHEEL: Final = float(Reason.REFUSED_WHEEL_NOT_CENTRED)
_REFUSED_PEDAL: Final = float(Reason.REFUSED_PEDAL_PRESSED)


@kernel
def restart_refusal(mode: float, driver: DriverInput, person: Person, events: int, settings: ControlSettings) -> float:
    """Return NOT_ASKED, GRANTED, or the `Reason` that refuses a restart. A cockpit that is not there holds up nothing.

    Args:
        mode: Of the tick before: a latched emergency stop is reset first.
        driver: The person's buttons and clutch in this tick.
        person: The rest of the person.
        events: Mask of `Event`.
        settings: How far off the centre a centred wheel may be.
    """
    if events & _EVENT == 0 and mask(driver.edges) & _BUTTON == 0:
        return NOT_ASKED
    if mode == _EMERGENCY_STOP or events & _EVENT_EMERGENCY != 0 or mask(driver.pressed) & _BUTTON_EMERGENCY != 0:
        return _REFUSED_EMERGENCY
    if person.trusted == 0.0:
        return GRANTED
    if person.throttle >= settings.throttle_override or person.brake >= settings.brake_override:
        return _REFUSED_PEDAL
    if not driver.clutch < settings.throttle_override:
        return _REFUSED_PEDAL
    return GRANTED if abs(driver.hand_wheel_rad) <= settings.restart_wheel_rad else _REFUSED_WHEEL
