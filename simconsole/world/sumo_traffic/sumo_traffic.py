"""SUMO's traffic round the console's vehicles, in the place of built-in traffic: the same step, the same table."""

import math
import tempfile
from collections.abc import Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Final, NamedTuple

from simconsole.profiles.traffic import SumoProfile, TrafficProfile
from simconsole.values.errors import ProfileError
from simconsole.values.height_field import HeightField, spline_at
from simconsole.world.roads.lane_graph import Leg
from simconsole.world.roads.road_map import Array, RoadMap
from simconsole.world.rules.running_signals import RunningSignals
from simconsole.world.sumo_traffic.demand import demand
from simconsole.world.sumo_traffic.ego import NO_CHECKS, Ego
from simconsole.world.sumo_traffic.engines import KEY, open_engine, said_by
from simconsole.world.sumo_traffic.places import Bumper
from simconsole.world.sumo_traffic.smooth import Smooth
from simconsole.world.sumo_traffic.subscriptions import (
    Found,
    Numbers,
    SignalReader,
    VehicleReader,
    people_rows,
    position_of,
    road_users,
)
from simconsole.world.traffic.road_users import CAPACITY, NOBODY, Box

STOPPING_MPS2: Final = 6.0
_HORIZON_S: Final = 3600.0
_MOST_S: Final = 7200.0


class Surroundings(NamedTuple):
    """What of the world and the drive SUMO's traffic has to do with."""

    road_map: RoadMap
    net: bytes  # the file that the map was read from
    legs: tuple[Leg, ...]  # of the world's route
    tick_hz: int
    egos: tuple[Box, ...]  # at the start; more than one: those of several platforms
    duration_s: float | None
    ground: HeightField | None = None


class SumoTraffic:
    """All road users but the egos, as SUMO moves them. Equal profiles and egos give equal bits, of one SUMO version.

    Of several egos each has others around it; to SUMO's vehicles all of them are there, to each other they are not.
    Numbers of road users begin with how many egos there are, where there are several: those are their own.
    """

    def __init__(self, profile: TrafficProfile, around: Surroundings) -> None:
        """Start SUMO, let it warm up and put the vehicles on the road.

        Raises:
            ProfileError: SUMO is missing, refuses what it shall do, or its network is not the world's map.
        """
        assert profile.sumo is not None
        self._profile, self._around = profile.sumo, around
        self.period_s = 0.001 * profile.period_ms
        self.signals = RunningSignals(around.road_map, around.tick_hz)
        self.road_map = around.road_map
        self.lost: str | None = None
        self.ego_error_m = 0.0
        several = len(around.egos) > 1
        self._numbers, self._users = Numbers(len(around.egos) if several else 0), [NOBODY] * len(around.egos)
        self._smooth = Smooth(self.period_s)
        self._crashed: dict[str, float] = {}
        with ExitStack() as stack:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="simconsole-sumo-")))
            engine = open_engine(self._profile, self._options(profile, folder))
            stack.callback(engine.close)
            self._sumo, self._errors, self.process = engine.sumo, engine.errors, engine.process
            try:
                self._begin(around.egos)
            except self._errors as error:
                reason = said_by(engine.process) or ascii(str(error))[1:-1][:200]
                raise ProfileError(f"{KEY}: SUMO: {reason}: a simulation that starts") from None
            engine.expect_answers()
            self._stack = stack.pop_all()

    def road_users(self, number: int = 0) -> Array:
        """Return where those round the ego of this number are, float64 [users, FIELDS] as `RoadUser`."""
        return self._users[number]

    def step(self, ego: Box | None) -> Array:
        """Put the one ego where it is, let SUMO step, and return who is where then; nobody once SUMO has failed."""
        self.step_all(self._around.egos if ego is None else (ego,))
        return self._users[0]

    def step_all(self, egos: Sequence[Box]) -> None:
        """Put all egos where they are, and let SUMO step."""
        if self.lost is None:
            try:
                self._step(egos)
            except self._errors as error:
                self.lost = ascii(str(error) or type(error).__name__)[1:-1][:200]
                self._users = [NOBODY] * len(egos)

    def stand(self, periods: int) -> None:
        """Let so many periods of the drive go by in which SUMO's time stands still."""
        self._start_s -= periods * self.period_s
        self._reader.forget()

    def push(self, number: float, change_mps: float) -> None:
        """Change the speed of road user `number`, who has collided and from now on only comes to rest."""
        walks, name = self._numbers.name(number)
        with suppress(*self._errors):
            if walks:
                self._sumo.person.setSpeed(name, 0.0)
                return
            if name not in self._crashed:
                self._sumo.vehicle.setSpeedMode(name, NO_CHECKS)
                self._sumo.vehicle.setLaneChangeMode(name, NO_CHECKS)
            speed_mps = self._crashed.get(name, self._sumo.vehicle.getSpeed(name)) + change_mps
            self._crashed[name] = max(0.0, speed_mps)

    def close(self) -> None:
        """Take the egos off the road, and end SUMO or this client's part in it."""
        if self.lost is None:
            with suppress(*self._errors):
                for ego in self._egos:
                    ego.leave()
        elif self.process is not None:
            self.process.kill()  # it answers no more
        self._stack.close()

    def _begin(self, boxes: Sequence[Box]) -> None:
        sumo, around = self._sumo, self._around
        if {edge.id for edge in around.road_map.edges} - set(sumo.edge.getIDList()):
            raise ProfileError(f"{KEY}.config: value {self._profile.config}: one on the world's own map")
        step_s = sumo.simulation.getDeltaT()
        if abs(step_s - self.period_s) > 1e-9:
            raise ProfileError(f"{KEY}.address: value with steps of {step_s:g} s: {self.period_s:g} s")
        for _ in range(round(self._profile.warm_up_s / self.period_s)):
            sumo.simulationStep()
        self._vehicles = VehicleReader(sumo, self._numbers)
        self._reader = SignalReader(sumo, [one.id for one in around.road_map.signals], around.tick_hz)
        radius_m = self._profile.radius_m
        self._egos = [Ego(sumo, around.road_map, around.legs, radius_m, number) for number in range(len(boxes))]
        self._own = {ego.name for ego in self._egos}
        for ego, box in zip(self._egos, boxes, strict=True):
            ego.begin(box)
        # The step before the drive: what is there at tick 0.
        self._start_s = sumo.simulation.getTime() + self.period_s
        self._step(boxes)

    def _step(self, boxes: Sequence[Box]) -> None:
        places = [ego.put(box, self.period_s) for ego, box in zip(self._egos, boxes, strict=True)]
        self._brake()
        self._sumo.simulationStep()
        seen: list[Found] = [self._sumo.vehicle.getContextSubscriptionResults(ego.name) for ego in self._egos]
        others = {
            name: one[name] for name in sorted(set[str]().union(*seen) - self._own) for one in seen if name in one
        }
        rows = self._vehicles.rows(others)
        self._smooth.step(rows)
        self._users = []
        for ego, place, found in zip(self._egos, places, seen, strict=True):
            own = found.get(ego.name)  # off the road it is not among those round it
            x_m, y_m = self._sumo.vehicle.getPosition(ego.name) if own is None else position_of(own)
            self.ego_error_m = max(self.ego_error_m, math.hypot(x_m - place.x_m, y_m - place.y_m))
            self._users.append(self._read(ego, place, rows[[name in found for name in others]]))
        self.signals.take(self._reader.read(self._start_s))

    def _read(self, ego: Ego, place: Bumper, vehicles: Array) -> Array:
        """Return the vehicles round an ego, and the people."""
        around = self._around
        people = people_rows(self._sumo.poi.getContextSubscriptionResults(ego.name), self._numbers)
        room = CAPACITY + 1 - len(self._egos)  # for the others of ours
        users = road_users(vehicles, people, around.road_map.moved_m, (place.x_m, place.y_m), room)
        if around.ground is not None and len(users):
            users[:, 9] = spline_at(around.ground, 0, users[:, 2], users[:, 3])
        return users

    def _brake(self) -> None:
        """Let those who have collided come to rest."""
        for name, speed_mps in list(self._crashed.items()):
            try:
                self._sumo.vehicle.setSpeed(name, speed_mps)
                self._crashed[name] = max(0.0, speed_mps - STOPPING_MPS2 * self.period_s)
            except self._errors:
                if name in self._sumo.vehicle.getIDList():
                    raise
                del self._crashed[name]  # somebody else has taken it off the road

    def _options(self, profile: TrafficProfile, folder: Path) -> list[str]:
        """Return SUMO's options, and write the files that they name."""
        options = [
            *("--step-length", f"{self.period_s:g}", "--seed", str(profile.seed % 2**31)),
            *("--collision.action", "warn"),  # what a collision does is the console's affair
            *("--no-step-log", "true", "--duration-log.disable", "true", "--no-warnings", "true"),
        ]
        sumo: SumoProfile = self._profile
        if sumo.config is not None:
            return ["--configuration-file", sumo.config, *options]
        net, routes = folder / "map.net.xml", folder / "demand.rou.xml"
        net.write_bytes(self._around.net)
        horizon_s = min(self._around.duration_s or _HORIZON_S, _MOST_S) + sumo.warm_up_s
        routes.write_text(
            demand(
                self._around.road_map,
                vehicles=sumo.vehicles,
                pedestrians=sumo.pedestrians,
                seed=profile.seed,
                horizon_s=horizon_s,
            ),
            encoding="utf-8",
        )
        return [
            *("--net-file", str(net), "--route-files", str(routes), "--ignore-route-errors", "true"),
            *("--time-to-teleport", "-1"),
            *options,
        ]
