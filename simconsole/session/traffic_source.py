"""Traffic as a source: stepped every fixed number of ticks, its result recorded as an input and shown to everybody."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol, runtime_checkable

from simconsole.profiles.files.world_files import read_map
from simconsole.profiles.traffic import TrafficProfile
from simconsole.profiles.world import RoadsProfile
from simconsole.recording.log_header import ROAD_USERS, SIGNALS
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import compiled
from simconsole.values.latency import Hop
from simconsole.values.platform import Platform
from simconsole.values.signals import FAR, AheadInput, ImpactInput, VehicleState
from simconsole.values.state_vector import LAYOUT, Snapshot
from simconsole.values.trigonometry import direction
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_map import Array
from simconsole.world.roads.road_world import Roads, roads_of
from simconsole.world.roads.running import NONE_RUNNING
from simconsole.world.route import Route
from simconsole.world.rules.approaches import Ahead, ahead_of_lanes
from simconsole.world.rules.owing import Owing
from simconsole.world.rules.road_rules import APPROACH, RoadRules
from simconsole.world.rules.running_signals import RunningSignals
from simconsole.world.traffic.crashes import NO_CRASH, Crashes
from simconsole.world.traffic.impact import Moving
from simconsole.world.traffic.leader import Leaders
from simconsole.world.traffic.road_users import Box, RoadUser, RoadUsersAt, to_bytes
from simconsole.world.traffic.traffic import Traffic

if TYPE_CHECKING:
    from simconsole.session.sumo.sumo_port import SumoPort
    from simconsole.world.sumo_traffic.sumo_traffic import SumoTraffic

_LANE_AT: Final = LAYOUT.situation.at("lane")

ShowRoadUsers = Callable[[RoadUsersAt], None]


class Stepped(Protocol):
    """Whoever moves all road users but the ego, in steps: built-in traffic, or another simulator."""

    def road_users(self) -> Array:
        """Return where everybody is, float64 [users, FIELDS] as `RoadUser`."""

    def step(self, ego: Box | None) -> Array:
        """Move everybody on by a period, with the ego where it is, and return where they are then."""

    def push(self, number: float, change_mps: float) -> None:
        """Change the speed of road user `number`, who has collided and from now on only comes to rest."""


@runtime_checkable
class Closing(Protocol):
    """Traffic that another simulator moves."""

    ego_error_m: float  # by which the ego was elsewhere than it was put, at most

    def close(self) -> None:
        """End it, or this drive's part in it."""


@runtime_checkable
class Awaited(Protocol):
    """Traffic that is moved in a process of its own."""

    late_steps: int  # in which it had not answered yet: everybody stayed where they were

    def road_users(self) -> Array:
        """Return where everybody is."""

    def wait(self, alive: Callable[[], bool]) -> None:
        """Wait until it has begun."""


class OtherSignals(NamedTuple):
    """The signals of a map that another simulator runs, as inputs of the tick."""

    running: RunningSignals
    ahead: Sequence[Ahead | None]  # what lies ahead of each lane of the map
    rules: RoadRules

    def seen(self, lane: int) -> tuple[float, float, float]:
        """Return the last fields of `AheadInput` for a vehicle on a lane of the map, -1: on none."""
        ahead = self.ahead[lane] if lane >= 0 else None
        if not self.running.now:  # it has not said anything yet, or no more: the map's own programs
            return 0.0, 0.0, FAR
        if ahead is None:
            return -1.0, 0.0, FAR
        shown = self.running.of(ahead.approach)
        return float(self.rules.lanes[lane, APPROACH]) + 1.0, float(shown.state), shown.change_tick


class TrafficSource:
    """Traffic in the drive loop: an output that sees where the vehicle is, and a source of what the log keeps.

    What a step after tick N brings lies in the log's frame of tick N + 1, the first tick that could know of it.
    """

    hop = Hop.OTHERS

    def __init__(
        self,
        traffic: Stepped,
        platform: Platform,
        period_ticks: int,
        route: Route | None = None,
        owing: Owing | None = None,
        signals: OtherSignals | None = None,
        moves: Callable[[RoadUser], Moving] | None = None,
    ) -> None:
        """Take what the vehicle follows as `route`; without one it goes straight on, and `owing` tells nothing.

        `signals` are those that the traffic brings with it; None: they run their own programs. `moves` as of `Crashes`.
        """
        self._traffic, self._signals = traffic, signals
        self._leaders, self._crashes = Leaders(route, compiled), Crashes(platform.solid, compiled, moves)
        self._platform = platform
        self._period_ticks = period_ticks
        self._owing = owing
        self._newest = self._of(0, traffic.road_users())
        ego = ego_box(platform.initial_vehicle, platform)
        self._ahead = self._look(ego, 0, -1)
        # The search is compiled here, and not in the drive: a controller gives up a console that is silent for seconds.
        self._crashes.step(platform.initial_vehicle, ego, self._newest.users[:0])
        self._fresh = True
        self._crash = NO_CRASH
        self._shown: list[ShowRoadUsers] = []
        self.collisions = 0

    def show_to(self, show: ShowRoadUsers) -> None:
        """Show each step's result from here on, and what there is now."""
        self._shown.append(show)
        show(self._newest)

    def await_worker(self, alive: Callable[[], bool]) -> None:
        """Wait until those who move the road users in another process have begun. Raises as `SumoPort.wait`."""
        if isinstance(self._traffic, Awaited):
            self._traffic.wait(alive)
            self._newest = self._of(0, self._traffic.road_users())
            self._ahead = self._look(ego_box(self._platform.initial_vehicle, self._platform), 0, -1)
            for show in self._shown:
                show(self._newest)

    def newest(self) -> RoadUsersAt:
        """Return the newest result."""
        return self._newest

    def publish(self, snapshot: Snapshot) -> None:
        """Step, if a period has ended with this tick."""
        if snapshot.tick % self._period_ticks == 0:
            vehicle = snapshot.vehicle
            self._look_around(snapshot, vehicle, ego_box(vehicle, self._platform))

    def _look_around(self, snapshot: Snapshot, vehicle: VehicleState, ego: Box) -> None:
        """Step, with the vehicle in this state and its footprint there."""
        self._newest = self._of(snapshot.tick, self._traffic.step(ego))
        self._fresh = True
        self._ahead = self._look(ego, snapshot.tick, int(snapshot.vector[_LANE_AT]))
        self._crash = self._crashes.step(vehicle, ego, self._newest.users)
        self.collisions += len(self._crash.new)
        for number, change_mps in self._crash.pushed:
            self._traffic.push(number, change_mps)
        for show in self._shown:
            show(self._newest)

    def ahead(self) -> AheadInput:
        """Return whom the vehicle follows and lets pass, as of the last step."""
        return self._ahead

    def _of(self, tick: int, users: Array) -> RoadUsersAt:
        """Return a step's result, with the signals that came with it."""
        if self._signals is None:
            return RoadUsersAt(tick, users)
        if self.lost() is not None:
            self._signals.running.take(NONE_RUNNING)
        return RoadUsersAt(tick, users, self._signals.running.now)

    def _look(self, ego: Box, tick: int, lane: int) -> AheadInput:
        found = self._leaders.find(ego, self._newest.users)
        if self._owing is not None:
            owed = self._owing.owed(ego, self._newest.users, tick)
            found = AheadInput(found.lead_gap_m, found.lead_speed_mps, owed.yield_m, owed.yield_s)
        if self.lost() is not None:
            return found._replace(traffic_lost=1.0)
        if self._signals is None:
            return found
        approach, state, change_tick = self._signals.seen(lane)
        return found._replace(approach=approach, signal_state=state, signal_tick=change_tick)

    def unseen(self, tick: int) -> int:
        """Return how many ticks, from `tick` on, do not end a period."""
        return -tick % self._period_ticks

    def take_messages(self, tick: int) -> list[tuple[str, bytes]]:
        """Return the newest road users and the signals that have changed, if nobody has taken them yet."""
        if not self._fresh:
            return []
        self._fresh = False
        changed = None if self._signals is None else self._signals.running.changed()
        messages = [(ROAD_USERS, to_bytes(self._newest.users))]
        return messages if changed is None else [*messages, (SIGNALS, changed)]

    def signals(self) -> RunningSignals | None:
        """Return the signals that the traffic brings with it; None: they run their own programs."""
        return None if self._signals is None else self._signals.running

    def lost(self) -> str | None:
        """Return why there is no traffic any more, None as long as there is."""
        return getattr(self._traffic, "lost", None)

    def close(self) -> None:
        """End another simulator that moves the road users."""
        if isinstance(self._traffic, Closing):
            self._traffic.close()

    def take_impact(self) -> ImpactInput:
        """Return what a collision of the last step has done to the vehicle, once."""
        impact, self._crash = self._crash.impact, NO_CRASH
        return impact

    def summary(self) -> dict[str, Any]:
        """Return what the drive's summary says of traffic."""
        lost = {} if self.lost() is None else {"lost": self.lost()}
        error = {"ego_error_m": self._traffic.ego_error_m} if isinstance(self._traffic, Closing) else {}
        late = {"late_steps": self._traffic.late_steps} if isinstance(self._traffic, Awaited) else {}
        told = {"road_users": len(self._newest.users), "collisions": self.collisions, **error, **late, **lost}
        return {"traffic": told}


def open_traffic(resolved: ResolvedSession, console: Console, run_folder: Path | None = None) -> TrafficSource | None:
    """Return the traffic of a session, None where it has none.

    SUMO runs in this process, or beside it as the profile says; in a drive with a `run_folder` in a worker.

    Raises:
        ProfileError: its world is no road map, or its period no whole number of ticks.
    """
    profile = resolved.session.environment.traffic
    if profile is None:
        return None
    roads_profile, period_ticks = roads_and_period(resolved, profile, console.tick_hz)
    platform, world = console.platform, open_world(roads_profile)
    route, roads = world.route, roads_of(world)
    assert roads is not None, "a road map has roads"
    if profile.sumo is not None:
        sumo = _sumo(resolved, profile, console, roads, run_folder)
        owing = Owing(roads.road_map, roads.legs, route, console.tick_hz, sumo.signals.state)
        return TrafficSource(sumo, platform, period_ticks, route, owing, signals_of(roads, console, sumo.signals))
    traffic = Traffic(
        roads.road_map,
        profile,
        compiled,
        route=route,
        ego=ego_box(platform.initial_vehicle, platform),
        ground=world.ground,
    )
    owing = Owing(roads.road_map, roads.legs, route, console.tick_hz)
    return TrafficSource(traffic, platform, period_ticks, route, owing)


def _sumo(
    resolved: ResolvedSession, profile: TrafficProfile, console: Console, roads: Roads, run_folder: Path | None
) -> "SumoPort | SumoTraffic":
    """Return SUMO round one vehicle; raises ProfileError where it is missing or refuses."""
    from simconsole.session.sumo.sumo_port import SumoPort

    ego = ego_box(console.platform.initial_vehicle, console.platform)
    if run_folder is None:
        return sumo_beside(resolved, profile, console.tick_hz, (ego,))
    return SumoPort(profile, roads.road_map, console.tick_hz, run_folder, ego)


def roads_and_period(resolved: ResolvedSession, profile: TrafficProfile, tick_hz: int) -> tuple[RoadsProfile, int]:
    """Return the roads of a session with traffic, and how many ticks lie between two steps of it.

    Raises:
        ProfileError: its world is no road map, or its period no whole number of ticks.
    """
    if not isinstance(resolved.world, RoadsProfile):
        raise ProfileError("environment.traffic: needs an environment.world that is a road map (kind: roads)")
    if profile.period_ms * tick_hz % 1000:
        raise ProfileError(
            f"environment.traffic.period_ms: value {profile.period_ms}: a whole number of ticks"
            f" of {1000.0 / tick_hz:g} ms"
        )
    return resolved.world, profile.period_ms * tick_hz // 1000


def sumo_beside(
    resolved: ResolvedSession, profile: TrafficProfile, tick_hz: int, egos: tuple[Box, ...]
) -> "SumoTraffic":
    """Start SUMO in this process, or beside it as the profile says, with our vehicles where they start.

    Raises:
        ProfileError: SUMO is missing, or refuses.
    """
    from simconsole.world.sumo_traffic.sumo_traffic import SumoTraffic, Surroundings

    assert isinstance(resolved.world, RoadsProfile)
    world = open_world(resolved.world)
    roads = roads_of(world)
    assert roads is not None, "a road map has roads"
    around = Surroundings(
        road_map=roads.road_map,
        net=read_map(resolved.world.map),
        legs=roads.legs,
        tick_hz=tick_hz,
        egos=egos,
        duration_s=resolved.session.scenario.duration_s,
        ground=world.ground,
    )
    return SumoTraffic(profile, around)


def signals_of(roads: Roads, console: Console, shown: RunningSignals) -> OtherSignals:
    """Return the signals that SUMO runs on roads, as the tick of a console knows of them."""
    assert console.roads is not None  # such a world has rules
    return OtherSignals(shown, ahead_of_lanes(roads.road_map, roads.legs), console.roads)


def ego_box(vehicle: VehicleState, platform: Platform) -> Box:
    """Return the footprint of the console's vehicle: base_link is `rear_overhang_m` from its rear end."""
    heading = direction(vehicle.yaw_rad)
    ahead_m = 0.5 * platform.length_m - platform.rear_overhang_m
    return Box(
        x_m=vehicle.x_m + ahead_m * heading.cos,
        y_m=vehicle.y_m + ahead_m * heading.sin,
        yaw_rad=vehicle.yaw_rad,
        speed_mps=vehicle.vx_mps,
        length_m=platform.length_m,
        width_m=platform.width_m,
    )
