"""How the simulated person drives off: throttle and clutch while the clutch bites. Pure."""

from typing import Final

from simconsole.drivers.simulated_person.view import View
from simconsole.profiles.person import Habits
from simconsole.values.units import RADPS_PER_RPM, RPM_PER_RADPS

BITE_FROM: Final = 0.8
"""Above this pedal position a clutch transmits nothing, so the foot moves quickly down to it."""
HOLD_RPM: Final = 1250.0
"""Where a foot stops letting the clutch up in a launch: faster engine, further up; slower engine, back down."""
SENSE_RPM: Final = 250.0
ALARM: Final = -6.0
"""Factor by which the foot presses the clutch faster than it releases it, to keep the engine from stalling."""
LAUNCH_GAIN_S: Final = 0.006
LAUNCH_THROTTLE: Final = 0.2


def launch_throttle(view: View, habits: Habits) -> float:
    """Return the throttle that keeps the engine near the launch speed while the clutch bites."""
    missing_radps = habits.launch_rpm * RADPS_PER_RPM - view.engine_radps
    return min(habits.throttle_max, max(0.0, LAUNCH_THROTTLE + LAUNCH_GAIN_S * missing_radps))


def clutch_through_bite(foot: float, view: View, habits: Habits, tick_s: float) -> float:
    """Return the clutch pedal one tick later: up while the engine runs freely, held or pressed when it labours."""
    ease = (view.engine_radps * RPM_PER_RADPS - HOLD_RPM) / SENSE_RPM
    if foot > BITE_FROM and ease > 0.0:
        return foot - habits.foot_per_s * tick_s
    up = habits.bite_release_per_s * min(1.0, max(ALARM, ease)) * tick_s
    return min(1.0, max(0.0, foot - up))
