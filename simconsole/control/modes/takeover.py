"""Whether the person takes the wheel: by its motion since engagement, and where a motor tells it by their torque.

With a wheel that stands still by itself any motion is the person's. A motor that follows the car moves the wheel too:
then the reference is where the motor alone would have it, handed in as `explained_rad` by whoever drives the motor.
Times are whole samples: an excursion that lasts less than the hold time is never a take-over at any tick rate, and one
that lasts two ticks longer always is.
"""

from typing import Final, NamedTuple

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.values.kernels import kernel
from simconsole.values.signals import Mode

_UNREFERENCED: Final = -1.0


class WheelWatch(NamedTuple):
    """What is remembered of the hand wheel."""

    reference_rad: float  # where it was at engagement
    past_ticks: float  # samples in a row beyond the threshold; -1: the reference must be taken anew


@kernel
def watch_wheel(
    before: WheelWatch,
    hand_wheel_rad: float,
    hand_wheel_radps: float,
    explained_rad: float,
    pull_nm: float,
    watching: bool,
    trusted: bool,
    settings: ControlSettings,
) -> WheelWatch:
    """Follow the hand wheel by one tick.

    Args:
        before: The watch after the tick before.
        hand_wheel_rad: Angle now, left-positive.
        hand_wheel_radps: Its rate, less what the wheel's motor explains of it.
        explained_rad: How far the wheel's motor alone has moved it since engagement; 0 without a motor.
        pull_nm: How much of the person's torque speaks for a take-over: what may be meant (`wilful_torque`), less what
            they held at engagement already; 0 without a motor.
        watching: Whether the mode is one that a person can take over from; if not, the reference follows the wheel.
        trusted: Whether the wheel is there; after a gap the reference is taken anew, wherever it comes back.
        settings: Thresholds.
    """
    if not trusted:
        return WheelWatch(before.reference_rad, _UNREFERENCED)
    if not watching or before.past_ticks < 0.0:
        return WheelWatch(hand_wheel_rad - explained_rad, 0.0)
    threshold_rad = settings.steering_release_rad if before.past_ticks > 0.0 else settings.steering_override_rad
    moved_rad = abs(hand_wheel_rad - explained_rad - before.reference_rad)
    turned = moved_rad >= threshold_rad or abs(hand_wheel_radps) >= settings.steering_override_radps
    if turned or pull_nm >= settings.steering_override_nm:
        return WheelWatch(before.reference_rad, before.past_ticks + 1.0)
    return WheelWatch(before.reference_rad, 0.0)


@kernel
def steering_taken(watch: WheelWatch, settings: ControlSettings) -> bool:
    """Return whether the excursion has lasted the hold time: its first sample started the clock, hence the `+ 1`."""
    return watch.past_ticks >= settings.steering_override_ticks + 1.0


@kernel
def throttle_overrides(before: float, throttle: float, settings: ControlSettings) -> float:
    """Return 1 while the person's accelerator overrides the remote side's pedals, with hysteresis; else 0."""
    threshold = settings.throttle_release if before > 0.0 else settings.throttle_override
    return 1.0 if throttle >= threshold and throttle > 0.0 else 0.0


@kernel
def throttle_held(before_ticks: float, override: float, mode: float) -> float:
    """Return for how many ticks the accelerator has overridden a controller that drives; 0 while it does not."""
    return before_ticks + 1.0 if override > 0.0 and mode in (Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED) else 0.0
