"""The figures of a report: what each is called, in which unit people read it, and what it means."""

from collections.abc import Mapping
from typing import Any, Final, NamedTuple


class MetricRow(NamedTuple):
    """One figure."""

    key: str  # in the metrics
    label: str
    unit: str
    meaning: str
    factor: float = 1.0  # from the metrics' unit to this one

    def written(self, value: float | None) -> str:
        """Return a value of the metrics with its unit, rounded; a dash where there is none."""
        if value is None:
            return "-"
        return f"{rounded(value if self.factor == 1.0 else value * self.factor)} {self.unit}".rstrip()


def rounded(value: float) -> str:
    """Return a number as people read it: whole from 100 on, one decimal from 10 on, two below; counts as they are."""
    size = abs(value)
    if size == 0.0 or isinstance(value, int):
        return f"{value:.0f}"
    digits = 0 if size >= 99.95 else 1 if size >= 9.995 else 2
    return f"{value:.{digits}f}"


_BESIDE: Final = "base_link, the centre of the rear axle, from the theoretical path, over every tick that counts"
METRICS: Final = (
    MetricRow("duration_s", "Duration", "s", "simulated time"),
    MetricRow("distance_m", "Distance", "m", "way of base_link"),
    MetricRow("mean_speed_kmh", "Mean speed", "km/h", "distance over duration, standing included"),
    MetricRow("max_speed_kmh", "Highest speed", "km/h", "the largest of any tick"),
    MetricRow("speed_limit_kmh", "Speed limit", "km/h", "that of the route; single stretches may have their own"),
    MetricRow("above_limit_s", "Time above the limit", "s", "ticks that were faster than the limit of their place"),
    MetricRow("lateral_rms_m", "Lateral error, RMS", "cm", f"root mean square of the distance of {_BESIDE}", 100.0),
    MetricRow("lateral_p95_m", "Lateral error, 95 %", "cm", "95 % of the ticks have at most this distance", 100.0),
    MetricRow(
        "lateral_deviation_m",
        "Lateral position, standard deviation (SDLP)",
        "cm",
        "SDLP of SAE J2944: the standard deviation of the lateral position, over the ticks faster than 1 m/s",
        100.0,
    ),
    MetricRow("lateral_max_m", "Lateral error, largest", "cm", "the largest distance of any tick", 100.0),
    MetricRow("lateral_max_at_m", "Largest error after", "m", "distance driven before that tick"),
    MetricRow(
        "max_lateral_accel_mps2", "Highest lateral acceleration", "m/s²", "of base_link to either side, in any tick"
    ),
)
TAKEOVER: Final = (
    MetricRow("first_steer_s", "first steering, s", "", "the hands turned the wheel by more than 2 degrees"),
    MetricRow("first_brake_s", "first brake, s", "", "the brake was pressed by more than 5 %"),
    MetricRow("first_throttle_s", "first accelerator, s", "", "the accelerator was pressed by more than 5 %"),
    MetricRow("authority_s", "authority, s", "", "the person had the car alone"),
    MetricRow(
        "peak_deviation_m",
        "largest deviation, m",
        "",
        "how far the car came from its place beside the path in the 10 s after that",
    ),
    MetricRow(
        "peak_lateral_jerk_mps3",
        "largest lateral jerk, m/s³",
        "",
        "the fastest change of the lateral acceleration, averaged over 0.1 s, in the same 10 s",
    ),
)
"""Times count from the request, or from the person's authority where nobody had asked (so they are negative)."""
ROAD: Final = (
    MetricRow("lights_passed", "Lights passed", "", "times that the car's front passed a light's stop line"),
    MetricRow("lights_stood_at", "Stood at, of these", "", "the car stood within 50 m before the line"),
    MetricRow("let_pass", "Somebody had to be let pass", "", "on a crossing, or with the right of way"),
)
ADVICE: Final = (
    MetricRow("lights", "Lights, in all", "", "lights that were passed"),
    MetricRow("stops", "Stood", "%", "share of the lights at which the car stood within 50 m before the line", 100.0),
    MetricRow("waiting_s", "Waiting", "s", "standing time"),
    MetricRow("time_loss_s", "Time lost against the limit", "s", "beyond the time that the way takes at the limit"),
    MetricRow("energy_jpkg", "Energy to gain speed", "J/kg", "kinetic energy that was added, for each kg"),
)
DEFINITIONS: Final[tuple[tuple[str, tuple[MetricRow, ...]], ...]] = (
    ("", METRICS),
    ("takeovers", TAKEOVER),
    ("road", ROAD),
    ("speed_advice", ADVICE),
)
"""The part of the metrics that must be there for the figures to be shown, and the figures."""


def definitions(found: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return label and meaning of every figure that the report of these metrics shows."""
    return [(row.label, row.meaning) for part, rows in DEFINITIONS if not part or found.get(part) for row in rows]
