"""The person's side of arbitration: what the cockpit asks for, and whether it may be trusted."""

from typing import Final, NamedTuple

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.values.kernels import clip, is_finite, kernel
from simconsole.values.signals import DriverInput
from simconsole.values.validity import is_trusted

_MOST_MASK: Final = 2147483647.0


class Person(NamedTuple):
    """What the person asks for. `trusted` 1: wheel, accelerator and brake are there and seen at rest."""

    trusted: float
    wheel_trusted: float
    road_wheel_rad: float
    throttle: float  # 0 while the brake is pressed, which beats it
    brake: float
    accelerator: float  # as the foot holds it: only this says whether it is released


@kernel
def mask(value: float) -> int:
    """Return a bit mask that was stored as a float; 0 for values that are no mask (not finite, or below 1)."""
    return int(value) if 1.0 <= value <= _MOST_MASK else 0


@kernel
def person_of(driver: DriverInput, held_road_wheel_rad: float, settings: ControlSettings) -> Person:
    """Return the person's request: brake over throttle, and nothing from inputs that are not finite."""
    wheel_trusted = is_trusted(driver.wheel_validity) and is_finite(driver.hand_wheel_rad)
    pedals_trusted = is_trusted(driver.throttle_validity) and is_trusted(driver.brake_validity)
    finite = is_finite(driver.throttle) and is_finite(driver.brake)
    road_wheel_rad = held_road_wheel_rad
    if wheel_trusted:
        lock = settings.max_road_wheel_rad
        road_wheel_rad = clip(driver.hand_wheel_rad * settings.road_wheel_per_hand_wheel, -lock, lock)
    brake = driver.brake if is_finite(driver.brake) else 0.0
    accelerator = driver.throttle if is_finite(driver.throttle) else 0.0
    throttle = 0.0 if brake >= settings.brake_override else accelerator
    trusted = wheel_trusted and pedals_trusted and finite
    return Person(
        trusted=1.0 if trusted else 0.0,
        wheel_trusted=1.0 if wheel_trusted else 0.0,
        road_wheel_rad=road_wheel_rad,
        throttle=throttle,
        brake=brake,
        accelerator=accelerator,
    )
