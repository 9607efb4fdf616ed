"""The keyboard as a cockpit: held keys become axes that move at a person's speed of hand and foot. Pure.

The keys come from the window's process with an age; when it falls silent this source goes stale like any other.
"""

from collections.abc import Callable
from typing import Final

from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.synthetic.steering_assistance import Assistance, turned
from simconsole.values.key_codes import Key
from simconsole.values.signals import Button, DeviceSample
from simconsole.values.state_vector import Snapshot

Keys = Callable[[], tuple[int, int]]
"""Returns (mask of `Key` held now, its age in whole ticks)."""

# (rising, falling) share per s of each pedal: half a second for a full throttle, a second for the clutch to come up
THROTTLE_PER_S: Final = (2.0, 5.0)
BRAKE_PER_S: Final = (2.5, 6.0)
CLUTCH_PER_S: Final = (6.0, 1.0)
HANDBRAKE_PER_S: Final = (4.0, 6.0)

_BUTTONS: Final = (
    (Key.AUTONOMOUS, Button.AUTONOMOUS),
    (Key.MANUAL, Button.MANUAL),
    (Key.EMERGENCY_STOP, Button.EMERGENCY_STOP),
    (Key.RESET, Button.RESET),
    (Key.GEAR_UP, Button.SHIFT_UP),
    (Key.GEAR_DOWN, Button.SHIFT_DOWN),
    (Key.INDICATOR_LEFT, Button.INDICATOR_LEFT),
    (Key.INDICATOR_RIGHT, Button.INDICATOR_RIGHT),
    (Key.MARK, Button.MARK),
    (Key.HAZARD, Button.HAZARD),
    (Key.PAUSE, Button.PAUSE),
    (Key.RESTART, Button.RESTART),
    (Key.TAKEOVER, Button.TAKEOVER),
    (Key.SHARED, Button.SHARED),
    (Key.FAULT, Button.FAULT),
    (Key.HORN, Button.HORN),
)


FRESH_S: Final = 0.2
"""Longest age of keys that count: the window reports them once per frame, and the hands move between frames, too.

A slow frame, of a computer without a graphics card or under load, takes 0.1 s and more."""


class KeyboardSource:
    """Turns held keys into raw samples. A gear key also works the clutch for as long as it is held."""

    def __init__(self, keys: Keys, settings: CockpitSettings, assistance: Assistance, *, tick_hz: int) -> None:
        """Take a source of keys; `settings` and `assistance` are those of a sequential cockpit (profile `keyboard`)."""
        self._keys = keys
        self._settings = settings
        self._assistance = assistance
        self._speed_mps = 0.0
        self._tick_s = 1.0 / tick_hz
        self._fresh_ticks = round(FRESH_S * tick_hz)
        self._intent = Intent()

    def publish(self, snapshot: Snapshot) -> None:
        """Note the car's speed: keys steer a fast car less."""
        self._speed_mps = snapshot.vehicle.vx_mps

    def poll(self, tick: int) -> DeviceSample:
        """Return the cockpit one tick on. While the window is silent nothing moves; the growing age says so."""
        mask, age_ticks = self._keys()
        if age_ticks <= self._fresh_ticks:
            self._intent = self._moved(Key(mask))
        age = float(age_ticks)
        return raw_sample(self._intent, self._settings)._replace(
            wheel_age_ticks=age, pedals_age_ticks=age, shifter_age_ticks=age, handbrake_age_ticks=age
        )

    def close(self) -> None:
        """Nothing to release: the window owns the keyboard."""

    def _moved(self, held: Key) -> Intent:
        now, step = self._intent, self._tick_s
        clutch = held & (Key.CLUTCH | Key.GEAR_UP | Key.GEAR_DOWN)
        pressed = 0
        for key, button in _BUTTONS:
            if held & key:
                pressed |= int(button)
        return Intent(
            hand_wheel_rad=turned(now.hand_wheel_rad, _side(held), self._speed_mps, self._assistance, step),
            throttle=_pedal(now.throttle, held & Key.THROTTLE, THROTTLE_PER_S, step),
            brake=_pedal(now.brake, held & Key.BRAKE, BRAKE_PER_S, step),
            clutch=_pedal(now.clutch, clutch, CLUTCH_PER_S, step),
            handbrake=_pedal(now.handbrake, held & Key.HANDBRAKE, HANDBRAKE_PER_S, step),
            pressed=pressed,
        )


def _pedal(pressed: float, key: Key, per_s: tuple[float, float], step_s: float) -> float:
    rising, falling = per_s
    return min(1.0, pressed + rising * step_s) if key else max(0.0, pressed - falling * step_s)


def _side(held: Key) -> float:
    return float(bool(held & Key.STEER_LEFT) - bool(held & Key.STEER_RIGHT))
