"""What the autopilot answers to an odometry: a command, or nothing, and then why. Pure."""

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Final

from simconsole.drivers.autopilot.advised import Advised
from simconsole.drivers.autopilot.others import Others
from simconsole.drivers.autopilot.yields import Yields
from simconsole.drivers.path_tracker.approach import why_not
from simconsole.drivers.path_tracker.geometric import GeometricTracker, pure_pursuit, stanley
from simconsole.drivers.path_tracker.plan import Place, plan
from simconsole.drivers.path_tracker.signal_stops import OVERTAKEN_S, Light, SignalStops
from simconsole.drivers.path_tracker.speed_profile import Stop
from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.drivers.path_tracker.tracker import Tracker, TrackerCommand
from simconsole.drivers.path_tracker.tracker_settings import GATE, TIMING, CarModel, Gate
from simconsole.drivers.path_tracker.tracking_statistics import TrackingStatistics
from simconsole.world.roads.road_map import Array
from simconsole.world.route import Route
from simconsole.world.rules.speed_advice import NO_ADVICE, Advice

_LAWS: Final = {"pure_pursuit": pure_pursuit, "stanley": stanley}
_END_M: Final = 0.5
_STANDING_MPS: Final = 0.05


def make_tracker(
    name: str, course: Route, car: CarModel, delay_s: float, gate: Gate = GATE
) -> Tracker | GeometricTracker:
    """Return the tracker `name`, one of TRACKERS; the plain ones do not know `delay_s`."""
    if name in _LAWS:
        return GeometricTracker(_LAWS[name], course, car, gate)
    return Tracker(course, car, timing=TIMING._replace(delay_s=delay_s), gate=gate)


class Answers:
    """Answers one odometry after the other; what people must know is said once, when it begins.

    Attributes:
        statistics: of all answers.
        sees_lights: whether it asks what traffic lights show.
        sees_others: whether it asks where other road users are.
        is_advised: whether it has advice to tell.
    """

    def __init__(
        self,
        tracker: Tracker | GeometricTracker,
        say: Callable[[str], None],
        lights: SignalStops | None = None,
        others: Others | None = None,
        yields: Yields | None = None,
        advised: Advised | None = None,
    ) -> None:
        """Ask `tracker`, tell people by `say`, obey `lights` and `yields`, and keep behind `others`.

        `advised` is who follows speed advice; None: nobody does.
        """
        self._advised = advised
        self._tracker, self._say, self._lights, self._others, self._yields = tracker, say, lights, others, yields
        self._obeys = lights is not None or yields is not None
        self.sees_lights, self.sees_others = lights is not None, others is not None
        self.is_advised = advised is not None
        self.statistics = TrackingStatistics()
        self._withholds = False
        self._told = NO_ADVICE
        self._newest_s = -math.inf

    def answer(self, seen: VehicleMotion, engaged: bool, stamp_s: float) -> TrackerCommand | None:
        """Return the command that answers what was seen at `stamp_s`; None: none is given, as for what is overtaken."""
        tracker, statistics = self._tracker, self.statistics
        if self._newest_s - OVERTAKEN_S <= stamp_s < self._newest_s:
            statistics.skipped += 1
            return None
        if stamp_s < self._newest_s:
            tracker.s_m = None
        self._newest_s = stamp_s
        if tracker.s_m is not None and self._obeys:
            tracker.along.stop = self._stop(tracker.s_m, seen.vx_mps, stamp_s)
            if self._advised is not None and self._lights is not None:
                approach = self._lights.approach(tracker.s_m)
                tracker.along.advised_mps = self._advised.target_mps(
                    approach, tracker.s_m, seen.vx_mps, tracker.along.profile, stamp_s
                )
        if self._others is not None:
            tracker.along.leader = self._others.leader(seen, stamp_s)
        command = tracker.step(seen, engaged, stamp_s)
        reason = why_not(tracker.lateral_m, tracker.heading_error_rad, seen.vx_mps, engaged)
        if reason:
            if not self._withholds:
                self._say(f"gives no commands: {reason}")
            self._withholds = True
            statistics.withheld += 1
            return None
        if self._withholds:
            self._withholds = False
            self._say("gives commands again")
        s_m = tracker.s_m or 0.0
        statistics.add(engaged, s_m, tracker.lateral_m, seen.vx_mps)
        self._look_for_the_end(s_m, engaged and abs(seen.vx_mps) < _STANDING_MPS)
        return command

    def _stop(self, s_m: float, speed_mps: float, stamp_s: float) -> Stop | None:
        """Return the first stop that lights or others ask for."""
        stops = (
            None if self._lights is None else self._lights.stop(s_m, speed_mps, self._tracker.along.profile, stamp_s),
            None if self._yields is None else self._yields.stop(s_m, speed_mps, stamp_s),
        )
        return min((stop for stop in stops if stop is not None), default=None)

    def advice(self) -> Advice | None:
        """Return what it goes by, where that is another than at the last call; None: the same, or none is wanted."""
        if self._advised is None or self._advised.advice == self._told:
            return None
        self._told = self._advised.advice
        return self._told

    def planned(self, seen: VehicleMotion) -> Iterator[Place]:
        """Yield the places that are planned from what was answered last; none while no commands are given."""
        return iter(()) if self._withholds else plan(self._tracker, seen.vx_mps)

    def see(self, lights: Mapping[tuple[str, int], Light]) -> None:
        """Take what traffic lights show (`lights.lights_of`)."""
        if self._lights is not None:
            self._lights.see(lights)

    def see_others(self, users: Array, stamp_s: float) -> None:
        """Take where other road users were at `stamp_s` (`others.road_users_of`)."""
        if self._others is not None:
            self._others.see(users, stamp_s)
        if self._yields is not None:
            self._yields.see(users, stamp_s)

    def _look_for_the_end(self, s_m: float, stands: bool) -> None:
        course = self._tracker.course
        if course.closed or self.statistics.at_end or not stands or s_m < course.length_m - _END_M:
            return
        self.statistics.at_end = True
        self._say("stands at the end of the course")
