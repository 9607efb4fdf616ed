"""The operators' lanes: states that change now and then, as labels. Pure arrays, no rerun."""

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.scene.entities import MODE_COLOURS, Array, Colour
from simconsole.values.labels import (
    LINK_COMMANDER,
    LINK_CONNECTING,
    LINK_DOWN,
    LINK_LOST,
    LINK_NOBODY,
    LINK_RETRYING,
    commander_label,
    gear_label,
    indicator_label,
    link_label,
    mode_label,
    validity_label,
)
from simconsole.values.signals import Commander, LinkState, Validity

WHO_DRIVES: Final = "lanes"
HEALTH: Final = "health"
CONTROLS: Final = "controls"
"""Roots of the groups of lanes. rerun sorts the lanes of a view by name: the mode is the first of the first."""
LINK_LANE: Final = f"{HEALTH}/bridge"
TAKEOVER_LABELS: Final = ("none", "asked", "escalated")

QUIET: Final[Colour] = (72, 80, 90)
CALM: Final[Colour] = (64, 104, 160)
GOOD: Final[Colour] = (40, 130, 70)
CAUTION: Final[Colour] = (255, 176, 32)
ALARM: Final[Colour] = (235, 45, 60)


class Lane(NamedTuple):
    """Changes of one state over time: at `times_ns[i]` it became `states[i]` (labels)."""

    path: str
    times_ns: list[int]
    states: list[str]


class LaneKind(NamedTuple):
    """One lane: its entity path, the column that it shows, and how a value of it is said."""

    path: str
    column: str
    label: Callable[[float], str]
    colours: Mapping[str, Colour] = {}  # by label; rerun chooses where there is none
    of_robots: bool = True  # robots have it, too


def takeover_label(stage: float) -> str:
    """Return the stage of a take-over demand."""
    return TAKEOVER_LABELS[int(stage)] if stage in (0.0, 1.0, 2.0) else f"{stage:g}"


def on_label(value: float) -> str:
    """Return whether something is on."""
    return "on" if value > 0.0 else "off"


_MODES: Final = {mode_label(mode): colour for mode, colour in MODE_COLOURS.items()}
_STAGES: Final = dict(zip(TAKEOVER_LABELS, (QUIET, CAUTION, ALARM), strict=True))
_DEVICES: Final = {
    validity_label(Validity.UNKNOWN): QUIET,
    validity_label(Validity.ARMED): (150, 222, 176),
    validity_label(Validity.LIVE): GOOD,
    validity_label(Validity.STALE): CAUTION,
    validity_label(Validity.LOST): ALARM,
}
_CONTROLLERS: Final = {
    link_label(LinkState.NEVER): QUIET,
    link_label(LinkState.UNSTEADY): CAUTION,
    link_label(LinkState.STEADY): GOOD,
    link_label(LinkState.STALE): CAUTION,
    link_label(LinkState.INVALID): ALARM,
}
_ON: Final = {on_label(0.0): QUIET, on_label(1.0): CAUTION}
_COMMANDERS: Final = {
    commander_label(Commander.NOBODY): QUIET,
    commander_label(Commander.ROS): GOOD,
    commander_label(Commander.ECU): CALM,
}
_GEARS: Final = {gear_label(gear): (QUIET, CALM)[gear % 2] for gear in range(-1, 8)}
_INDICATORS: Final = {indicator_label(side): CAUTION if side else QUIET for side in (-1.0, 0.0, 1.0)}
LINK_COLOURS: Final[Mapping[str, Colour]] = {
    LINK_DOWN: ALARM,
    LINK_LOST: ALARM,
    LINK_RETRYING: CAUTION,
    LINK_CONNECTING: CAUTION,
    LINK_NOBODY: QUIET,
    LINK_COMMANDER: GOOD,
}

LANES: Final[tuple[LaneKind, ...]] = (
    LaneKind(f"{WHO_DRIVES}/mode", "arbitration.mode", mode_label, _MODES),
    LaneKind(f"{WHO_DRIVES}/remote", "arbitration.commander", commander_label, _COMMANDERS),
    LaneKind(f"{WHO_DRIVES}/takeover", "arbitration.takeover_stage", takeover_label, _STAGES),
    LaneKind(f"{CONTROLS}/gear", "vehicle.gear", gear_label, _GEARS, of_robots=False),
    LaneKind(f"{CONTROLS}/indicators", "command.turn_indicators", indicator_label, _INDICATORS, of_robots=False),
    LaneKind(f"{CONTROLS}/hazard_lights", "command.hazard_lights", on_label, _ON, of_robots=False),
    LaneKind(f"{HEALTH}/wheel", "driver.wheel_validity", validity_label, _DEVICES),
    LaneKind(f"{HEALTH}/throttle", "driver.throttle_validity", validity_label, _DEVICES),
    LaneKind(f"{HEALTH}/brake", "driver.brake_validity", validity_label, _DEVICES),
    LaneKind(f"{HEALTH}/shifter", "driver.shifter_validity", validity_label, _DEVICES, of_robots=False),
    LaneKind(f"{HEALTH}/motor", "torque.enabled", on_label, {on_label(0.0): QUIET, on_label(1.0): GOOD}),
    LaneKind(f"{HEALTH}/ros", "ros_link.state", link_label, _CONTROLLERS),
    LaneKind(f"{HEALTH}/can", "ecu_link.state", link_label, _CONTROLLERS),
)
LANE_COLUMNS: Final[tuple[str, ...]] = tuple(kind.column for kind in LANES)
"""The columns of a state vector that the lanes read."""


def lanes_of(is_robot: bool) -> tuple[LaneKind, ...]:
    """Return the lanes of a robot, or of any other vehicle."""
    return tuple(kind for kind in LANES if kind.of_robots or not is_robot)


def lane_changes(
    table: Mapping[str, Array], times_ns: NDArray[np.int64], seen: Mapping[str, float] | None, is_robot: bool = False
) -> tuple[Lane, ...]:
    """Return the changes of every lane.

    Args:
        table: LANE_COLUMNS columns of state vectors in their order.
        times_ns: of each of them.
        seen: the columns' last values of what came before; None at the start, where each state counts as new.
        is_robot: whose lanes they are.
    """
    found = []
    for kind in lanes_of(is_robot):
        values = table[kind.column]
        changed = changes(values, None if seen is None else seen[kind.column])
        labels = [kind.label(float(values[index])) for index in changed]
        found.append(Lane(kind.path, times_ns[changed].tolist(), labels))
    return tuple(found)


def changes(values: Array, before: float | None) -> NDArray[np.intp]:
    """Return where `values` differ from the value before; without one, the first counts as a change."""
    first = values[0] - 1.0 if before is None else before
    return np.flatnonzero(np.diff(values, prepend=first) != 0.0)
