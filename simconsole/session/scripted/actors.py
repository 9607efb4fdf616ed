"""The road users of a scenario as traffic: everybody steps at a fixed period, and begins its acts by their triggers."""

from collections.abc import Sequence
from typing import Final, NamedTuple

from simconsole.profiles.traffic import Act, Actor
from simconsole.session.scripted.actor_motion import MovingActor, straight
from simconsole.tick.triggers import TriggerWatch, WatchedVehicle, own_vehicle
from simconsole.values.errors import ProfileError
from simconsole.values.platform import Pose
from simconsole.values.state_vector import Snapshot
from simconsole.values.trigonometry import direction
from simconsole.values.units import RAD_PER_DEG
from simconsole.world.roads.road_map import Array
from simconsole.world.route import Route
from simconsole.world.traffic.road_users import Box, table

PERIOD_S: Final = 0.04
"""From one step of the actors to the next, unless a tick is longer."""
_SAME_M: Final = 0.05  # nearer than this nobody is on either side of the other


class _Waiting(NamedTuple):
    """An act that has not begun."""

    actor: MovingActor
    act: Act
    watch: TriggerWatch


class ScriptedActors:
    """All actors of a scenario: the traffic of its drive, and an output that shows them every tick."""

    def __init__(self, actors: Sequence[Actor], ego: Box, route: Route | None, tick_hz: int, origin: str) -> None:
        """Put everybody in place.

        Args:
            actors: who there is.
            ego: the console's vehicle at the start.
            route: of the world, None where it has none.
            tick_hz: of the drive.
            origin: the scenario's name, which opens an error.

        Raises:
            ProfileError: two have one name, one is named that there is not, or there is no route to begin on.
        """
        self.period_ticks = max(1, round(PERIOD_S * tick_hz))
        self._period_s, self._tick_hz = self.period_ticks / tick_hz, tick_hz
        self._ego = ego
        self._actors: dict[str, MovingActor] = {}
        for number, profile in enumerate(actors, start=1):
            if profile.name in self._actors:
                raise ProfileError(f"{origin}: actors: name: value {profile.name}: another name for each")
            self._actors[profile.name] = _placed(number, profile, ego, route, origin)
        self._waiting = [
            _Waiting(actor, act, TriggerWatch(act, tick_hz, rising=act.rising))
            for actor in self._actors.values()
            for act in actor.profile.acts
        ]
        for one in self._waiting:
            for name in (one.act.of, one.act.to):
                if name is not None and name not in self._actors:
                    raise ProfileError(f"{origin}: actors: value {name}: one of {', '.join(self._actors)}")
        self._every_tick = any(one.act.on_event is not None for one in self._waiting)

    def publish(self, snapshot: Snapshot) -> None:
        """Begin the acts whose triggers have come; called before the step of the same tick."""
        if not self._every_tick and snapshot.tick % self.period_ticks:
            return
        left = []
        for one in self._waiting:
            if snapshot.t_s >= one.act.not_before_s:
                start = one.watch.turn(snapshot.tick, snapshot, self._seen(one.act, snapshot))
                if start is not None and start <= snapshot.tick:
                    one.actor.begin(one.act)
                    continue
            left.append(one)
        self._waiting = left

    def unseen(self, tick: int) -> int:
        """Return how many ticks, from `tick` on, it does not look at."""
        return 0 if self._every_tick else -tick % self.period_ticks

    def step(self, ego: Box | None) -> Array:
        """Move everybody on by a period, and return where they are then."""
        self._ego = ego or self._ego
        for actor in self._actors.values():
            actor.step(self._period_s)
        return self.road_users()

    def road_users(self) -> Array:
        """Return where everybody is, float64 [actors, FIELDS] as `RoadUser`."""
        return table([actor.road_user() for actor in self._actors.values()])

    def push(self, number: float, change_mps: float) -> None:
        """Change the speed of actor `number`, who has collided."""
        list(self._actors.values())[int(number) - 1].crash(change_mps)

    def _seen(self, act: Act, snapshot: Snapshot) -> WatchedVehicle | None:
        """Return whom an act's trigger looks at; None: the console's vehicle and whom it follows."""
        if act.of is None and act.to is None:
            return None
        own = own_vehicle(snapshot)
        one = own if act.of is None else self._actors[act.of].watched()
        if act.of == act.to:
            return one
        here = self._ego if act.of is None else self._actors[act.of].box()
        there = self._ego if act.to is None else self._actors[act.to].box()
        return one._replace(**_gap(here, there, act.bumper_to_bumper))


def _gap(one: Box, other: Box, bumper_to_bumper: bool) -> dict[str, float]:
    """Return the distance of two middles, less half of each length if asked for, and how fast it shrinks."""
    dx, dy = other.x_m - one.x_m, other.y_m - one.y_m
    apart_m = (dx * dx + dy * dy) ** 0.5
    length_m = 0.5 * (one.length_m + other.length_m) if bumper_to_bumper else 0.0
    if apart_m < _SAME_M:
        return {"gap_m": 0.0, "closing_mps": 0.0}
    here, there = direction(one.yaw_rad), direction(other.yaw_rad)
    vx = one.speed_mps * here.cos - other.speed_mps * there.cos
    vy = one.speed_mps * here.sin - other.speed_mps * there.sin
    return {"gap_m": max(0.0, apart_m - length_m), "closing_mps": (vx * dx + vy * dy) / apart_m}


def _placed(number: int, profile: Actor, ego: Box, route: Route | None, origin: str) -> MovingActor:
    if profile.gap_m is None:
        assert profile.x_m is not None
        assert profile.y_m is not None  # as Actor sees to
        start = Pose(profile.x_m, profile.y_m, profile.yaw_deg * RAD_PER_DEG)
        return MovingActor(number, profile, straight(start), 0.0)
    if route is None:
        raise ProfileError(f"{origin}: actors: gap_m: {profile.name}: a world with a route, or x_m and y_m")
    return MovingActor(number, profile, route.at, route.project(ego.x_m, ego.y_m).s_m + profile.gap_m)
