"""Built-in traffic on a road map: vehicles by a seed, parked cars, a lead vehicle, and the ego among them."""

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from simconsole.profiles.traffic import LeadVehicle, TrafficProfile
from simconsole.values.trigonometry import direction
from simconsole.world import traffic_columns as at
from simconsole.world.people.people import People
from simconsole.world.people.walking import Others
from simconsole.world.roads.lane_index import LaneIndex, nearest_segment
from simconsole.world.roads.road_map import Array, RoadMap
from simconsole.world.route import Route
from simconsole.world.traffic.courtesy import Courtesy
from simconsole.world.traffic.junctions import LINE, Turn
from simconsole.world.traffic.lead_vehicle import LeadDriver
from simconsole.world.traffic.network import network
from simconsole.world.traffic.parking import parked_cars
from simconsole.world.traffic.placement import CLEAR_M, Placement
from simconsole.world.traffic.road_users import FIELDS, Box
from simconsole.world.traffic.signal_states import Lights, SignalStates, by_programs
from simconsole.world.traffic.stepping import list_users, step_traffic

Execution = Callable[[Any], Any]
EGO_CLEAR_M: Final = 30.0
"""Nobody appears as near as this to the ego."""


class Traffic:
    """All road users but the ego. Equal maps, profiles and egos give equal bits."""

    def __init__(
        self,
        road_map: RoadMap,
        profile: TrafficProfile,
        execution: Execution,
        *,
        route: Route | None = None,
        ego: Box | None = None,
        signals: SignalStates | None = None,
    ) -> None:
        """Put the vehicles on the road.

        Args:
            road_map: the roads.
            profile: how many vehicles, and by which seed.
            execution: how kernels run: `jit.compiled` or `jit.plain`.
            route: what a lead vehicle drives on.
            ego: the console's vehicle at the start.
            signals: what the map's signals show; their own programs unless it says otherwise.
        """
        self.period_s = 0.001 * profile.period_ms
        self._net = network(road_map)
        self._lights = Lights(road_map, signals or by_programs(road_map))
        cars = [place for place, lane in enumerate(road_map.lanes) if lane.drivable]
        self._index = LaneIndex(road_map.lanes, cars, execution(nearest_segment))
        self._step_kernel, self._list_kernel = execution(step_traffic), execution(list_users)
        self._rng = np.random.default_rng(profile.seed)
        self._steps = 0
        count = profile.vehicles
        self._values = np.zeros((count, at.VALUES))
        self._paths = np.zeros((count, at.PATH), np.int64)
        parked = parked_cars(road_map, profile.parked, self._rng)
        self._people = People(road_map, profile.pedestrians, profile.seed, execution)
        self._ego, self._lead, self._first_person = count, count + 1, count + 2 + len(parked)
        self._boxes = np.zeros((self._first_person + len(self._people.boxes), at.BOX))
        self._boxes[count:, at.LANE] = -1.0
        self._boxes[count + 2 : self._first_person] = parked
        self._boxes[self._first_person :] = self._people.boxes
        self._users = np.zeros((len(self._boxes), FIELDS))
        self._ids = np.zeros(len(self._boxes))
        self._ids[count:] = np.arange(len(self._boxes) - count)  # the ego's is nobody's
        self._next_id = len(self._boxes) - count
        self._driver = _lead_driver(profile.lead, route, ego)
        granted, lights, kept_free = (np.zeros(len(road_map.connections), np.int64) for _ in range(3))
        self._turn = Turn(
            lines=np.zeros((count, LINE)),
            granted=granted,
            lights=lights,
            kept_free=kept_free,
            crossed=self._people.crossed,
        )
        self._courtesy = Courtesy(self._net, lights, kept_free)
        self._near = np.zeros(len(self._boxes), np.int64)
        self._placement = Placement(self._net, self._rng)
        self._see_others(ego, 0.0)
        for row in range(count):
            self._place(row, anywhere=True)
        self._turn.lights[:] = self._lights.at(0.0)
        self._let_people_walk(0.0)  # nobody moves, but the kernels are compiled or loaded before any clock runs
        self._advance(0)

    def step(self, ego: Box | None) -> Array:
        """Move everybody on by one period and return where they are then, a table of road users.

        `ego` is the console's vehicle before the period, None where it has no body.
        """
        self._turn.lights[:] = self._lights.at(self._steps * self.period_s)
        self._see_others(ego, self.period_s)
        self._courtesy.step(self._boxes[self._ego], self.period_s)
        self._let_people_walk(self.period_s)
        self._advance(len(self._values))
        self._steps += 1
        self._let_others_come()
        return self.road_users()

    def road_users(self) -> Array:
        """Return where everybody is, float64 [users, FIELDS] as `RoadUser`: vehicles, those parked, people."""
        count = self._list_kernel(self._boxes, self._ids, self._ego, self._users)
        return self._users[: int(count)].copy()

    def _advance(self, count: int) -> None:
        """Run the kernel on the first `count` vehicles: all of them, or none."""
        turn = self._turn._replace(lines=self._turn.lines[:count])
        values, paths = self._values[:count], self._paths[:count]
        self._step_kernel(self._net, values, paths, self._boxes, turn, self._near, self._steps, self.period_s)

    def _see_others(self, ego: Box | None, period_s: float) -> None:
        """Write the boxes of the ego and of the lead vehicle."""
        lead = None if self._driver is None else self._driver.step(period_s)
        for row, box in ((self._ego, ego), (self._lead, lead)):
            if box is None:
                self._boxes[row, at.LENGTH] = 0.0
                continue
            lane = self._index.locate(box.x_m, box.y_m, box.yaw_rad)
            heading = direction(box.yaw_rad)
            self._boxes[row] = (
                *(box.x_m, box.y_m, heading.cos, heading.sin, box.speed_mps, box.length_m, box.width_m),
                *((-1.0, 0.0) if lane.lane is None or not lane.on_lane else (float(lane.lane), lane.s_m)),
            )

    def _let_people_walk(self, period_s: float) -> None:
        """Move those on foot on by a period; who comes anew is somebody else."""
        vehicles = slice(0, self._first_person)
        others = Others(self._boxes[vehicles], self._values, self._paths, self._net.lengths_m)
        for place in self._people.step(self._lights.shown or (), others, period_s):
            self._ids[self._first_person + place] = self._next_id
            self._next_id += 1
        self._boxes[self._first_person :] = self._people.boxes

    def _let_others_come(self) -> None:
        """Let others come in the place of who has left the map."""
        for row in np.flatnonzero(self._values[:, at.LENGTH] == 0.0):
            self._boxes[row, at.LENGTH] = 0.0
            self._place(int(row), anywhere=False)

    def _place(self, row: int, *, anywhere: bool) -> None:
        if self._placement.place(self._values[row], self._paths[row], self._taken(), anywhere=anywhere):
            self._boxes[row] = self._values[row, : at.BOX]
            self._ids[row] = self._next_id
            self._next_id += 1

    def _taken(self) -> Array:
        """Return the places that nobody may appear near: x, y and how near, float64 [N, 3]."""
        boxes = self._boxes
        clear = np.full(len(boxes), CLEAR_M)
        clear[self._ego] = EGO_CLEAR_M
        on_road = boxes[:, at.LENGTH] > 0.0
        return np.column_stack((boxes[on_road, at.X], boxes[on_road, at.Y], clear[on_road]))


def _lead_driver(profile: LeadVehicle | None, route: Route | None, ego: Box | None) -> LeadDriver | None:
    """Return who drives the lead vehicle before the ego; None where there is none, or no route for it."""
    if profile is None or route is None:
        return None
    return LeadDriver(profile, route, 0.0 if ego is None else route.project(ego.x_m, ego.y_m).s_m)
