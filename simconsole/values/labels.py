"""The labels that people read: one place for the driver's view, the operators' view, the report and the command line.

Labels are short enough for a glance (at most seven words per alert) and never depend on colour.
"""

from collections.abc import Sequence
from typing import Final

from simconsole.values.signals import Commander, LinkState, Mode, Notice, Reason, Validity

_MODES: Final[dict[float, str]] = {
    Mode.PARKED: "PARKED",
    Mode.MANUAL: "MANUAL",
    Mode.SHARED: "SHARED",
    Mode.AUTONOMOUS: "AUTONOMOUS",
    Mode.TAKEOVER_REQUESTED: "TAKE OVER",
    Mode.MINIMAL_RISK: "SAFE STOP",
    Mode.STOPPED: "STOPPED",
    Mode.EMERGENCY_STOP: "EMERGENCY STOP",
}

_REASONS: Final[dict[float, str]] = {
    Reason.START: "drive started",
    Reason.PERSON_ASKED: "driver asked",
    Reason.OPERATOR_ASKED: "operator asked",
    Reason.REMOTE_ASKED: "autopilot asked",
    Reason.STEERING_OVERRIDE: "driver turned the wheel",
    Reason.BRAKE_OVERRIDE: "driver braked",
    Reason.THROTTLE_OVERRIDE: "driver pressed the throttle",
    Reason.COMMAND_STALE: "autopilot went silent",
    Reason.COMMAND_INVALID: "autopilot sent invalid commands",
    Reason.DEVICE_LOST: "wheel or pedals lost",
    Reason.NO_REACTION: "no reaction from the driver",
    Reason.STANDSTILL: "standing still",
    Reason.EMERGENCY: "emergency stop pressed",
    Reason.OPERATOR_EMERGENCY: "operator pressed emergency stop",
    Reason.RESET: "reset",
    Reason.OPERATOR_RESET: "operator reset the stop",
    Reason.ARMED: "controls ready",
    Reason.LOOP_STALL: "console was held up",
    Reason.COMMANDER_LOST: "autopilot left",
    Reason.REFUSED_NO_COMMAND: "refused: no autopilot",
    Reason.REFUSED_BRAKE_PRESSED: "refused: brake is pressed",
    Reason.REFUSED_TOO_FAST: "refused: too fast",
    Reason.REFUSED_LATERAL_ACCELERATION: "refused: cornering too hard",
    Reason.REFUSED_NOT_ARMED: "refused: controls not ready",
    Reason.REFUSED_EMERGENCY: "refused: emergency stop is latched",
    Reason.REFUSED_DEVIATION: "refused: autopilot commands differ too much",
    Reason.REFUSED_MODE: "refused: not from this mode",
    Reason.REFUSED_THROTTLE_PRESSED: "refused: throttle is pressed",
    Reason.REFUSED_MOVING: "refused: car is moving",
    Reason.REFUSED_NOT_STABLE: "refused: autopilot not steady yet",
    Reason.REFUSED_NOT_COMMANDER: "refused: the ECU does not command",
    Reason.REFUSED_WHEEL_NOT_CENTRED: "refused: wheel is not centred",
    Reason.REFUSED_PEDAL_PRESSED: "refused: a pedal is pressed",
    Reason.REFUSED_IMPLAUSIBLE: "refused: too much lateral acceleration",
    Reason.REFUSED_OVERRULED: "refused: something stronger came first",
    Reason.REFUSED_WHEEL_UNKNOWN: "refused: wheel's motor is not identified",
}

_NOTICES: Final[dict[float, str]] = {
    Notice.NONE: "",
    Notice.THROTTLE_HELD: "throttle is held: autopilot only steers",
    Notice.CENTRING_WHEEL: "hands off: the wheel is being centred",
    Notice.CENTRE_WHEEL: "centre the wheel to start again",
    Notice.RELEASE_PEDALS: "release the pedals to start again",
    Notice.RECORDING_FAILED: "recording failed: the drive is not kept",
    Notice.NOT_ENGAGED: "parked: nobody has asked for autonomy",
    Notice.RED_LIGHT: "passed a red light",
    Notice.WRONG_WAY: "wrong way: traffic comes towards you",
    Notice.OFF_ROAD: "off the road",
    Notice.SPEEDING: "faster than the speed limit",
    Notice.FAILING_TO_YIELD: "failed to yield",
    Notice.COLLISION: "collision",
    Notice.TRAFFIC_LOST: "traffic has failed: the road is empty",
}

EASED_BELOW: Final = 0.995
"""A wheel that bears less of the car's torque than this, 100 % to the nearest percent, is said to be eased."""

LINK_NOBODY: Final = "nobody"
LINK_LOST: Final = "lost"
LINK_CONNECTING: Final = "connecting"
LINK_RETRYING: Final = "retrying"
LINK_DOWN: Final = "down"
LINK_COMMANDER: Final = "commander"
"""State of the rosbridge link, beside `2 clients`: no client yet, all clients have left, the upstream server not
reached yet, the upstream server lost and tried again, the bridge itself not running, a client commands."""

_COMMANDERS: Final[dict[float, str]] = {Commander.NOBODY: "none", Commander.ROS: "ROS", Commander.ECU: "CAN"}

_LINKS: Final[dict[float, str]] = {
    LinkState.NEVER: "no command yet",
    LinkState.UNSTEADY: "not steady yet",
    LinkState.STEADY: "steady",
    LinkState.STALE: "silent",
    LinkState.INVALID: "invalid",
}

_VALIDITIES: Final[dict[float, str]] = {
    Validity.UNKNOWN: "not seen yet",
    Validity.ARMED: "ready",
    Validity.LIVE: "live",
    Validity.STALE: "stale",
    Validity.LOST: "lost",
}


def mode_label(mode: float) -> str:
    """Return the name of a mode as shown to people, in capitals; an unknown number names itself."""
    return _MODES.get(mode) or f"MODE {mode:g}"


def reason_label(reason: float) -> str:
    """Return why the mode changed, or why a request was refused ("refused: ..."), in at most seven words."""
    return _REASONS.get(reason) or f"reason {reason:g}"


def notice_label(notice: float) -> str:
    """Return the text of a notice, in at most seven words; empty for NONE."""
    return _NOTICES.get(notice, f"notice {notice:g}")


def arbitration_label(mode: float, reason: float, refusal: float, notice: float, broken: str = "") -> str:
    """Return mode and reason, what was refused and what is noticed in one line.

    `broken` is the limit that a refused command has broken, in words.
    """
    parts = [f"{mode_label(mode)}: {reason_label(reason)}"]
    if refusal:
        parts.append(reason_label(refusal) + (f" ({broken})" if broken else ""))
    if notice:
        parts.append(notice_label(notice))
    return "; ".join(parts)


def is_eased(enabled: float, car_share: float) -> bool:
    """Return whether the wheel gives less of the car's torque than the car has; a servo (share 0) gives none."""
    return enabled > 0.0 and 0.0 < car_share < EASED_BELOW


def eased_label(car_share: float) -> str:
    """Return what is told when a wheel bears a share of the car's torque only."""
    return f"force feedback eased to {100.0 * car_share:.0f} %"


def borne_label(shares: Sequence[tuple[float, float]]) -> str:
    """Return how much of a car's torque a wheel bears: speeds in km/h, and the share at each of them."""
    eased = [f"{100.0 * share:.0f} % at {kmh:g} km/h" for kmh, share in shares if share < EASED_BELOW]
    return ", ".join(eased) or f"all up to {shares[-1][0]:g} km/h"


def commander_label(commander: float) -> str:
    """Return whose commands are the remote side's: ROS, CAN or none."""
    return _COMMANDERS.get(commander) or f"commander {commander:g}"


def link_label(state: float) -> str:
    """Return how far a controller's commands may be relied on."""
    return _LINKS.get(state) or f"link {state:g}"


def validity_label(validity: float) -> str:
    """Return how far a device is trusted."""
    return _VALIDITIES.get(validity) or f"validity {validity:g}"


def gear_label(gear: float) -> str:
    """Return the lever as printed on its knob: R, N, 1 to 7."""
    if gear < 0.0:
        return "R"
    return f"{gear:.0f}" if gear > 0.0 else "N"


def indicator_label(turn_indicators: float) -> str:
    """Return what the turn indicators show: left, right or off."""
    if turn_indicators < 0.0:
        return "right"
    return "left" if turn_indicators > 0.0 else "off"
