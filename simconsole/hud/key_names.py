"""The keys of the driver's window: the names of pygame's constants, and what each key means."""

from typing import Final

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


def key_label(key: Key) -> str:
    """Return the label of the first key that means `key`, as a driver finds it on the keyboard; empty without one."""
    return next((name.removeprefix("K_").capitalize() for name, meaning in KEY_CODES.items() if meaning is key), "")
