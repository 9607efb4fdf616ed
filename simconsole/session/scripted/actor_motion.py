"""How one actor of a scenario moves: along its path, beside it, or on a trajectory. Looks at nobody."""

from collections.abc import Callable
from typing import Final, NamedTuple, Protocol

from simconsole.profiles.traffic import Act, Actor, Vertex
from simconsole.tick.triggers import WatchedVehicle
from simconsole.values.kernels import approach
from simconsole.values.platform import Pose
from simconsole.values.signals import FAR
from simconsole.values.trigonometry import atan2, direction, wrap_angle
from simconsole.values.units import MPS_PER_KMH, RAD_PER_DEG
from simconsole.world.traffic.road_users import Box, RoadUser, RoadUserKind

BRAKED_MPS2: Final = 4.0
"""How somebody who has collided comes to rest."""
SHIFT_S: Final = 3.0
"""How long a change of lane takes that does not say."""
SIZES_M: Final = {"car": (4.5, 1.8, 1.5), "van": (5.5, 2.0, 2.2), "pedestrian": (0.4, 0.5, 1.75)}
"""Length, width and height of each kind."""
_CREEP_MPS: Final = 0.5  # below it, nobody turns for a change of lane


class PathPlace(Protocol):
    """A place of a path: the way's direction at it."""

    @property
    def x_m(self) -> float:
        """In map."""

    @property
    def y_m(self) -> float:
        """In map."""

    @property
    def yaw_rad(self) -> float:
        """Of the path."""


PathAt = Callable[[float], PathPlace]
"""A path: its place after so many m."""


class _Shift(NamedTuple):
    """A move to another place beside the path."""

    from_m: float
    by_m: float
    begin_s: float
    over_s: float

    def at(self, time_s: float) -> tuple[float, float]:
        """Return how far left of the path, in m, and how fast to the left, in m/s."""
        part = min(max((time_s - self.begin_s) / self.over_s, 0.0), 1.0)
        return self.from_m + self.by_m * part * part * (3.0 - 2.0 * part), (
            self.by_m * 6.0 * part * (1.0 - part) / self.over_s
        )


class MovingActor:
    """One actor at work.

    Attributes:
        profile: what it is.
        pose: of its middle, in map.
        speed_mps: along its way.
        distance_m: it has gone since the start.
    """

    def __init__(self, number: int, profile: Actor, path: PathAt, at_m: float) -> None:
        """Begin `at_m` on `path`."""
        self.profile = profile
        self.length_m, self.width_m, self.height_m = (
            default if given is None else given
            for given, default in zip(
                (profile.length_m, profile.width_m, profile.height_m), SIZES_M[profile.kind], strict=True
            )
        )
        self._number, self._path, self._s_m = number, path, at_m
        self._goal_mps = self.speed_mps = profile.speed_kmh * MPS_PER_KMH
        self._accel_mps2 = 3.0
        self._shift = _Shift(profile.lateral_m, 0.0, 0.0, 1.0)
        self._time_s = self.distance_m = 0.0
        self._trajectory: tuple[tuple[Vertex, ...], float] | None = None
        self._crashed = False
        self.pose = self._beside()

    def begin(self, act: Act) -> None:
        """Begin an act; who has collided does nothing any more."""
        if self._crashed:
            return
        if act.trajectory:
            self._trajectory = act.trajectory, self._time_s
        elif act.speed_kmh is not None:
            self._goal_mps, self._accel_mps2 = act.speed_kmh * MPS_PER_KMH, act.accel_mps2
            if act.over_s is not None:
                self._accel_mps2 = abs(self._goal_mps - self.speed_mps) / act.over_s
        elif act.lateral_m is not None:
            now_m, _ = self._shift.at(self._time_s)
            by_m = act.lateral_m if act.relative else act.lateral_m - now_m
            self._shift = _Shift(now_m, by_m, self._time_s, act.over_s or SHIFT_S)

    def crash(self, change_mps: float) -> None:
        """Change its speed by a collision; a vehicle comes to rest, a person falls where they are."""
        self.speed_mps = 0.0 if self.profile.kind == "pedestrian" else max(0.0, self.speed_mps + change_mps)
        self._leave_trajectory()
        self._goal_mps, self._accel_mps2, self._crashed = 0.0, BRAKED_MPS2, True

    def step(self, period_s: float) -> None:
        """Move on by a period."""
        self._time_s += period_s
        if self._trajectory is not None and self._follow(*self._trajectory):
            self.distance_m += self.speed_mps * period_s
            return
        slower = self.speed_mps
        self.speed_mps = approach(slower, self._goal_mps, self._accel_mps2 * period_s)
        moved_m = 0.5 * (slower + self.speed_mps) * period_s
        self._s_m += moved_m
        self.distance_m += moved_m
        self.pose = self._beside()

    def watched(self) -> WatchedVehicle:
        """Return it as a trigger looks at it, without a gap."""
        return WatchedVehicle(
            x_m=self.pose.x_m,
            y_m=self.pose.y_m,
            distance_m=self.distance_m,
            speed_mps=self.speed_mps,
            gap_m=FAR,
            closing_mps=0.0,
        )

    def box(self) -> Box:
        """Return its footprint."""
        return Box(*self.pose, speed_mps=self.speed_mps, length_m=self.length_m, width_m=self.width_m)

    def road_user(self) -> RoadUser:
        """Return it as everybody sees it."""
        return RoadUser(
            id=float(self._number),
            kind=float(RoadUserKind[self.profile.kind.upper()]),
            x_m=self.pose.x_m,
            y_m=self.pose.y_m,
            yaw_rad=self.pose.yaw_rad,
            speed_mps=self.speed_mps,
            length_m=self.length_m,
            width_m=self.width_m,
            height_m=self.height_m,
        )

    def _beside(self) -> Pose:
        place = self._path(self._s_m)
        left_m, left_mps = self._shift.at(self._time_s)
        way = direction(place.yaw_rad)
        turned = atan2(left_mps, self.speed_mps) if self.speed_mps > _CREEP_MPS else 0.0
        return Pose(place.x_m - left_m * way.sin, place.y_m + left_m * way.cos, wrap_angle(place.yaw_rad + turned))

    def _follow(self, vertices: tuple[Vertex, ...], began_s: float) -> bool:
        """Move along a trajectory with the speed of its segment; False once it has ended: then it goes straight on.

        It may begin elsewhere than where the actor is: nobody drives that jump.
        """
        time_s = self._time_s - began_s
        if time_s < vertices[0].time_s:
            return False
        after = next((at for at, vertex in enumerate(vertices) if vertex.time_s > time_s), None)
        if after is None:
            self._leave_trajectory()
            return False
        one, two = vertices[after - 1], vertices[after]
        part = (time_s - one.time_s) / (two.time_s - one.time_s)
        dx, dy = two.x_m - one.x_m, two.y_m - one.y_m
        self.speed_mps = self._goal_mps = (dx * dx + dy * dy) ** 0.5 / (two.time_s - one.time_s)
        yaw_rad = self.pose.yaw_rad if dx == 0.0 == dy else atan2(dy, dx)
        if one.yaw_deg is not None:
            yaw_rad = one.yaw_deg * RAD_PER_DEG
            if two.yaw_deg is not None:
                yaw_rad += part * wrap_angle(two.yaw_deg * RAD_PER_DEG - yaw_rad)
        self.pose = Pose(one.x_m + part * dx, one.y_m + part * dy, wrap_angle(yaw_rad))
        return True

    def _leave_trajectory(self) -> None:
        """Go straight on from where it is, with the speed it has."""
        if self._trajectory is None:
            return
        self._trajectory, self._path, self._s_m = None, straight(self.pose), 0.0
        self._shift = _Shift(0.0, 0.0, self._time_s, 1.0)


def straight(start: Pose) -> PathAt:
    """Return the path straight on from a pose."""
    way = direction(start.yaw_rad)
    return lambda s_m: Pose(start.x_m + s_m * way.cos, start.y_m + s_m * way.sin, start.yaw_rad)
