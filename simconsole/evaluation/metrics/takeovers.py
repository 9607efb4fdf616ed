"""Take-over metrics as used in driver studies. Pure: state vectors and course in, figures out."""

from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.evaluation.metrics.table import Array, Drive
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


class Span(NamedTuple):
    """One take-over, as indices of ticks in the drive."""

    start: int  # the request or, unasked, the earliest motion that may belong to it
    authority: int  # MANUAL
    end: int  # exclusive
    asked: bool


def takeovers(drive: Drive, lateral_m: Array) -> list[dict[str, Any]]:
    """Return one record per take-over, in order.

    Times count from the request; for one that nobody asked for, from the person's authority (so they are negative).
    None: the control was not used, or there is no course. Jerk is that of accelerations averaged over 0.1 s.

    Args:
        drive: The state vectors.
        lateral_m: Left of the theoretical path, float64 [ticks]; empty without a course.
    """
    return [_measured(drive, lateral_m, span) for span in _spans(drive)]


def _spans(drive: Drive) -> list[Span]:
    mode = drive.column("arbitration.mode")
    found = []
    for at in (np.flatnonzero(np.isin(mode[:-1], _DRIVEN) & (mode[1:] == float(Mode.MANUAL))) + 1).tolist():
        own = int(np.flatnonzero(~np.isin(mode[:at], _DRIVEN))[-1]) + 1 if not np.isin(mode[:at], _DRIVEN).all() else 0
        requests = np.flatnonzero(mode[own:at] != float(Mode.AUTONOMOUS))
        asked = len(requests) > 0
        start = own + int(requests[0]) if asked else max(own, at - round(BEFORE_S * drive.tick_hz))
        later = np.flatnonzero(mode[at:] != float(Mode.MANUAL))
        last = at + int(later[0]) if len(later) else len(mode)
        found.append(Span(start, at, min(last, at + round(AFTER_S * drive.tick_hz)), asked))
    return found


def _measured(drive: Drive, lateral_m: Array, span: Span) -> dict[str, Any]:
    zero = span.start if span.asked else span.authority
    until = slice(span.start, span.authority + 1)
    after = slice(span.authority, span.end)
    wheel = drive.column("driver.hand_wheel_rad")
    own_motion = wheel - drive.column("motor.explained_rad")
    share = drive.column("arbitration.remote_lateral")[after]
    faded = np.flatnonzero(share <= 0.0)
    deviation = lateral_m[after] - lateral_m[span.authority] if len(lateral_m) else None
    jerk_x, jerk_y = (_jerk(drive.column(f"vehicle.{name}_mps2"), drive.tick_hz)[after] for name in ("ax", "ay"))

    def since_s(index: int | None) -> float | None:
        return None if index is None else (index - zero) / drive.tick_hz

    def first(reached: NDArray[np.bool_]) -> float | None:
        hits = np.flatnonzero(reached[until])
        return since_s(span.start + int(hits[0])) if len(hits) else None

    return {
        "tick": drive.first_tick + span.authority,
        "asked": span.asked,
        "reason": reason_label(float(drive.column("arbitration.reason")[span.authority])),
        "request_tick": drive.first_tick + span.start if span.asked else None,
        "first_steer_s": first(np.abs(own_motion - own_motion[span.start]) >= FIRST_STEER_RAD),
        "first_brake_s": first(drive.column("arbitration.person_brake") >= FIRST_PEDAL),
        "first_throttle_s": first(drive.column("arbitration.person_throttle") >= FIRST_PEDAL),
        "authority_s": since_s(span.authority),
        "sole_authority_s": since_s(span.authority + int(faded[0])) if len(faded) else None,
        "peak_deviation_m": None if deviation is None else float(np.abs(deviation).max()),
        "peak_lateral_accel_mps2": float(np.abs(drive.column("vehicle.ay_mps2")[after]).max()),
        "peak_lateral_jerk_mps3": float(np.abs(jerk_y).max()),
        "peak_longitudinal_jerk_mps3": float(np.abs(jerk_x).max()),
        "peak_hand_wheel_radps": float(np.abs(drive.column("driver.hand_wheel_radps")[after]).max()),
        "hand_wheel_deviation_rad": float(np.std(wheel[after])),
    }


def _jerk(accel_mps2: Array, tick_hz: int) -> Array:
    width = max(1, round(_SMOOTH_S * tick_hz))
    edges = np.pad(accel_mps2, (width // 2, width - 1 - width // 2), mode="edge")
    smooth = np.convolve(edges, np.full(width, 1.0 / width), mode="valid")
    return np.diff(smooth, prepend=smooth[0]) * tick_hz
