"""What is asked of SUMO, once: from then on it comes with each step."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from simconsole.values.signals import FAR
from simconsole.world.roads.road_map import Array, Phase
from simconsole.world.roads.running import Running
from simconsole.world.sumo_traffic.places import Moved, middles_of
from simconsole.world.traffic.road_users import CAPACITY, FIELDS, RoadUserKind

# Numbers of TraCI's protocol, which both libsumo and traci use (libsumo/TraCIConstants.h): neither is imported here.
OF_VEHICLES: Final = 0xA4
OF_PEOPLE: Final = 0xAE
_POSITION3D: Final = 0x39
_SPEED: Final = 0x40
_ANGLE: Final = 0x43
_LENGTH: Final = 0x44
_VEHICLE_CLASS: Final = 0x49
_WIDTH: Final = 0x4D
_SIGNALS: Final = 0x5B
_HEIGHT: Final = 0xBC
_STATE: Final = 0x20
_PHASE: Final = 0x28
_PROGRAM: Final = 0x29
_NEXT_SWITCH: Final = 0x2D
PERSON_FIELDS: Final = (_POSITION3D, _SPEED, _ANGLE)
VEHICLE_FIELDS: Final = (_POSITION3D, _SPEED, _ANGLE, _LENGTH, _WIDTH, _HEIGHT, _VEHICLE_CLASS, _SIGNALS)
SIGNAL_FIELDS: Final = (_STATE, _PHASE, _PROGRAM, _NEXT_SWITCH)

_PERSON_HEIGHT_M: Final = 1.75
_PERSON_SIZE_M: Final = 0.5
_VAN_M: Final = 5.2  # who is longer is one
_ON_TWO_WHEELS: Final = ("bicycle", "moped", "motorcycle", "scooter")
"""As light as who walks: a collision does to them what it does to people."""
_RIGHT: Final = 1
_LEFT: Final = 2

Found = Mapping[str, Mapping[int, Any]]
"""Results of a subscription: by name, the values of its fields."""


class Numbers:
    """Numbers for SUMO's names: nobody gets that of another."""

    def __init__(self, first: int = 0) -> None:
        """Begin with `first`: smaller ones are taken."""
        self._first = first
        self._numbers: dict[tuple[bool, str], float] = {}
        self._names: dict[float, tuple[bool, str]] = {}

    def of(self, walks: bool, name: str) -> float:
        """Return the number of a vehicle, or of somebody who walks."""
        key = (walks, name)
        number = self._numbers.get(key)
        if number is None:
            number = self._numbers[key] = float(self._first + len(self._numbers))
            self._names[number] = key
        return number

    def name(self, number: float) -> tuple[bool, str]:
        """Return whose it is: whether somebody walks, and SUMO's name."""
        return self._names[number]


def position_of(found: Mapping[int, Any]) -> tuple[float, float]:
    """Return where SUMO has a vehicle: the middle of its front bumper (m)."""
    x, y, _ = found[_POSITION3D]
    return float(x), float(y)


def motion_of(found: Mapping[int, Any]) -> tuple[float, float, float, float]:
    """Return where SUMO has a vehicle (m), the way that it heads (degrees, navigational) and its speed (m/s)."""
    x, y, _ = found[_POSITION3D]
    return x, y, found[_ANGLE], found[_SPEED]


def moved_to(found: Mapping[int, Any], x_m: float, y_m: float, angle_deg: float) -> Mapping[int, Any]:
    """Return a vehicle at another place in SUMO, as high as it is."""
    return {**found, _POSITION3D: (x_m, y_m, found[_POSITION3D][2]), _ANGLE: angle_deg}


def road_users(
    vehicles: Found,
    people: Found,
    numbers: Numbers,
    moved_m: Moved,
    ego: tuple[float, float],
    room: int = CAPACITY,
) -> Array:
    """Return a table of road users, float64 [users, FIELDS]; of more than `room` those nearest to `ego` (SUMO's m)."""
    rows = [_vehicle(numbers.of(False, name), vehicles[name]) for name in sorted(vehicles)]
    on_foot = [name for name in sorted(people) if _POSITION3D in people[name]]  # others have not set out yet
    rows += [_person(numbers.of(True, name), people[name]) for name in on_foot]
    if not rows:
        return np.zeros((0, FIELDS))
    table = np.array(rows)
    if len(table) > room:
        away = np.hypot(table[:, 2] - ego[0], table[:, 3] - ego[1])
        table = table[np.sort(np.argsort(away, kind="stable")[:room])]
    walks = table[:, 1] == RoadUserKind.PEDESTRIAN
    lengths = np.where(walks, 0.0, table[:, 6])  # who walks is where SUMO says, in the middle
    table[:, 2:5] = middles_of(table[:, 2:5], lengths, moved_m)
    return table


def _vehicle(number: float, found: Mapping[int, Any]) -> tuple[float, ...]:
    x, y, z = found[_POSITION3D]
    length_m = found[_LENGTH]
    kind = RoadUserKind.VAN if length_m > _VAN_M else RoadUserKind.CAR
    if found[_VEHICLE_CLASS] in _ON_TWO_WHEELS:
        kind = RoadUserKind.PEDESTRIAN
    signals = found[_SIGNALS]
    turning = (1.0 if signals & _LEFT else 0.0) - (1.0 if signals & _RIGHT else 0.0)
    size = (length_m, found[_WIDTH], found[_HEIGHT])
    return (number, float(kind), x, y, found[_ANGLE], found[_SPEED], *size, z, turning)


def _person(number: float, found: Mapping[int, Any]) -> tuple[float, ...]:
    x, y, z = found[_POSITION3D]
    size = (_PERSON_SIZE_M, _PERSON_SIZE_M, _PERSON_HEIGHT_M)
    return (number, float(RoadUserKind.PEDESTRIAN), x, y, found[_ANGLE], found[_SPEED], *size, z, 0.0)


class SignalReader:
    """SUMO's signals as they run."""

    def __init__(self, sumo: Any, names: list[str], tick_hz: int) -> None:
        """Subscribe to the signals of these names."""
        self._sumo, self._tick_hz = sumo, tick_hz
        self._programs: dict[tuple[str, str], tuple[Phase, ...]] = {}
        self._last: dict[str, tuple[Mapping[int, Any], Running]] = {}
        known = set(sumo.trafficlight.getIDList())
        for name in names:
            if name in known:
                sumo.trafficlight.subscribe(name, SIGNAL_FIELDS)

    def read(self, start_s: float) -> dict[str, Running]:
        """Return what they show after the last step; SUMO's clock stood at `start_s` at tick 0."""
        found: Found = self._sumo.trafficlight.getAllSubscriptionResults()
        return {name: self._running(name, found[name], start_s) for name in sorted(found)}

    def forget(self) -> None:
        """Tell every signal anew: ticks and SUMO's clock have moved apart."""
        self._last.clear()

    def _running(self, name: str, now: Mapping[int, Any], start_s: float) -> Running:
        before = self._last.get(name)
        if before is not None and before[0] == now:
            return before[1]
        key = (name, now[_PROGRAM])
        phases = self._programs.get(key)
        if phases is None:
            phases = self._programs[key] = self._phases(*key)
        switch = round((now[_NEXT_SWITCH] - start_s) * self._tick_hz)
        running = Running(now[_STATE], phases, now[_PHASE], float(switch) if phases else FAR)
        self._last[name] = (dict(now), running)
        return running

    def _phases(self, name: str, program: str) -> tuple[Phase, ...]:
        logics = self._sumo.trafficlight.getAllProgramLogics(name)
        return next(
            (
                tuple(Phase(one.duration, one.state) for one in some.phases)
                for some in logics
                if some.programID == program
            ),
            (),
        )
