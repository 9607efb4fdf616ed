"""Statistics of a drive of the autopilot."""

import math
from dataclasses import dataclass
from typing import Any


@dataclass
class TrackingStatistics:
    """Commands given and, while the autopilot had the car, how well it followed."""

    commands: int = 0
    skipped: int = 0  # odometry with a value that is not finite, or that came after a newer one
    withheld: int = 0  # odometry that was not answered: the car is too far from the course
    at_end: bool = False  # the car has come to the end of an open course and stands there
    engaged: int = 0
    squares_m2: float = 0.0
    worst_m: float = 0.0
    speeds_mps: float = 0.0
    first_m: float | None = None
    last_m: float = 0.0

    def add(self, engaged: bool, s_m: float, lateral_m: float, speed_mps: float) -> None:
        """Count one answered odometry."""
        self.commands += 1
        if not engaged:
            return
        self.engaged += 1
        self.squares_m2 += lateral_m * lateral_m
        self.worst_m = max(self.worst_m, abs(lateral_m))
        self.speeds_mps += speed_mps
        self.first_m = s_m if self.first_m is None else self.first_m
        self.last_m = s_m

    def results(self) -> dict[str, Any]:
        """Return the statistics; figures of engaged driving are None where the autopilot never drove."""
        count = self.engaged
        return {
            "commands": self.commands,
            "skipped": self.skipped,
            "withheld": self.withheld,
            "at_end": self.at_end,
            "engaged_commands": count,
            "engaged_distance_m": self.last_m - self.first_m if self.first_m is not None else None,
            "lateral_rms_m": math.sqrt(self.squares_m2 / count) if count else None,
            "lateral_max_m": self.worst_m if count else None,
            "mean_speed_mps": self.speeds_mps / count if count else None,
        }
