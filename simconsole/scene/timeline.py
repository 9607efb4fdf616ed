"""What moves: state vectors of ticks to poses, plots, mode lane, driven path and log lines. Pure arrays, no rerun.

Works on pieces of a drive in order: `Memory` carries over what the next piece continues.
"""

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.scene.entities import Array, Colour
from simconsole.values.labels import (
    commander_label,
    gear_label,
    indicator_label,
    mode_label,
    notice_label,
    reason_label,
)
from simconsole.values.signals import Event, Mode, Notice
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS, NS_PER_S, RPM_PER_RADPS

Ticks = NDArray[np.int64]

STRIP_POINTS: Final = 12
"""Points of one piece of the driven path: each piece appears when the cursor reaches its end."""
STANDING_M: Final = 0.05
"""A shorter piece is joined to the next one: a standing car draws nothing."""


class Series(NamedTuple):
    """One line of a plot."""

    name: str
    column: str
    factor: float
    colour: Colour


class Plot(NamedTuple):
    """One plot: its entity path, its title with unit, its lines and its fixed range, if any."""

    path: str
    title: str
    series: tuple[Series, ...]
    low: float | None = None
    high: float | None = None


PLOTS: Final[tuple[Plot, ...]] = (
    Plot("plots/speed", "speed, km/h", (Series("car", "vehicle.vx_mps", KMH_PER_MPS, (226, 232, 238)),)),
    Plot(
        "plots/pedals",
        "pedals, 0 to 1",
        (
            Series("throttle", "command.throttle", 1.0, (54, 217, 123)),
            Series("brake", "command.brake", 1.0, (235, 80, 80)),
            Series("clutch", "vehicle.clutch", 1.0, (150, 160, 175)),
        ),
        -0.05,
        1.05,
    ),
    Plot(
        "plots/road_wheel",
        "road wheel, deg, left positive",
        (
            Series("driver asks", "arbitration.person_road_wheel_rad", DEG_PER_RAD, (255, 176, 32)),
            Series("autopilot asks", "arbitration.remote_road_wheel_rad", DEG_PER_RAD, (54, 217, 123)),
            Series("car", "vehicle.road_wheel_rad", DEG_PER_RAD, (226, 232, 238)),
        ),
    ),
    Plot(
        "plots/authority",
        "autopilot's authority, 0 to 1",
        (
            Series("lateral", "arbitration.remote_lateral", 1.0, (54, 217, 123)),
            Series("longitudinal", "arbitration.remote_longitudinal", 1.0, (150, 222, 176)),
        ),
        -0.05,
        1.05,
    ),
    Plot("plots/engine", "engine, rpm", (Series("engine", "vehicle.engine_radps", RPM_PER_RADPS, (226, 232, 238)),)),
)


_LANES: Final = (
    ("lanes/mode", "arbitration.mode"),  # rerun sorts lanes by name: who drives comes first
    ("lanes/remote", "arbitration.commander"),
    ("lanes/takeover", "arbitration.takeover_stage"),
    ("lanes/transmission", "vehicle.gear"),
    ("lanes/turn_indicators", "command.turn_indicators"),
    ("lanes/hazard_lights", "command.hazard_lights"),
)
TAKEOVER_LABELS: Final = ("none", "asked", "escalated")
_OTHERS: Final = ("x_m", "y_m", "z_m", "yaw_rad", "pitch_rad", "roll_rad")
NEEDED: Final[tuple[str, ...]] = tuple(
    dict.fromkeys(
        (
            *(f"vehicle.{name}" for name in _OTHERS),
            *(line.column for plot in PLOTS for line in plot.series),
            *(column for _, column in _LANES),
            "arbitration.reason",
            "arbitration.refusal",
            "arbitration.notice",
            "events.events",
            "events.ecu_events",
        )
    )
)
"""The columns of a state vector that the scene reads."""


class Lane(NamedTuple):
    """Changes of one state over time: at `times_ns[i]` it became `states[i]` (labels)."""

    path: str
    times_ns: list[int]
    states: list[str]


class Entry(NamedTuple):
    """One line of the log."""

    t_ns: int
    level: str  # INFO, WARN or ERROR
    text: str


class Strip(NamedTuple):
    """One piece of the driven path [N, 3], complete at `t_ns`."""

    t_ns: int
    points: Array
    mode: float


class Piece(NamedTuple):
    """Everything that some state vectors add to the scene; the first four and the plots are at the scene's own rate."""

    ticks: Ticks
    times_ns: Ticks
    positions: Array  # [N, 3] m
    quaternions: Array  # [N, 4] x, y, z, w
    plots: dict[str, Array]  # entity path -> [N, lines]
    lanes: tuple[Lane, ...]
    strips: tuple[Strip, ...]
    entries: tuple[Entry, ...]


class Memory(NamedTuple):
    """What the next piece continues: the last states seen and the open end of the driven path."""

    seen: dict[str, float] | None = None
    open_end: Array | None = None


def piece(
    vectors: Array, columns: Sequence[str], ticks: Ticks, tick_hz: int, rate_hz: int, memory: Memory
) -> tuple[Piece, Memory]:
    """Turn state vectors into shapes.

    Args:
        vectors: float64 [N, columns], in the order of their ticks; N at least 1.
        columns: name of each column, `stage.field_unit` (simconsole.values.state_vector.columns).
        ticks: int64 [N].
        tick_hz: ticks per second.
        rate_hz: how often poses and plots are kept; changes of mode and log lines keep their exact tick.
        memory: what the piece before left; `Memory()` at the start.
    """
    table = {name: vectors[:, columns.index(name)] for name in NEEDED}
    times_ns = ticks * NS_PER_S // tick_hz
    keep = np.flatnonzero(ticks % max(1, round(tick_hz / rate_hz)) == 0)
    kept = {name: column[keep] for name, column in table.items()}
    positions = np.column_stack([kept[f"vehicle.{axis}_m"] for axis in "xyz"])
    strips, open_end = _strips(positions, kept["arbitration.mode"], times_ns[keep], memory.open_end)
    lanes, seen = _lanes(table, times_ns, memory.seen)
    return Piece(
        ticks=ticks[keep],
        times_ns=times_ns[keep],
        positions=positions,
        quaternions=quaternions(kept["vehicle.yaw_rad"], kept["vehicle.pitch_rad"], kept["vehicle.roll_rad"]),
        plots={plot.path: np.column_stack([line.factor * kept[line.column] for line in plot.series]) for plot in PLOTS},
        lanes=lanes,
        strips=strips,
        entries=tuple(_entries(table, times_ns, memory.seen)),
    ), Memory(seen, open_end)


def quaternions(yaw_rad: Array, pitch_rad: Array, roll_rad: Array) -> Array:
    """Return [N, 4] (x, y, z, w) of a turn by yaw, then pitch, then roll about the turned axes (ISO 8855)."""
    cy, sy = np.cos(0.5 * yaw_rad), np.sin(0.5 * yaw_rad)
    cp, sp = np.cos(0.5 * pitch_rad), np.sin(0.5 * pitch_rad)
    cr, sr = np.cos(0.5 * roll_rad), np.sin(0.5 * roll_rad)
    return np.column_stack(
        (
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        )
    )


def lane_label(path: str, value: float) -> str:
    """Return what a lane shows for a value."""
    if path == "lanes/mode":
        return mode_label(value)
    if path == "lanes/remote":
        return commander_label(value)
    if path == "lanes/takeover":
        return TAKEOVER_LABELS[int(value)] if value in (0.0, 1.0, 2.0) else f"{value:g}"
    if path == "lanes/turn_indicators":
        return indicator_label(value)
    if path == "lanes/hazard_lights":
        return "on" if value > 0.0 else "off"
    return gear_label(value)


def _lanes(
    table: dict[str, Array], times_ns: Ticks, seen: dict[str, float] | None
) -> tuple[tuple[Lane, ...], dict[str, float]]:
    lanes: list[Lane] = []
    last: dict[str, float] = {}
    for path, column in _LANES:
        values = table[column]
        changed = _changes(values, None if seen is None else seen[column])
        labels = [lane_label(path, float(values[index])) for index in changed]
        lanes.append(Lane(path, times_ns[changed].tolist(), labels))
        last[column] = float(values[-1])
    for column in ("arbitration.reason", "arbitration.refusal", "arbitration.notice", "events.events"):
        last[column] = float(table[column][-1])
    return tuple(lanes), last


def _changes(values: Array, before: float | None) -> NDArray[np.intp]:
    """Return where `values` differ from the value before; without one, the first counts as a change."""
    first = values[0] - 1.0 if before is None else before
    return np.flatnonzero(np.diff(values, prepend=first) != 0.0)


_LEVELS: Final[dict[float, str]] = {
    Mode.TAKEOVER_REQUESTED: "WARN",
    Mode.MINIMAL_RISK: "ERROR",
    Mode.EMERGENCY_STOP: "ERROR",
}


def _entries(table: dict[str, Array], times_ns: Ticks, seen: dict[str, float] | None) -> Iterator[Entry]:
    found: list[tuple[int, Entry]] = []
    mode, reason = table["arbitration.mode"], table["arbitration.reason"]
    for index in _changes(mode, None if seen is None else seen["arbitration.mode"]).tolist():
        text = f"{mode_label(mode[index])}: {reason_label(reason[index])}"
        found.append((index, Entry(int(times_ns[index]), _LEVELS.get(mode[index], "INFO"), text)))
    for column, label_of in (("arbitration.refusal", reason_label), ("arbitration.notice", notice_label)):
        told = table[column]
        changed = _changes(told, 0.0 if seen is None else seen[column])
        found.extend(
            (index, Entry(int(times_ns[index]), "WARN", label_of(told[index])))
            for index in changed[told[changed] != 0.0].tolist()
        )
    failed = _recording_failed(table["events.events"])
    before = 0.0 if seen is None else float(_recording_failed(np.array([seen["events.events"]]))[0])
    alarm = notice_label(float(Notice.RECORDING_FAILED))
    found.extend((index, Entry(int(times_ns[index]), "ERROR", alarm)) for index in _changes(failed, before).tolist())
    for who, column in (("event", "events.events"), ("event on CAN", "events.ecu_events")):
        events = table[column] - Event.RECORDING_FAILED * _recording_failed(table[column])  # lasts: logged once above
        for index in np.flatnonzero(events).tolist():
            named = (str(event.name).lower().replace("_", " ") for event in Event if int(events[index]) & event)
            found.append((index, Entry(int(times_ns[index]), "INFO", f"{who}: {', '.join(named)}")))
    yield from (entry for _, entry in sorted(found, key=lambda item: item[0]))


def _recording_failed(events: Array) -> Array:
    """Return 1.0 where recording has failed, else 0.0."""
    failed: Array = ((events.astype(np.int64) & int(Event.RECORDING_FAILED)) != 0).astype(np.float64)
    return failed


def _strips(
    positions: Array, modes: Array, times_ns: Ticks, open_end: Array | None
) -> tuple[tuple[Strip, ...], Array | None]:
    """Cut the driven path into pieces of one mode; each starts where the one before ended."""
    strips: list[Strip] = []
    points: list[Array] = [] if open_end is None else [open_end]
    for index in range(len(positions)):
        points.append(positions[index])
        last = index + 1 == len(positions) or modes[index + 1] != modes[index]
        if len(points) <= STRIP_POINTS and not last:
            continue
        line = np.array(points)
        if np.ptp(line, axis=0).max() < STANDING_M:
            points = points[:1]
            continue
        strips.append(Strip(int(times_ns[index]), line, float(modes[index])))
        points = [positions[index]]
    return tuple(strips), points[0] if points else None
