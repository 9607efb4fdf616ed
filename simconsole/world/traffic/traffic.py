"""Built-in traffic on a road map: vehicles by a seed, parked cars, a lead vehicle, and the ego among them."""

from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np

from simconsole.profiles.traffic import LeadVehicle, TrafficProfile
from simconsole.values.height_field import HeightField, spline_at
from simconsole.values.kernels import Row, holding, kernel
from simconsole.values.trigonometry import direction
from simconsole.world import traffic_columns as at
from simconsole.world.people.people import People
from simconsole.world.people.walking import Others
from simconsole.world.roads.lane_index import HEADING_M, LaneArrays, LaneIndex, nearest_segment
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
from simconsole.world.traffic.stepping import Everybody, Stepped, list_all, step_and_list

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
        ground: HeightField | None = None,
    ) -> None:
        """Put the vehicles on the road.

        Args:
            road_map: the roads.
            profile: how many vehicles, and by which seed.
            execution: how kernels run: `jit.compiled` or `jit.plain`.
            route: what a lead vehicle drives on.
            ego: the console's vehicle at the start.
            signals: what the map's signals show; their own programs unless it says otherwise.
            ground: its heights; the ground is level without it.
        """
        self.period_s = 0.001 * profile.period_ms
        self._net, self._ground = network(road_map), ground
        self._lights = Lights(road_map, signals or by_programs(road_map))
        cars = [place for place, lane in enumerate(road_map.lanes) if lane.drivable]
        self._lanes = LaneIndex(road_map.lanes, cars, nearest_segment).arrays
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
        self._hold(execution)
        self._placement = Placement(self._net, self._rng)
        self._see_others(ego, 0.0)
        for row in range(count):
            self._place(row, anywhere=True)
        self._turn.lights[:] = self._lights.at(0.0)
        self._let_people_walk(0.0)  # nobody moves, but the kernels are compiled or loaded before any clock runs
        self._step_all(-1, self.period_s)

    def _hold(self, execution: Execution) -> None:
        """Hand the arrays, which stay where they are, to the kernels."""
        near = np.zeros(len(self._boxes), np.int64)
        everybody = Everybody(
            self._net, self._values, self._paths, self._boxes, self._turn, near, self._ids, self._users
        )
        self._step_all: Callable[[int, float], Stepped] = holding(execution(step_and_list), everybody)
        self._list_all: Callable[[], int] = holding(execution(list_all), everybody)
        self._put_box = holding(execution(put_box), Places(self._lanes, self._net.widths_m, self._boxes))
        vehicles = self._boxes[: self._first_person]
        self._people.meet(Others(vehicles, self._values, self._paths, self._net.lengths_m))

    def step(self, ego: Box | None) -> Array:
        """Move everybody on by one period and return where they are then, a table of road users.

        `ego` is the console's vehicle before the period, None where it has no body.
        """
        self._turn.lights[:] = self._lights.at(self._steps * self.period_s)
        self._see_others(ego, self.period_s)
        self._courtesy.step(self._boxes[self._ego].tolist(), self.period_s)
        self._let_people_walk(self.period_s)
        stepped = self._step_all(self._steps, self.period_s)
        self._steps += 1
        if stepped.gone:
            self._let_others_come()
            return self.road_users()
        return self._table(stepped.users)

    def push(self, number: float, change_mps: float) -> None:
        """Change the speed of road user `number`, who has collided and from now on only comes to rest.

        Vehicles move along their way alone: what would push them aside their tyres take. People fall where they are.
        """
        row = int(np.flatnonzero((self._ids == number) & (np.arange(len(self._ids)) != self._ego))[0])
        if row < len(self._values):
            self._values[row, at.SPEED] = max(0.0, self._values[row, at.SPEED] + change_mps)
            self._values[row, at.CRASHED] = 1.0
        elif row == self._lead and self._driver is not None:
            self._driver.crash(change_mps)
        elif row >= self._first_person:
            self._people.fall(row - self._first_person)

    def road_users(self) -> Array:
        """Return where everybody is, float64 [users, FIELDS] as `RoadUser`: vehicles, those parked, people."""
        return self._table(self._list_all())

    def _table(self, count: int) -> Array:
        """Return the first `count` of the users that were listed."""
        found = self._users[:count].copy()
        if self._ground is not None:
            found[:, 9] = spline_at(self._ground, 0, found[:, 2], found[:, 3])
        return found

    def _see_others(self, ego: Box | None, period_s: float) -> None:
        """Write the boxes of the ego and of the lead vehicle."""
        lead = None if self._driver is None else self._driver.step(period_s)
        for row, box in ((self._ego, ego), (self._lead, lead)):
            if box is None:
                self._boxes[row, at.LENGTH] = 0.0
            else:
                self._put_box(row, *box)

    def _let_people_walk(self, period_s: float) -> None:
        """Move those on foot on by a period; who comes anew is somebody else."""
        if not len(self._people.rows):
            return
        for place in self._people.step(self._lights.shown or (), period_s):
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


class Places(NamedTuple):
    """What `put_box` looks up, and where it writes."""

    lanes: LaneArrays
    widths_m: Row  # of all lanes
    boxes: Row  # float64 [boxes, BOX]


@kernel
def put_box(
    places: Places,
    number: int,
    x_m: float,
    y_m: float,
    yaw_rad: float,
    speed_mps: float,
    length_m: float,
    width_m: float,
) -> None:
    """Write a `Box` that is no vehicle of traffic into row `number` of the boxes, and on which lane it is."""
    heading, lanes, row = direction(yaw_rad), places.lanes, places.boxes[number]
    row[at.X], row[at.Y], row[at.COSINE], row[at.SINE] = x_m, y_m, heading.cos, heading.sin
    row[at.SPEED], row[at.LENGTH], row[at.WIDTH] = speed_mps, length_m, width_m
    row[at.LANE], row[at.ALONG] = -1.0, 0.0
    found = nearest_segment(
        lanes.rows, lanes.starts, lanes.items, lanes.grid, x_m, y_m, heading.cos, heading.sin, HEADING_M
    )
    if found.segment >= 0.0:
        segment = int(found.segment)
        lane = lanes.owners[segment]
        if abs(found.lateral_m) <= 0.5 * places.widths_m[int(lane)]:
            row[at.LANE], row[at.ALONG] = lane, lanes.rows[segment, 5] + found.along_m


def _lead_driver(profile: LeadVehicle | None, route: Route | None, ego: Box | None) -> LeadDriver | None:
    """Return who drives the lead vehicle before the ego; None where there is none, or no route for it."""
    if profile is None or route is None:
        return None
    return LeadDriver(profile, route, 0.0 if ego is None else route.project(ego.x_m, ego.y_m).s_m)
