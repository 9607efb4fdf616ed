"""What the driver reads, as values for a display of another program: the fields of simconsole_msgs/Hud."""

import math
from typing import Any, Final

from simconsole.hud.banner import ALERT_LABELS, Alert, alert_of
from simconsole.hud.view import HudMemory, HudSettings, view
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import KMH_PER_MPS

NO_TURN_M: Final = -1.0


class HudReading:
    """Reads tick after tick; what a display remembers from one to the next is remembered here."""

    def __init__(self, settings: HudSettings) -> None:
        """Take the rules of the drive."""
        self._settings = settings
        self._memory = HudMemory()

    def __call__(self, snapshot: Snapshot) -> dict[str, Any]:
        """Return the fields of a message, its header left out."""
        shown, self._memory = view(snapshot, 0.0, self._memory, self._settings)
        alert = alert_of(shown)
        turn = shown.ahead
        vehicle, arbitration = snapshot.vehicle, snapshot.arbitration
        headline = ALERT_LABELS[alert][0] if alert in ALERT_LABELS else shown.refusal_label or shown.notice_label
        return {
            "speed": vehicle.vx_mps,
            "shown_speed": shown.shown_kmh,
            "gear": shown.gear,
            "automatic": shown.automatic,
            "engine_speed": max(0.0, vehicle.engine_radps),
            "mode": int(shown.mode),
            "mode_words": shown.mode_label,
            "reason_words": shown.reason_label,
            "todo_words": shown.todo_label,
            "refusal_words": shown.refusal_label,
            "notice_words": shown.notice_label,
            "remote_lateral": shown.remote_lateral,
            "remote_longitudinal": arbitration.remote_longitudinal,
            "other_side": shown.other_side,
            "takeover_stage": shown.takeover_stage,
            "takeover_remaining": shown.remaining_s,
            "alert": int(alert),
            "alert_words": "" if alert is Alert.NONE else headline,
            "throttle": shown.throttle,
            "brake": shown.brake,
            "hand_wheel": math.radians(shown.hand_wheel_deg),
            "turn_indicators": int(shown.turn_indicators),
            "hazard_lights": shown.hazard_lights > 0.0,
            "speed_limit": shown.limit_kmh / KMH_PER_MPS,
            "turn_distance": NO_TURN_M if turn is None else turn.distance_m,
            "turn_angle": 0.0 if turn is None else turn.angle_rad,
            "turn_exit": 0 if turn is None else turn.exit,
            "turn_ends": turn is not None and turn.is_end,
            "distance": shown.distance_m,
        }
