"""What the figures of a report show, in words: for who does not see them, and for captions. Pure."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from simconsole.evaluation.manoeuvres.attempt import Line, Panel
from simconsole.evaluation.report.metric_rows import rounded
from simconsole.world.route import Route

_DRIVERS = (("autonomous", "the autopilot"), ("manual", "the person"))


def map_words(found: Mapping[str, Any], route: Route | None) -> str:
    """Return what the map of a drive with these metrics shows."""
    parts = [f"{who} drove {rounded(found[key]['distance_m'])} m" for key, who in _DRIVERS if found[key]]
    theory = "over the theoretical path" if route is not None else "in a world without a course"
    driven = ", ".join(parts) or "nobody drove"
    return f"The driven path {theory}, start green, end red: {driven}. Diamonds are changes of the mode."


def traces_words(found: Mapping[str, Any], route: Route | None) -> str:
    """Return what the plots over the distance show."""
    said = [f"Over {rounded(found['distance_m'])} m"]
    for key, who in _DRIVERS:
        part = found[key]
        if part and route is not None and part["lateral_rms_m"] is not None:
            rms, most = (rounded(100.0 * part[name]) for name in ("lateral_rms_m", "lateral_max_m"))
            said.append(f"{who} was beside the path by {rms} cm RMS and at most {most} cm")
    said.append(f"the speed was at most {rounded(found['max_speed_kmh'])} km/h")
    said.append(f"{len(found['mode_changes']) - 1} times the mode changed or a request was refused")
    return "; ".join(said) + "."


def panels_words(panels: Sequence[Panel]) -> str:
    """Return what plots show: for each the span of its lines."""
    return " ".join(f"{panel.title} ({panel.y_label}): {_spans(panel.lines)}." for panel in panels)


def _spans(lines: Sequence[Line]) -> str:
    named = [line for line in lines if line.label] or lines[:1]
    return "; ".join(f"{line.label} {_span(line)}".strip() for line in named)


def _span(line: Line) -> str:
    known = np.asarray(line.y)[np.isfinite(line.y)]
    return f"from {rounded(float(known.min()))} to {rounded(float(known.max()))}" if len(known) else "nothing"
