"""The route of a course: a lane, with what stands along it."""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from simconsole.profiles.world import CourseProfile, Primitive, Roundabout
from simconsole.values.platform import Pose
from simconsole.values.units import MPS_PER_KMH
from simconsole.world.path_geometry import Piece, travel
from simconsole.world.route import Landmark, Route, Stretch, Turn

_MET_M: Final = 1e-3
_MET_RAD: Final = 1e-6


class Course(Route):
    """A route as its profile (`world`) has it."""

    def __init__(self, world: CourseProfile) -> None:
        self.world = world
        limit = world.speed_limit_kmh * MPS_PER_KMH
        super().__init__(
            [Stretch(part.s_m, _pose(part), _piece(part), limit) for part in world.path],
            closed=_meet(world),
        )
        self.landmarks = tuple(self._landmarks())
        self.turns = tuple(self._roundabout(ring) for ring in world.roundabouts)

    def _landmarks(self) -> Iterator[Landmark]:
        half = 0.5 * self.world.lane_width_m
        for crossing in self.world.crossings:
            yield self._across("crossing", crossing.s_m, -3.0 * half, 5.0 * half)
        for spot in self.world.intersections:
            kind = "traffic lights" if spot.signalled else "side road"
            yield self._across(kind, spot.s_m, half - spot.arm_m, half + spot.arm_m)
        for ring in self.world.roundabouts:
            yield Landmark("roundabout", ring.s_m, ring.x_m, ring.y_m)

    def _roundabout(self, ring: Roundabout) -> Turn:
        """Return the turn at a roundabout, whose roads stand at right angles and which is driven leftwards."""
        stations = np.arange(ring.s_m, ring.end_s_m, 0.5)
        places = [self.at(s) for s in stations.tolist()]
        away = np.array([math.hypot(at.x_m - ring.x_m, at.y_m - ring.y_m) for at in places])
        inside = stations[away < ring.radius_m + self.world.lane_width_m]
        turned = math.remainder(self.at(ring.end_s_m).yaw_rad - self.at(ring.s_m).yaw_rad, math.tau)
        return Turn(
            s_m=float(inside[0]),
            end_s_m=float(inside[-1]),
            angle_rad=turned,
            exit=1 + round((turned + 0.5 * math.pi) / (0.5 * math.pi)) % 4,
        )

    def _across(self, kind: str, s_m: float, right_m: float, left_m: float) -> Landmark:
        here = self.at(s_m)
        ends = [tuple(self.offset(side, s_m, s_m + 0.1)[0].tolist()) for side in (right_m, left_m)]
        return Landmark(kind, s_m, here.x_m, here.y_m, tuple(ends))


def _meet(world: CourseProfile) -> bool:
    start, last = _pose(world.path[0]), world.path[-1]
    end = travel(_pose(last), _piece(last))
    turned_rad = math.remainder(end.yaw_rad - start.yaw_rad, math.tau)
    return math.hypot(end.x_m - start.x_m, end.y_m - start.y_m) < _MET_M and abs(turned_rad) < _MET_RAD


def _pose(part: Primitive) -> Pose:
    return Pose(part.x_m, part.y_m, part.yaw_rad)


def _piece(part: Primitive) -> Piece:
    return Piece(part.length_m, part.curvature_start_1pm, part.curvature_end_1pm)
