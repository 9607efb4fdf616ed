"""Take-over metrics as used in driver studies. Pure: columns and track in, figures out."""

from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics.table import Array, Drive, runs
from simconsole.evaluation.metrics.track import Track
from simconsole.values.labels import reason_label
from simconsole.values.signals import Mode
from simconsole.values.units import RAD_PER_DEG

FIRST_STEER_RAD: Final = 2.0 * RAD_PER_DEG
"""More than this is a reaction (Gold, Damboeck, Lorenz, Bengler 2013); resting hands cause less."""
FIRST_PEDAL: Final = 0.05
AFTER_S: Final = 10.0
"""How long after the take-over its quality is measured."""
BEFORE_S: Final = 5.0
"""How far before an unasked take-over the person's first motion is looked for."""
_SMOOTH_S: Final = 0.1

_DRIVEN: Final = (float(Mode.AUTONOMOUS), float(Mode.TAKEOVER_REQUESTED), float(Mode.MINIMAL_RISK))

_COLUMNS: Final = (
    "driver.hand_wheel_rad",
    "driver.hand_wheel_radps",
    "motor.explained_rad",
    "arbitration.reason",
    "arbitration.remote_lateral",
    "arbitration.person_brake",
    "arbitration.person_throttle",
    "vehicle.ax_mps2",
    "vehicle.ay_mps2",
)


class Span(NamedTuple):
    """One take-over, as indices of ticks in the drive."""

    start: int  # the request or, unasked, the earliest motion that may belong to it
    authority: int  # MANUAL
    end: int  # exclusive
    asked: bool


def takeovers(drive: Drive, way: Track) -> list[dict[str, Any]]:
    """Return one record per take-over, in order.

    Times count from the request; for one that nobody asked for, from the person's authority (so they are negative).
    None: the control was not used, or there is no course. Jerk is that of accelerations averaged over 0.1 s.
    """
    spans = _spans(drive, way)
    beside = _smooth_ticks(drive.tick_hz)
    parts = [(max(0, span.start - beside), min(drive.ticks, span.end + beside)) for span in spans]
    windows = drive.windows(_COLUMNS, parts)
    return [
        _measured(drive, way.lateral_m, span, part[0], window)
        for span, part, window in zip(spans, parts, windows, strict=True)
    ]


def _spans(drive: Drive, way: Track) -> list[Span]:
    found = []
    modes = runs([way.mode])
    driven = np.isin(modes.values, _DRIVEN)
    for taken in (np.flatnonzero(driven[:-1] & (modes.values[1:] == float(Mode.MANUAL))) + 1).tolist():
        first = taken - 1  # run in which the controller got the car
        while first > 0 and driven[first - 1]:
            first -= 1
        own, at = int(modes.starts[first]), int(modes.starts[taken])
        requests = modes.starts[first:taken][modes.values[first:taken] != float(Mode.AUTONOMOUS)]
        asked = len(requests) > 0
        start = int(requests[0]) if asked else max(own, at - round(BEFORE_S * drive.tick_hz))
        found.append(Span(start, at, min(int(modes.ends[taken]), at + round(AFTER_S * drive.tick_hz)), asked))
    return found


def _measured(drive: Drive, lateral_m: Array, span: Span, begin: int, columns: dict[str, Array]) -> dict[str, Any]:
    """Return what a take-over was like, from `columns` that begin at the drive's index `begin`."""
    zero = span.start if span.asked else span.authority
    until = slice(span.start - begin, span.authority + 1 - begin)
    after = slice(span.authority - begin, span.end - begin)
    wheel = columns["driver.hand_wheel_rad"]
    own_motion = wheel - columns["motor.explained_rad"]
    faded = np.flatnonzero(columns["arbitration.remote_lateral"][after] <= 0.0)
    lateral = lateral_m[span.authority : span.end]
    jerk_x, jerk_y = (_jerk(columns[f"vehicle.{name}_mps2"], drive.tick_hz)[after] for name in ("ax", "ay"))

    def since_s(index: int | None) -> float | None:
        return None if index is None else (index - zero) / drive.tick_hz

    def first(reached: NDArray[np.bool_]) -> float | None:
        hits = np.flatnonzero(reached[until])
        return since_s(span.start + int(hits[0])) if len(hits) else None

    return {
        "tick": drive.first_tick + span.authority,
        "asked": span.asked,
        "reason": reason_label(float(columns["arbitration.reason"][after.start])),
        "request_tick": drive.first_tick + span.start if span.asked else None,
        "first_steer_s": first(np.abs(own_motion - own_motion[until.start]) >= FIRST_STEER_RAD),
        "first_brake_s": first(columns["arbitration.person_brake"] >= FIRST_PEDAL),
        "first_throttle_s": first(columns["arbitration.person_throttle"] >= FIRST_PEDAL),
        "authority_s": since_s(span.authority),
        "sole_authority_s": since_s(span.authority + int(faded[0])) if len(faded) else None,
        "peak_deviation_m": float(np.abs(lateral - lateral[0]).max()) if len(lateral) else None,
        "peak_lateral_accel_mps2": float(np.abs(columns["vehicle.ay_mps2"][after]).max()),
        "peak_lateral_jerk_mps3": float(np.abs(jerk_y).max()),
        "peak_longitudinal_jerk_mps3": float(np.abs(jerk_x).max()),
        "peak_hand_wheel_radps": float(np.abs(columns["driver.hand_wheel_radps"][after]).max()),
        "hand_wheel_deviation_rad": float(np.std(wheel[after])),
    }


def _smooth_ticks(tick_hz: int) -> int:
    return max(1, round(_SMOOTH_S * tick_hz))


def _jerk(accel_mps2: Array, tick_hz: int) -> Array:
    width = _smooth_ticks(tick_hz)
    edges = np.pad(accel_mps2, (width // 2, width - 1 - width // 2), mode="edge")
    smooth = np.convolve(edges, np.full(width, 1.0 / width), mode="valid")
    return np.diff(smooth, prepend=smooth[0]) * tick_hz
