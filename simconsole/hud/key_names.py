"""The keys of the driver's window: the names of pygame's constants, what each key means, and the words for it."""

from enum import StrEnum
from typing import Final

from simconsole.hud.language import say
from simconsole.profiles.device import Buttons, CockpitProfile
from simconsole.profiles.view import ENGLISH, LanguageProfile
from simconsole.values.key_codes import Key

KEY_CODES: Final[dict[str, Key]] = {
    "K_LEFT": Key.STEER_LEFT,
    "K_a": Key.STEER_LEFT,
    "K_RIGHT": Key.STEER_RIGHT,
    "K_d": Key.STEER_RIGHT,
    "K_UP": Key.THROTTLE,
    "K_w": Key.THROTTLE,
    "K_DOWN": Key.BRAKE,
    "K_s": Key.BRAKE,
    "K_LSHIFT": Key.CLUTCH,
    "K_SPACE": Key.HANDBRAKE,
    "K_e": Key.GEAR_UP,
    "K_q": Key.GEAR_DOWN,
    "K_RETURN": Key.AUTONOMOUS,
    "K_BACKSPACE": Key.MANUAL,
    "K_ESCAPE": Key.EMERGENCY_STOP,
    "K_r": Key.RESET,
    "K_COMMA": Key.INDICATOR_LEFT,
    "K_PERIOD": Key.INDICATOR_RIGHT,
    "K_m": Key.MARK,
    "K_h": Key.HAZARD,
    "K_p": Key.PAUSE,
    "K_HOME": Key.RESTART,
    "K_t": Key.TAKEOVER,
    "K_y": Key.SHARED,
    "K_f": Key.FAULT,
    "K_END": Key.END,
    "K_b": Key.HORN,
}
"""Names of pygame's key constants: the library itself is loaded when a window opens."""


class WindowKey(StrEnum):
    """Keys of the window itself, by the names of pygame's constants; the drive never hears of them."""

    HELP = "K_F1"
    FRAME_TIMES = "K_F3"
    NEXT_DISPLAY = "K_F9"
    VSYNC = "K_F10"
    FULL_SCREEN = "K_F11"


WINDOW_WORDS: Final = {
    WindowKey.HELP: "this help",
    WindowKey.FRAME_TIMES: "frame times",
    WindowKey.NEXT_DISPLAY: "next display",
    WindowKey.VSYNC: "vsync on, off",
    WindowKey.FULL_SCREEN: "full screen",
}
KEY_WORDS: Final = {
    Key.STEER_LEFT: "steer left",
    Key.STEER_RIGHT: "steer right",
    Key.THROTTLE: "throttle",
    Key.BRAKE: "brake",
    Key.CLUTCH: "clutch",
    Key.HANDBRAKE: "handbrake",
    Key.END: "end the drive",
}
BUTTON_WORDS: Final = {
    "shift_up": "gear up",
    "shift_down": "gear down",
    "autonomous": "let the autopilot drive",
    "manual": "drive yourself",
    "shared": "share the steering",
    "takeover": "ask for a take-over",
    "emergency_stop": "emergency stop",
    "reset": "reset after a stop",
    "indicator_left": "indicate left",
    "indicator_right": "indicate right",
    "hazard": "hazard lights",
    "horn": "horn",
    "mark": "mark this moment",
    "pause": "pause, go on",
    "restart": "start again",
    "fault": "switch the faults on",
    "handbrake_button": "handbrake",
}
_BUTTON_KEYS: Final = {"shift_up": Key.GEAR_UP, "shift_down": Key.GEAR_DOWN}


def key_label(key: Key) -> str:
    """Return the label of the first key that means `key`, as a driver finds it on the keyboard; empty without one."""
    return next((key_name(code) for code, meaning in KEY_CODES.items() if meaning is key), "")


def key_name(code: str) -> str:
    """Return what stands on a key, by the name of pygame's constant."""
    return code.removeprefix("K_").capitalize()


def help_rows(
    cockpit: CockpitProfile, *, by_keyboard: bool, language: LanguageProfile = ENGLISH
) -> tuple[tuple[str, str], ...]:
    """Return what each key or button does: pairs of its label and the words for it.

    Args:
        cockpit: What its buttons are called.
        by_keyboard: Whether the window's keys drive; else only those of the window itself are told.
        language: The driver's.
    """
    rows: list[tuple[str, str]] = []
    if by_keyboard:
        rows += [(_labels(key, language), words) for key, words in KEY_WORDS.items() if key is not Key.END]
    for action in Buttons.__struct_fields__:
        if by_keyboard:
            key = _BUTTON_KEYS.get(action) or Key.__members__.get(action.upper())
            label = "" if key is None else _labels(key, language)
        else:
            label = cockpit.button_label(action)
        if label:
            rows.append((label, BUTTON_WORDS[action]))
    rows.append((_labels(Key.END, language), KEY_WORDS[Key.END]))
    rows += [(key.removeprefix("K_"), words) for key, words in WINDOW_WORDS.items()]
    return tuple((label, say(language, words)) for label, words in rows)


def _labels(key: Key, language: LanguageProfile) -> str:
    """Return the labels of all keys of one meaning."""
    return ", ".join(say(language, key_name(code)) for code, meaning in KEY_CODES.items() if meaning is key)
