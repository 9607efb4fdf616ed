"""Traffic as a source: stepped every fixed number of ticks, its result recorded as an input and shown to everybody."""

from collections.abc import Callable
from typing import Any

from simconsole.profiles.world import RoadsProfile
from simconsole.recording.log_header import ROAD_USERS
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import compiled
from simconsole.values.latency import Hop
from simconsole.values.platform import Platform
from simconsole.values.signals import AheadInput, ImpactInput, VehicleState
from simconsole.values.state_vector import Snapshot
from simconsole.values.trigonometry import direction
from simconsole.world.kinds.worlds import open_map, open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.route import Route
from simconsole.world.rules.owing import Owing
from simconsole.world.traffic.crashes import NO_CRASH, Crashes
from simconsole.world.traffic.leader import Leaders
from simconsole.world.traffic.road_users import Box, RoadUsersAt, to_bytes
from simconsole.world.traffic.traffic import Traffic

ShowRoadUsers = Callable[[RoadUsersAt], None]


class TrafficSource:
    """Traffic in the drive loop: an output that sees where the vehicle is, and a source of what the log keeps.

    What a step after tick N brings lies in the log's frame of tick N + 1, the first tick that could know of it.
    """

    hop = Hop.OTHERS

    def __init__(
        self,
        traffic: Traffic,
        platform: Platform,
        period_ticks: int,
        route: Route | None = None,
        owing: Owing | None = None,
    ) -> None:
        """Take what the vehicle follows as `route`; without one it goes straight on, and `owing` tells nothing."""
        self._traffic = traffic
        self._leaders, self._crashes = Leaders(route, compiled), Crashes(platform.solid, compiled)
        self._platform = platform
        self._period_ticks = period_ticks
        self._owing = owing
        self._newest = RoadUsersAt(0, traffic.road_users())
        self._ahead = self._look(ego_box(platform.initial_vehicle, platform), 0)
        self._fresh = True
        self._crash = NO_CRASH
        self._shown: list[ShowRoadUsers] = []
        self.collisions = 0

    def show_to(self, show: ShowRoadUsers) -> None:
        """Show each step's result from here on, and what there is now."""
        self._shown.append(show)
        show(self._newest)

    def newest(self) -> RoadUsersAt:
        """Return the newest result."""
        return self._newest

    def publish(self, snapshot: Snapshot) -> None:
        """Step, if a period has ended with this tick."""
        if snapshot.tick % self._period_ticks:
            return
        vehicle = snapshot.vehicle
        ego = ego_box(vehicle, self._platform)
        self._newest = RoadUsersAt(snapshot.tick, self._traffic.step(ego))
        self._fresh = True
        self._ahead = self._look(ego, snapshot.tick)
        self._crash = self._crashes.step(vehicle, ego, self._newest.users)
        self.collisions += len(self._crash.new)
        for number, change_mps in self._crash.pushed:
            self._traffic.push(number, change_mps)
        for show in self._shown:
            show(self._newest)

    def ahead(self) -> AheadInput:
        """Return whom the vehicle follows and lets pass, as of the last step."""
        return self._ahead

    def _look(self, ego: Box, tick: int) -> AheadInput:
        found = self._leaders.find(ego, self._newest.users)
        if self._owing is None:
            return found
        owed = self._owing.owed(ego, self._newest.users, tick)
        return AheadInput(found.lead_gap_m, found.lead_speed_mps, owed.yield_m, owed.yield_s)

    def unseen(self, tick: int) -> int:
        """Return how many ticks, from `tick` on, do not end a period."""
        return -tick % self._period_ticks

    def take_messages(self) -> list[tuple[str, bytes]]:
        """Return the newest road users, if nobody has taken them yet."""
        fresh, self._fresh = self._fresh, False
        return [(ROAD_USERS, to_bytes(self._newest.users))] if fresh else []

    def take_impact(self) -> ImpactInput:
        """Return what a collision of the last step has done to the vehicle, once."""
        impact, self._crash = self._crash.impact, NO_CRASH
        return impact

    def summary(self) -> dict[str, Any]:
        """Return what the drive's summary says of traffic."""
        return {"traffic": {"road_users": len(self._newest.users), "collisions": self.collisions}}


def open_traffic(resolved: ResolvedSession, console: Console) -> TrafficSource | None:
    """Return the traffic of a session, None where it has none.

    Raises:
        ProfileError: its world is no road map, or its period no whole number of ticks.
    """
    profile = resolved.session.environment.traffic
    if profile is None:
        return None
    if not isinstance(resolved.world, RoadsProfile):
        raise ProfileError("environment.traffic: needs an environment.world that is a road map (kind: roads)")
    if profile.period_ms * console.tick_hz % 1000:
        raise ProfileError(
            f"environment.traffic.period_ms: value {profile.period_ms}: a whole number of ticks"
            f" of {1000.0 / console.tick_hz:g} ms"
        )
    platform, world = console.platform, open_world(resolved.world)
    route, roads = world.route, roads_of(world)
    traffic = Traffic(
        open_map(resolved.world),
        profile,
        compiled,
        route=route,
        ego=ego_box(platform.initial_vehicle, platform),
        ground=world.ground,
    )
    owing = None if roads is None else Owing(roads.road_map, roads.legs, route, console.tick_hz)
    return TrafficSource(traffic, platform, profile.period_ms * console.tick_hz // 1000, route, owing)


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
