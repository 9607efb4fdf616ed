"""What moves: state vectors of ticks to poses, plots, mode lane, driven path and log lines. Pure arrays, no rerun.

Works on pieces of a drive in order: `Memory` carries over what the next piece continues.
"""

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.scene.entities import Array
from simconsole.scene.lanes import LANE_COLUMNS, Lane, changes, lane_changes
from simconsole.scene.plots import Follower, plot_columns, plot_lines
from simconsole.scene.predicted_way import WAY_COLUMNS, Ways, ways
from simconsole.scene.wheel_shapes import WHEEL_COLUMNS, ShownWheels, WheelShapes, wheel_shapes
from simconsole.values.labels import mode_label, notice_label, reason_label
from simconsole.values.signals import Event, Mode, Notice
from simconsole.values.units import NS_PER_S

Ticks = NDArray[np.int64]

STRIP_POINTS: Final = 12
"""Points of one piece of the driven path: each piece appears when the cursor reaches its end."""
STANDING_M: Final = 0.05
"""A shorter piece is joined to the next one: a standing car draws nothing."""
_REMEMBERED: Final = (
    *LANE_COLUMNS,
    "arbitration.reason",
    "arbitration.refusal",
    "arbitration.notice",
    "events.events",
    "ahead.traffic_lost",
)
_OTHERS: Final = ("x_m", "y_m", "z_m", "yaw_rad", "pitch_rad", "roll_rad")
NEEDED: Final[tuple[str, ...]] = tuple(
    dict.fromkeys(
        (
            *(f"vehicle.{name}" for name in _OTHERS),
            *plot_columns(is_robot=False),
            *LANE_COLUMNS,
            *WAY_COLUMNS,
            "arbitration.reason",
            "arbitration.refusal",
            "arbitration.notice",
            "events.events",
            "events.ecu_events",
        )
    )
)
"""The columns of a state vector that the scene reads of any vehicle; of a robot those of its plots, too."""
TRAFFIC_LOST: Final = "ahead.traffic_lost"
"""Likewise; recordings of earlier versions have no such column."""


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
    ways: Ways
    wheels: WheelShapes | None  # of a car, at the scene's own rate


class ShownVehicle(NamedTuple):
    """What one must know of a vehicle, beside its state, to show how it moves."""

    wheelbase_m: float = 0.0  # 0: it turns in place
    wheels: ShownWheels | None = None  # of a car
    is_robot: bool = False


NO_VEHICLE: Final = ShownVehicle()


class Memory(NamedTuple):
    """What the next piece continues: the last states seen and the open end of the driven path."""

    seen: dict[str, float] | None = None
    open_end: Array | None = None


def piece(
    vectors: Array,
    columns: Sequence[str],
    ticks: Ticks,
    tick_hz: int,
    rate_hz: int,
    memory: Memory,
    vehicle: ShownVehicle = NO_VEHICLE,
    follower: Follower | None = None,
) -> tuple[Piece, Memory]:
    """Turn state vectors into shapes.

    Args:
        vectors: float64 [N, columns], in the order of their ticks; N at least 1.
        columns: name of each column, `stage.field_unit` (simconsole.values.state_vector.columns).
        ticks: int64 [N].
        tick_hz: ticks per second.
        rate_hz: how often poses and plots are kept; changes of mode and log lines keep their exact tick.
        memory: what the piece before left; `Memory()` at the start.
        vehicle: what one must know of it beside its state.
        follower: of the route; None: there is none.
    """
    places = {name: index for index, name in enumerate(columns)}
    table = {name: vectors[:, places[name]] for name in (*NEEDED, *plot_columns(vehicle.is_robot))}
    table[TRAFFIC_LOST] = vectors[:, places[TRAFFIC_LOST]] if TRAFFIC_LOST in places else np.zeros(len(vectors))
    times_ns = ticks * NS_PER_S // tick_hz
    keep = np.flatnonzero(ticks % max(1, round(tick_hz / rate_hz)) == 0)
    kept = {name: column[keep] for name, column in table.items()}
    positions = np.column_stack([kept[f"vehicle.{axis}_m"] for axis in "xyz"])
    strips, open_end = _strips(positions, kept["arbitration.mode"], times_ns[keep], memory.open_end)
    entries = tuple(_entries(table, times_ns, memory.seen))
    wheels = None
    if vehicle.wheels is not None and set(WHEEL_COLUMNS) <= set(places):
        wheels = wheel_shapes({name: vectors[keep, places[name]] for name in WHEEL_COLUMNS}, vehicle.wheels)
    return Piece(
        ticks=ticks[keep],
        times_ns=times_ns[keep],
        positions=positions,
        quaternions=quaternions(kept["vehicle.yaw_rad"], kept["vehicle.pitch_rad"], kept["vehicle.roll_rad"]),
        plots=plot_lines(kept, tick_hz, follower or Follower(), vehicle.is_robot),
        lanes=lane_changes(table, times_ns, memory.seen, vehicle.is_robot),
        strips=strips,
        entries=entries,
        ways=ways(table, ticks, times_ns, tick_hz, vehicle.wheelbase_m),
        wheels=wheels,
    ), Memory({name: float(table[name][-1]) for name in _REMEMBERED}, open_end)


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


_LEVELS: Final[dict[float, str]] = {
    Mode.TAKEOVER_REQUESTED: "WARN",
    Mode.MINIMAL_RISK: "ERROR",
    Mode.EMERGENCY_STOP: "ERROR",
}


def _entries(table: dict[str, Array], times_ns: Ticks, seen: dict[str, float] | None) -> Iterator[Entry]:
    found: list[tuple[int, Entry]] = []
    mode, reason = table["arbitration.mode"], table["arbitration.reason"]
    for index in changes(mode, None if seen is None else seen["arbitration.mode"]).tolist():
        text = f"{mode_label(mode[index])}: {reason_label(reason[index])}"
        found.append((index, Entry(int(times_ns[index]), _LEVELS.get(mode[index], "INFO"), text)))
    for column, label_of in (("arbitration.refusal", reason_label), ("arbitration.notice", notice_label)):
        told = table[column]
        changed = changes(told, 0.0 if seen is None else seen[column])
        found.extend(
            (index, Entry(int(times_ns[index]), "WARN", label_of(told[index])))
            for index in changed[told[changed] != 0.0].tolist()
        )
    was = (0.0, 0.0) if seen is None else (seen["events.events"], seen[TRAFFIC_LOST])
    failures = (
        (_recording_failed(table["events.events"]), float(_recording_failed(np.array(was[:1]))[0])),
        (table[TRAFFIC_LOST], was[1]),
    )
    for (failed, before), notice in zip(failures, (Notice.RECORDING_FAILED, Notice.TRAFFIC_LOST), strict=True):
        alarm = notice_label(float(notice))
        found.extend((index, Entry(int(times_ns[index]), "ERROR", alarm)) for index in changes(failed, before).tolist())
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
