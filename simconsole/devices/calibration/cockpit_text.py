"""The cockpit as text that is redrawn in place: what `devices check` shows while somebody tries it. Pure."""

from typing import Final

from simconsole.values.signals import Button, DriverInput, Validity
from simconsole.values.units import DEG_PER_RAD

WIDTH: Final = 30
_WORDS: Final = {float(state): state.name.lower() for state in Validity}


def bar(share: float, width: int = WIDTH) -> str:
    """Return a bar that is filled from the left, 0 to 1."""
    full = round(min(1.0, max(0.0, share)) * width)
    return f"[{'#' * full}{'.' * (width - full)}]"


def needle(share: float, width: int = WIDTH) -> str:
    """Return a scale with a mark on it, 1 (left) to -1 (right)."""
    at = round((0.5 - 0.5 * min(1.0, max(-1.0, share))) * (width - 1))
    cells = ["."] * width
    cells[(width - 1) // 2] = "|"
    cells[at] = "#"
    return f"[{''.join(cells)}]"


def cockpit_lines(driver: DriverInput, lock_rad: float) -> list[str]:
    """Return the cockpit, always as many lines.

    Args:
        driver: The person, calibrated.
        lock_rad: Half of lock to lock.
    """
    angle = driver.hand_wheel_rad * DEG_PER_RAD
    held = [button.name.lower() for button in Button if int(driver.pressed) & button and button.name]
    shown = [f"wheel     {needle(driver.hand_wheel_rad / lock_rad)} {angle:+7.1f} deg  {_WORDS[driver.wheel_validity]}"]
    for name in ("throttle", "brake", "clutch", "handbrake"):
        share, validity = getattr(driver, name), getattr(driver, f"{name}_validity")
        shown.append(f"{name:<9} {bar(share)} {share:7.0%}      {_WORDS[validity]}")
    gear = "R" if driver.gear < 0.0 else "N" if driver.gear == 0.0 else f"{driver.gear:.0f}"
    shown.append(f"gear {gear}  {_WORDS[driver.shifter_validity]}  held: {' '.join(held) or '-'}")
    return shown
