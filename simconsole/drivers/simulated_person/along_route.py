"""A person who drives along a route: what they see of it, late and not exactly, and what hands and feet make of it.

Pure. Position is seen `visual_delay_s` late, other road users and signals `reaction_s` late. What the person takes for
the middle of the lane wanders within bounds, for nobody aims at the line, and so do the hands: smooth curves from the
plan's seed (`values/draws.py`).
"""

import math
from collections import deque
from typing import Final, NamedTuple

from simconsole.drivers.car_following import following_mps2
from simconsole.drivers.path_tracker.speed_profile import plan_speed
from simconsole.drivers.path_tracker.tracker_settings import Comfort
from simconsole.drivers.simulated_person.following import Obedience, following, stopping_mps2
from simconsole.drivers.simulated_person.guidance import Pace
from simconsole.drivers.simulated_person.situation import Situation
from simconsole.drivers.simulated_person.two_point import Points, TwoPointSteering, distances_m, wheel_to
from simconsole.drivers.simulated_person.view import View
from simconsole.profiles.person import PersonPlan
from simconsole.values.draws import Channel, bounded, even, wandering
from simconsole.values.units import MPS_PER_KMH, RAD_PER_DEG
from simconsole.world.route import Route
from simconsole.world.rules.speed_advice import DOWN_MPS2

FORESIGHT_S: Final = 0.7
"""The feet act for where the car will be when they have acted."""
SPEED_GAIN_1PS: Final = 0.6
COAST_MPS2: Final = 0.5
"""What a car loses without a foot on a pedal: the brake is for more."""
FULL_BRAKE_MPS2: Final = 9.5
"""What a brake pedal pressed down brings about; the person knows their brake."""
EAGER_MPS: Final = 2.5
"""How much faster than now the accelerator asks for, at most."""
HURRIED_MPS: Final = 1.5
STANDING_MPS: Final = 0.3
HOLD_BRAKE: Final = 0.3
LEAST_SHARE: Final = 0.85
"""Of the habit's aim deviation that the most careful person has; the least careful one has as much more."""
ARRIVED_M: Final = 2.0


class Seen(NamedTuple):
    """One moment as it was seen."""

    points: Points
    speed_mps: float


class AlongRoute:
    """Guidance along a route."""

    def __init__(self, plan: PersonPlan, route: Route, tick_hz: int) -> None:
        """Look at the whole route once: how fast to drive where."""
        road = plan.road
        self._plan, self._road, self._route = plan, road, route
        self._speeds = plan_speed(
            route,
            Comfort(
                lateral_mps2=road.lateral_mps2,
                accelerate_mps2=road.accelerate_mps2,
                brake_mps2=road.brake_mps2,
                margin_mps=road.below_limit_mps,
            ),
        )
        self._tick_s = 1.0 / tick_hz
        self._steering = TwoPointSteering(road, self._tick_s)
        self._seen: deque[Seen] = deque(maxlen=1 + round(road.visual_delay_s * tick_hz))
        self._situations: deque[tuple[Situation, float]] = deque(maxlen=1 + round(road.reaction_s * tick_hz))
        self._obedience, self._following = Obedience(), following(road)
        care = LEAST_SHARE + 2.0 * (1.0 - LEAST_SHARE) * even(plan.seed, Channel.PERSON_CARE, 0)
        self._aim_deviation_m = road.aim_deviation_m * care
        self._s_m: float | None = None
        self._began_m = 0.0

    def look(self, view: View) -> None:
        """See where the two points are, and who and what is ahead."""
        s_m = self._route.project(view.x_m, view.y_m, self._s_m).s_m
        self._began_m = s_m if self._s_m is None else self._began_m
        self._s_m = s_m
        near_m, far_m = distances_m(view.speed_mps, self._road)
        aim_m = self._aim_deviation_m * wandering(
            self._plan.seed, Channel.PERSON_AIM, view.time_s / self._road.aim_time_s, bounded
        )
        points = Points(self._wheel_to(s_m + near_m, aim_m, view), self._wheel_to(s_m + far_m, aim_m, view))
        self._seen.append(Seen(points, view.speed_mps))
        self._situations.append((view.situation, view.distance_m))

    def _wheel_to(self, s_m: float, aim_m: float, view: View) -> float:
        point = self._route.at(s_m)
        dx = point.x_m - aim_m * math.sin(point.yaw_rad) - view.x_m
        dy = point.y_m + aim_m * math.cos(point.yaw_rad) - view.y_m
        cosine, sine = math.cos(view.yaw_rad), math.sin(view.yaw_rad)
        ahead_m, left_m = dx * cosine + dy * sine, dy * cosine - dx * sine
        return wheel_to(ahead_m, left_m, view.speed_mps, self._plan.habits, self._road)

    def begin(self, view: View, hand_wheel_rad: float) -> None:
        """Steer on from where the wheel is."""
        self._steering.begin(hand_wheel_rad)

    def settle(self, view: View) -> None:
        """Steer on: the person has steered since they began to take over."""

    def steer(self, view: View) -> float:
        """Return where the hands should turn the wheel, in rad."""
        seen = self._seen[0]
        wanted_rad = self._steering.turn(seen.points, seen.speed_mps, view.hand_wheel_rad)
        place = view.time_s / self._road.hand_time_s
        tremble = wandering(self._plan.seed, Channel.PERSON_HAND, place) * min(1.0, view.speed_mps / 3.0)
        return wanted_rad + self._road.hand_deviation_deg * RAD_PER_DEG * tremble

    def pace(self, view: View) -> Pace:
        """Return what the feet should bring about: the least of the road, advice, who is ahead and signals."""
        s_m, speed_mps = self._s_m or 0.0, view.speed_mps
        planned_mps, planned_mps2 = self._speeds.at(s_m + FORESIGHT_S * speed_mps)
        cruise_mps = self._plan.cruise_kmh * MPS_PER_KMH
        if planned_mps > cruise_mps:
            planned_mps, planned_mps2 = cruise_mps, 0.0
        on_road = planned_mps2 + SPEED_GAIN_1PS * (planned_mps - speed_mps)
        seen = self._known_ahead(view.distance_m)
        if self._road.follows_advice and seen.advised_mps < planned_mps:
            planned_mps = seen.advised_mps
            on_road = min(on_road, max(SPEED_GAIN_1PS * (planned_mps - speed_mps), -DOWN_MPS2))
        among_others = self._allowed_mps2(seen, speed_mps)
        if on_road <= among_others:
            return self._feet(speed_mps, on_road, planned_mps)
        return self._feet(speed_mps, among_others, speed_mps + among_others / SPEED_GAIN_1PS)

    def _allowed_mps2(self, seen: Situation, speed_mps: float) -> float:
        """Return the acceleration that vehicles ahead, signals and those with right of way allow."""
        road = self._road
        allowed = min(
            following_mps2(seen.lead_gap_m, seen.lead_speed_mps, speed_mps, self._following),
            stopping_mps2(seen.yield_m, speed_mps, road),
        )
        if self._obedience.must_stop(seen, speed_mps):
            allowed = min(allowed, stopping_mps2(seen.line_m, speed_mps, road))
        return allowed

    def _known_ahead(self, distance_m: float) -> Situation:
        """Return what is ahead as it was when it was seen, less the way driven since then.

        What others do is known late; one's own motion, and that of a vehicle that goes on as it did, is not.
        """
        seen, then_m = self._situations[0]
        driven_m = distance_m - then_m
        late_s = (len(self._situations) - 1) * self._tick_s
        return seen._replace(
            lead_gap_m=seen.lead_gap_m - driven_m + seen.lead_speed_mps * late_s,
            line_m=seen.line_m - driven_m,
            yield_m=seen.yield_m - driven_m,
        )

    def _feet(self, speed_mps: float, accel_mps2: float, target_mps: float) -> Pace:
        if speed_mps < STANDING_MPS and target_mps < STANDING_MPS:
            return Pace(0.0, HOLD_BRAKE)
        if accel_mps2 < -COAST_MPS2:
            return Pace(0.0, min(1.0, -(accel_mps2 + COAST_MPS2) / FULL_BRAKE_MPS2))
        return Pace(min(target_mps, speed_mps + EAGER_MPS), 0.0, target_mps > speed_mps + HURRIED_MPS)

    def arrived(self, view: View) -> bool:
        """Return whether an open route is about to end, or the lap that is the whole plan."""
        s_m = self._began_m if self._s_m is None else self._s_m
        if not self._route.closed:
            return s_m > self._route.length_m - ARRIVED_M
        return self._plan.stop is None and self._plan.autonomy is None and s_m - self._began_m > self._route.length_m
