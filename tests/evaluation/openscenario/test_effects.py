"""What is understood of an OpenSCENARIO file is driven: each construct by what it changes on the road."""

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
import pytest

from simconsole.evaluation.openscenario.importing import imported
from simconsole.session.scripted.actors import ScriptedActors
from simconsole.values.signals import Mode
from simconsole.world.traffic.road_users import Box, RoadUser
from tests.evaluation.in_memory import drive_scenario
from tests.evaluation.openscenario.files import UNDERSTOOD

X, Y, YAW, SPEED = (RoadUser._fields.index(name) for name in ("x_m", "y_m", "yaw_rad", "speed_mps"))
TICK_HZ, PERIOD_S = 250, 0.04
AHEAD_M: Final = 1.4  # of the middle from the point that a file places


class Seen(NamedTuple):
    """A drive: the actor's rows every 0.04 s from 0.04 s on, and the vehicle's columns at every tick."""

    lead: np.ndarray
    column: Callable[[str], np.ndarray]

    def at(self, t_s: float, field: int) -> float:
        """Where or how fast the actor is then."""
        return float(self.lead[round(t_s / PERIOD_S) - 1, field])

    def brakes_at_s(self) -> float:
        """When it begins to lose speed."""
        return PERIOD_S * float(np.flatnonzero(self.lead[:, SPEED] < self.lead[0, SPEED] - 1e-6)[0])

    def own(self, t_s: float, name: str) -> float:
        """What a column of the vehicle is then."""
        return float(self.column(name)[round(t_s * TICK_HZ) - 1])


def driven(content: bytes, monkeypatch: pytest.MonkeyPatch) -> Seen:
    rows: list[np.ndarray] = []
    step = ScriptedActors.step

    def kept(self: ScriptedActors, ego: Box | None) -> np.ndarray:
        users = step(self, ego)
        rows.append(users[0].copy())
        return users

    monkeypatch.setattr(ScriptedActors, "step", kept)
    recorder, columns = drive_scenario(imported(content, "made.xosc").profile)
    return Seen(np.array(rows), lambda name: recorder.vectors[:, columns.index(name)])


def slows(seen: Seen) -> bool:
    """From 8 m/s at 4 s linearly to none at 8 s."""
    speeds = [seen.at(t_s, SPEED) for t_s in (3.9, 6.0, 8.2)]
    return speeds == [pytest.approx(8.0), pytest.approx(4.0, abs=0.2), pytest.approx(0.0, abs=1e-9)]


def is_then(name: str, value: float, within: float) -> Callable[[Seen], bool]:
    """A column of the vehicle has that value when the actor begins to brake."""
    return lambda seen: seen.own(seen.brakes_at_s(), name) == pytest.approx(value, abs=within)


def reaches(field: int, *places: tuple[float, float]) -> Callable[[Seen], bool]:
    """The actor is so at these times."""
    return lambda seen: [seen.at(t_s, field) for t_s, _ in places] == [pytest.approx(to, abs=0.1) for _, to in places]


def modes(*wanted: tuple[float, Mode]) -> Callable[[Seen], bool]:
    return lambda seen: [seen.own(t_s, "arbitration.mode") for t_s, _ in wanted] == [mode for _, mode in wanted]


END: Final = (80.0 + AHEAD_M * math.cos(0.5), 6.0 + AHEAD_M * math.sin(0.5))
SLOW: Final = ("a distance", "headway", "time to collision", "a cartesian distance", "a condition that holds at once")
"""Files of which the drive needs a slower actor, that the vehicle comes near."""

EFFECTS: Final[dict[str, Callable[[Seen], bool]]] = {
    "nothing happens": lambda seen: seen.at(12.0, SPEED) == 8.0 and seen.own(8.0, "vehicle.vx_mps") > 9.0,
    "van": slows,
    "truck": slows,
    "pedestrian": slows,
    "several events": slows,
    "heading": lambda seen: slows(seen) and seen.at(1.0, YAW) == pytest.approx(1.2) and seen.at(3.0, Y) > 10.0,
    "speed in a step": reaches(SPEED, (3.9, 8.0), (4.2, 3.0), (12.0, 3.0)),
    "speed by time": slows,
    "speed by rate": reaches(SPEED, (3.9, 8.0), (5.5, 0.0)),
    "lane change": reaches(Y, (3.9, 0.0), (8.2, 3.5), (12.0, 3.5)),
    "lane change to the right": reaches(Y, (3.9, 0.0), (8.2, -3.5), (12.0, -3.5)),
    "lane offset": reaches(Y, (3.9, 0.0), (7.2, 0.5), (12.0, 0.5)),
    "trajectory": lambda seen: (
        reaches(X, (5.96, 60.0 + AHEAD_M), (7.96, END[0]))(seen) and reaches(Y, (5.96, 0.0), (7.96, END[1]))(seen)
    ),
    "own speed": is_then("vehicle.vx_mps", 5.0, 0.3),
    "own way": lambda seen: seen.own(seen.brakes_at_s() - 1.0, "vehicle.distance_m") == pytest.approx(30.0, abs=1.0),
    "a place": lambda seen: seen.at(seen.brakes_at_s(), X) == pytest.approx(66.0, abs=0.7),
    "a place by distance": lambda seen: seen.at(seen.brakes_at_s(), X) == pytest.approx(66.0, abs=0.7),
    "a distance": is_then("ahead.lead_gap_m", 15.0, 1.0),
    "a cartesian distance": is_then("ahead.lead_gap_m", 15.0, 1.0),
    "headway": lambda seen: seen.brakes_at_s() > 1.0,
    "time to collision": lambda seen: seen.brakes_at_s() > 1.0,
    "a condition that holds at once": lambda seen: seen.brakes_at_s() > 1.0,
    "a later act": lambda seen: (
        seen.brakes_at_s() == pytest.approx(5.0, abs=0.1) and seen.own(5.0, "vehicle.vx_mps") > 5.0
    ),
    "a condition and a time": lambda seen: (
        seen.brakes_at_s() >= 3.0 and seen.own(seen.brakes_at_s(), "vehicle.vx_mps") > 4.9
    ),
    "a controller": lambda seen: seen.at(12.0, SPEED) == 8.0,
    "a controller that is switched on": modes((3.9, Mode.PARKED), (4.2, Mode.AUTONOMOUS)),
}
"""By the name of a file: whether its drive shows what it says."""


@pytest.mark.parametrize("name", UNDERSTOOD)
def test_what_is_understood_is_seen_in_the_drive(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    content = UNDERSTOOD[name]()
    if name in SLOW:
        content = content.replace(b'AbsoluteTargetSpeed value="8.0"', b'AbsoluteTargetSpeed value="2.0"')
        assert content != UNDERSTOOD[name]()
    if name == "a later act":  # by an edge it would never come: the speed has risen before the act begins
        content = content.replace(b'conditionEdge="rising"', b'conditionEdge="none"')
    seen = driven(content, monkeypatch)
    assert EFFECTS[name](seen), (seen.lead[::25, [X, Y, SPEED]], seen.column("arbitration.mode")[::250])
