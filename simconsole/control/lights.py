"""Turn indicators and hazard lights: the person's stalk, the controller's command, and when the console sets them.

The person's stalk and hazard switch keep their position through every mode, as in a car. While the controller drives,
its indicator goes before the stalk where it sets one, and either side may put the hazard lights on. A stop that the
console makes itself always shows them: a minimal-risk manoeuvre (UN R157, 5.5), what follows it, and an
emergency stop.
"""

from typing import NamedTuple

from simconsole.control.requests.person import mask
from simconsole.values.kernels import kernel
from simconsole.values.signals import ArbiterMemory, Button, DriverInput, Link, Mode, RemoteCommand


class Lights(NamedTuple):
    """What one side wants to show: `turn_indicators` 1 left, -1 right, 0 off; `hazard_lights` 1 on, 0 off."""

    turn_indicators: float
    hazard_lights: float


@kernel
def switched(driver: DriverInput, memory: ArbiterMemory) -> Lights:
    """Return the person's stalk and hazard switch after this tick; a second press switches off what the first did."""
    pressed = mask(driver.edges)
    stalk = memory.stalk
    if pressed & Button.INDICATOR_LEFT != 0:
        stalk = 0.0 if stalk > 0.0 else 1.0
    elif pressed & Button.INDICATOR_RIGHT != 0:
        stalk = 0.0 if stalk < 0.0 else -1.0
    hazard = memory.hazard_switch
    if pressed & Button.HAZARD != 0:
        hazard = 1.0 - hazard
    return Lights(stalk, hazard)


@kernel
def lights_of(mode: float, person: Lights, remote: RemoteCommand, link: Link) -> Lights:
    """Return what the car shall show.

    Args:
        mode: Of this tick.
        person: Stalk and hazard switch.
        remote: The commander's command.
        link: Whether that command counts.
    """
    turn_indicators = person.turn_indicators
    hazard_lights = person.hazard_lights
    if mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED) and link.fresh > 0.0:
        if remote.turn_indicators != 0.0:
            turn_indicators = remote.turn_indicators
        if remote.hazard_lights > 0.0:
            hazard_lights = 1.0
    if mode in (Mode.MINIMAL_RISK, Mode.STOPPED, Mode.EMERGENCY_STOP):
        hazard_lights = 1.0
    return Lights(turn_indicators, hazard_lights)
