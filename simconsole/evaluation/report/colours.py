"""The colours of a report: few, sober, told apart also by lightness."""

from typing import Final

from simconsole.values.signals import Mode

THEORY: Final = "#c7cbd1"
PERSON: Final = "#b3541e"
REMOTE: Final = "#1f5fa8"
START: Final = "#1e8e3e"
END: Final = "#c5221f"
LIMIT: Final = "#80868b"
BAND: Final = "#dbe7f5"
NOTE: Final = "#5f6368"

MODES: Final[dict[int, str]] = {
    Mode.PARKED: "#9aa0a6",
    Mode.MANUAL: PERSON,
    Mode.SHARED: "#7b5ea7",
    Mode.AUTONOMOUS: REMOTE,
    Mode.TAKEOVER_REQUESTED: "#e8a317",
    Mode.MINIMAL_RISK: "#d9730d",
    Mode.STOPPED: "#5f6368",
    Mode.EMERGENCY_STOP: END,
}
