"""What one platform of several sees of the others, and of SUMO's traffic where there is one."""

from typing import Any

from simconsole.session.fleet.company import Company
from simconsole.session.fleet.shared_sumo import SharedSumo
from simconsole.session.traffic_source import TrafficSource, signals_of
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.signals import VehicleState
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.owing import Owing
from simconsole.world.traffic.road_users import Box


class Sight(TrafficSource):
    """What one platform sees of the others: taken once all have made the ticks of a period, of the same moment."""

    def publish(self, snapshot: Snapshot) -> None:
        """Do nothing yet: others have still to make the ticks of this period."""

    def look(self, snapshot: Snapshot, company: Company, number: int) -> None:
        """Look at the others, at the end of a period; the platform is that of this number, where `company` has it."""
        if snapshot.tick % self._period_ticks == 0:
            self._look_around(snapshot, company.vehicle(number), company.box(number))


class Onlooking(Sight):
    """What the recording and the views of a robot have of the others; itself it is told of circles (`Whereabouts`)."""

    def _look_around(self, snapshot: Snapshot, vehicle: VehicleState, ego: Box) -> None:
        """Take where everybody is, and nothing that would act on the robot."""
        self._newest = self._of(snapshot.tick, self._traffic.step(ego))
        self._fresh = True
        for show in self._shown:
            show(self._newest)

    def summary(self) -> dict[str, Any]:
        """Return nothing: who touches a robot is told by its own state."""
        return {}


def sight_of(
    company: Company, number: int, resolved: ResolvedSession, console: Console, sumo: SharedSumo | None = None
) -> Sight:
    """Return what the platform of this number sees; its period is that of the session's control, or of SUMO.

    Raises:
        ProfileError: a file of its map cannot be read.
    """
    world = None if resolved.world is None else open_world(resolved.world)
    route, roads = (None, None) if world is None else (world.route, roads_of(world))
    period_ticks = resolved.session.mode.control_period_ticks if sumo is None else sumo.period_ticks
    on_sumo = None if sumo is None else sumo.around(number)
    owing, signals = None, None
    if roads is not None and route is not None:
        state = None if on_sumo is None else on_sumo.signals.state
        owing = Owing(roads.road_map, roads.legs, route, console.tick_hz, state)
        signals = None if on_sumo is None else signals_of(roads, console, on_sumo.signals)
    traffic = on_sumo or company.around(number)
    if console.others:
        return Onlooking(traffic, console.platform, period_ticks)
    return Sight(traffic, console.platform, period_ticks, route, owing, signals, moves=company.moving)
