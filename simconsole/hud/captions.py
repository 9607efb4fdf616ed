"""What the driver is told in words: who drives, and what to do next, with the name of the button that does it."""

from typing import Final

from simconsole.hud.language import say
from simconsole.profiles.view import LanguageProfile
from simconsole.values.layout import read
from simconsole.values.signals import Mode
from simconsole.values.state_vector import LAYOUT, Snapshot
from simconsole.values.validity import is_trusted

YOU: Final = "YOU"
AUTOPILOT: Final = "AUTOPILOT"
CONSOLE: Final = "CONSOLE"
NOBODY: Final = "NOBODY"

STEER_OR_BRAKE: Final = "steer or brake"
MENDING: Final = ("plug the wheel in", "align wheel with car", "plug the pedals in", "release the pedals")
"""What brings a lost cockpit back: no hand on a wheel that is not heard can take over."""
WAIT: Final = "wait: car is braking"
PRESS_TO_DRIVE: Final = "press {button} to drive"
PRESS_TO_RESET: Final = "press {button} to reset"
ASK: Final = "ask the operator"
LONGEST_BUTTON: Final = "paddle right, R3"
"""As wide as a button's label can be (`simconsole.profiles.device.ButtonLabel`)."""
_SILENT_S: Final = 0.5
"""A device that was not heard for this long is not there, or says nothing any more."""


def other_side(snapshot: Snapshot) -> str:
    """Return who has the part of the steering that the person does not have; empty where there is none."""
    arbitration = snapshot.arbitration
    if arbitration.mode in (Mode.PARKED, Mode.STOPPED):
        return NOBODY
    if arbitration.mode == Mode.MINIMAL_RISK:
        return AUTOPILOT if read(snapshot.vector, LAYOUT.memory).stop_steered > 0.0 else CONSOLE
    if arbitration.mode == Mode.EMERGENCY_STOP:
        return CONSOLE
    if arbitration.mode == Mode.MANUAL and arbitration.remote_lateral <= 0.0:
        return ""
    if arbitration.mode == Mode.MANUAL and arbitration.commander == 0.0:
        return CONSOLE  # its own stop fades out
    return AUTOPILOT


def next_step(
    snapshot: Snapshot, language: LanguageProfile, standstill_mps: float, manual_button: str, reset_button: str
) -> str:
    """Return what the driver does next, in at most five words; empty where they just drive.

    Args:
        snapshot: The newest tick.
        language: The driver's.
        standstill_mps: Up to this speed the car counts as standing.
        manual_button: Label of the button that asks for manual control; empty without one.
        reset_button: The same of the one that resets a latched stop.
    """
    mode = snapshot.arbitration.mode
    if mode == Mode.EMERGENCY_STOP:
        if abs(snapshot.vehicle.vx_mps) > standstill_mps:
            return say(language, WAIT)
        return _press(language, PRESS_TO_RESET, reset_button)
    if mode not in (Mode.TAKEOVER_REQUESTED, Mode.MINIMAL_RISK, Mode.STOPPED):
        return ""
    mended = _mending(snapshot)
    if mended:
        return say(language, mended)
    if mode == Mode.STOPPED:
        return _press(language, PRESS_TO_DRIVE, manual_button or reset_button)
    return say(language, STEER_OR_BRAKE)


def _press(language: LanguageProfile, phrase: str, button: str) -> str:
    return say(language, phrase, button=button) if button else say(language, ASK)


def _mending(snapshot: Snapshot) -> str:
    """Return what brings wheel and pedals back, empty where both are trusted."""
    driver, sample, silent_ticks = snapshot.driver, snapshot.sample, _SILENT_S * snapshot.tick_hz
    unplugged_wheel, misaligned, unplugged_pedals, pressed = MENDING
    if not is_trusted(driver.wheel_validity):
        return unplugged_wheel if sample.wheel_age_ticks > silent_ticks else misaligned
    if not (is_trusted(driver.throttle_validity) and is_trusted(driver.brake_validity)):
        return unplugged_pedals if sample.pedals_age_ticks > silent_ticks else pressed
    return ""
