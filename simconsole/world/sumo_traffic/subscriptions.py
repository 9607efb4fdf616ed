"""What is asked of SUMO, once: from then on it comes with each step."""

from collections.abc import Mapping
from itertools import chain
from typing import Any, Final, NamedTuple

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
_TYPE: Final = 0x4F
_SIGNALS: Final = 0x5B
_STATE: Final = 0x20
_PHASE: Final = 0x28
_PROGRAM: Final = 0x29
_NEXT_SWITCH: Final = 0x2D
PERSON_FIELDS: Final = (_POSITION3D, _SPEED, _ANGLE)
VEHICLE_FIELDS: Final = (_POSITION3D, _SPEED, _ANGLE, _TYPE, _SIGNALS)
SIGNAL_FIELDS: Final = (_STATE, _PHASE, _PROGRAM, _NEXT_SWITCH)

_PERSON_HEIGHT_M: Final = 1.75
_PERSON_SIZE_M: Final = 0.5
_VAN_M: Final = 5.2  # who is longer is one
_ON_TWO_WHEELS: Final = ("bicycle", "moped", "motorcycle", "scooter")
"""As light as who walks: a collision does to them what it does to people."""
PLACE: Final = slice(2, 5)
"""Columns of where somebody is and looks."""
MOTION: Final = slice(2, 6)
"""And how fast they are."""
LENGTH: Final = 6
_INDICATORS: Final = 10
_ORDER: Final = [0, 1, 5, 6, 8, 9, 2, 3, 4, 7, 10]
"""Where the columns are in what a `VehicleReader` collects: number, kind, size, place, angle, speed, lamps."""
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


class _Kind(NamedTuple):
    """What is the same for all vehicles of a type."""

    kind: float
    length_m: float
    width_m: float
    height_m: float


def position_of(found: Mapping[int, Any]) -> tuple[float, float]:
    """Return where SUMO has a vehicle: the middle of its front bumper (m)."""
    x, y, _ = found[_POSITION3D]
    return float(x), float(y)


class VehicleReader:
    """Vehicles as tables. What stays as it is, of a vehicle and of a type, is looked up once."""

    def __init__(self, sumo: Any, numbers: Numbers) -> None:
        """Ask the domain `vehicletype` of this SUMO for what is behind the name of a type."""
        self._types, self._numbers = sumo.vehicletype, numbers
        self._kinds: dict[str, _Kind] = {}
        self._known: dict[str, tuple[float, ...]] = {}  # number, then its _Kind

    def rows(self, vehicles: Found) -> Array:
        """Return vehicles in the columns of `RoadUser`, float64 [vehicles, FIELDS], but for their places: SUMO's.

        `PLACE` has the middle of the front bumper (m) and a navigational angle (degrees) of each.
        """
        for name in sorted(vehicles.keys() - self._known.keys()):
            self._known[name] = (self._numbers.of(False, name), *self._kind(vehicles[name][_TYPE]))
        known = self._known
        told = [
            (*known[name], *found[_POSITION3D], found[_ANGLE], found[_SPEED], found[_SIGNALS])
            for name, found in vehicles.items()
        ]
        rows = np.fromiter(chain.from_iterable(told), np.float64, FIELDS * len(told)).reshape(-1, FIELDS)[:, _ORDER]
        lamps = rows[:, _INDICATORS].astype(np.int64)
        rows[:, _INDICATORS] = np.sign(lamps & _LEFT) - np.sign(lamps & _RIGHT)
        return rows

    def _kind(self, name: str) -> _Kind:
        kind = self._kinds.get(name)
        if kind is None:
            length_m = self._types.getLength(name)
            what = RoadUserKind.VAN if length_m > _VAN_M else RoadUserKind.CAR
            if self._types.getVehicleClass(name) in _ON_TWO_WHEELS:
                what = RoadUserKind.PEDESTRIAN
            size = (length_m, self._types.getWidth(name), self._types.getHeight(name))
            kind = self._kinds[name] = _Kind(float(what), *size)
        return kind


def people_rows(people: Found, numbers: Numbers) -> Array:
    """Return those on foot likewise, float64 [people, FIELDS], by their middles; who has not set out is left out."""
    there = [(name, found) for name, found in sorted(people.items()) if _POSITION3D in found]
    return np.array([_person(numbers.of(True, name), found) for name, found in there]).reshape(-1, FIELDS)


def road_users(vehicles: Array, people: Array, moved_m: Moved, ego: tuple[float, float], room: int = CAPACITY) -> Array:
    """Return rows as road users, float64 [users, FIELDS]; of more than `room` those nearest to `ego` (SUMO's m)."""
    table = np.concatenate((vehicles, people))
    from_bumper_m = np.concatenate((vehicles[:, LENGTH], np.zeros(len(people))))
    if len(table) > room:
        away = np.hypot(table[:, 2] - ego[0], table[:, 3] - ego[1])
        nearest = np.sort(np.argsort(away, kind="stable")[:room])
        table, from_bumper_m = table[nearest], from_bumper_m[nearest]
    table[:, PLACE] = middles_of(table[:, PLACE], from_bumper_m, moved_m)
    return table


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
        self._found: Found = {}
        self._now: dict[str, Running] = {}
        known = set(sumo.trafficlight.getIDList())
        for name in names:
            if name in known:
                sumo.trafficlight.subscribe(name, SIGNAL_FIELDS)

    def read(self, start_s: float) -> dict[str, Running]:
        """Return what they show after the last step; SUMO's clock stood at `start_s` at tick 0."""
        found: Found = self._sumo.trafficlight.getAllSubscriptionResults()
        if found != self._found:
            self._now = {name: self._running(name, found[name], start_s) for name in sorted(found)}
            self._found = {name: dict(values) for name, values in found.items()}  # traci goes on with its own
        return self._now

    def forget(self) -> None:
        """Tell every signal anew: ticks and SUMO's clock have moved apart."""
        self._found = {}

    def _running(self, name: str, now: Mapping[int, Any], start_s: float) -> Running:
        if self._found.get(name) == now:
            return self._now[name]
        key = (name, now[_PROGRAM])
        phases = self._programs.get(key)
        if phases is None:
            phases = self._programs[key] = self._phases(*key)
        switch = round((now[_NEXT_SWITCH] - start_s) * self._tick_hz)
        return Running(now[_STATE], phases, now[_PHASE], float(switch) if phases else FAR)

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
