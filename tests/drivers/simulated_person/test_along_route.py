"""Along a route: how fast where, who is in the way, what is seen late and not exactly, and where it ends. No car."""

import math
from functools import cache

import msgspec
import pytest

from simconsole.drivers.simulated_person.along_route import COAST_MPS2, FULL_BRAKE_MPS2, HOLD_BRAKE, AlongRoute
from simconsole.drivers.simulated_person.guidance import Pace
from simconsole.drivers.simulated_person.situation import NOTHING_AHEAD, Light, Situation
from simconsole.drivers.simulated_person.view import View
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.person import PersonPlan, RoadHabits, When
from simconsole.values.signals import Mode
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import Route
from simconsole.world.rules.speed_advice import DOWN_MPS2

HZ = 250
EXACT = RoadHabits(aim_deviation_m=0.0, hand_deviation_deg=0.0)
PLAN = PersonPlan(along="route", cruise_kmh=130.0, road=EXACT)


@cache
def route(world: str) -> Route:
    return open_world(load_world(world)).route


class Seated:
    """Somebody whose car is where the test puts it."""

    def __init__(self, plan: PersonPlan = PLAN, world: str = "urban") -> None:
        self.route = route(world)
        self.guidance = AlongRoute(plan, self.route, HZ)
        self.time_s = 0.0

    def at(self, s_m: float, speed_mps: float, situation: Situation = NOTHING_AHEAD, lateral_m: float = 0.0) -> View:
        point = self.route.at(s_m)
        x_m = point.x_m - lateral_m * math.sin(point.yaw_rad)
        y_m = point.y_m + lateral_m * math.cos(point.yaw_rad)
        mode = float(Mode.MANUAL)
        return View(self.time_s, x_m, y_m, point.yaw_rad, speed_mps, s_m, 170.0, 1.0, 3.0, mode, situation=situation)

    def pace(self, s_m: float, speed_mps: float, situation: Situation = NOTHING_AHEAD, seconds: float = 2.0) -> Pace:
        view = self.at(s_m, speed_mps, situation)
        for _ in range(round(seconds * HZ)):
            self.guidance.look(view)
        return self.guidance.pace(view)


def test_a_free_straight_is_driven_just_below_its_limit_and_a_bend_as_slowly_as_it_needs() -> None:
    seated = Seated()
    free = seated.pace(100.0, 13.0)
    assert free.brake == 0.0
    assert 12.0 < free.target_mps < 50.0 / 3.6
    tight = Seated().pace(618.0, 4.5)
    assert tight.target_mps < math.sqrt(12.0 * EXACT.lateral_mps2) + 0.5
    assert Seated().pace(585.0, 13.0).brake > 0.0


def test_nobody_drives_faster_than_they_like() -> None:
    slow = PersonPlan(along="route", cruise_kmh=30.0, road=EXACT)
    assert Seated(slow).pace(100.0, 8.0).target_mps == pytest.approx(30.0 / 3.6)


def test_who_is_far_below_the_speed_lets_the_engine_work() -> None:
    assert Seated().pace(100.0, 5.0).hurried
    assert not Seated().pace(100.0, 12.5).hurried


@pytest.mark.parametrize(
    "situation",
    [
        Situation(lead_gap_m=8.0, lead_speed_mps=3.0),
        Situation(light=float(Light.RED), line_m=20.0),
        Situation(light=float(Light.AMBER), line_m=35.0),
        Situation(yield_m=20.0),
    ],
)
def test_what_is_in_the_way_is_braked_for_once_the_person_has_reacted(situation: Situation) -> None:
    seated = Seated()
    assert seated.pace(100.0, 12.0).brake == 0.0
    assert seated.pace(100.0, 12.0, situation, 0.7 * EXACT.reaction_s).brake == 0.0
    assert seated.pace(100.0, 12.0, situation, 0.5 * EXACT.reaction_s).brake > 0.0


def test_at_a_line_the_person_waits_on_the_brake_and_goes_when_it_is_green() -> None:
    seated = Seated()
    assert seated.pace(100.0, 0.0, Situation(light=float(Light.RED), line_m=EXACT.gap_m)) == Pace(0.0, HOLD_BRAKE)
    gone = seated.pace(100.0, 0.0, Situation(light=float(Light.GREEN), line_m=EXACT.gap_m))
    assert gone.brake == 0.0
    assert gone.target_mps > 1.0


@pytest.mark.parametrize("light", [Light.RED, Light.AMBER])
@pytest.mark.parametrize("speed_mps", [6.0, 13.0])
def test_a_car_on_the_way_stops_before_the_line_although_the_light_is_seen_late(light: Light, speed_mps: float) -> None:
    seated, s_m, line_m = Seated(), 100.0, 160.0
    for _ in range(40 * HZ):
        view = seated.at(s_m, speed_mps, Situation(light=float(light), line_m=line_m - s_m))
        seated.guidance.look(view)
        pace = seated.guidance.pace(view)
        accel = -FULL_BRAKE_MPS2 * pace.brake - COAST_MPS2 if pace.brake else min(1.5, pace.target_mps - speed_mps)
        speed_mps = max(0.0, speed_mps + accel / HZ)
        s_m += speed_mps / HZ
    assert speed_mps < 0.05
    assert 0.5 < line_m - s_m < EXACT.gap_m + 2.0


def test_advice_is_followed_gently_once_the_person_has_reacted_and_never_drives_faster() -> None:
    seated, slower = Seated(), Situation(advised_mps=8.0)
    free = seated.pace(100.0, 12.0)
    assert seated.pace(100.0, 12.0, slower, 0.7 * EXACT.reaction_s) == free
    followed = seated.pace(100.0, 12.0, slower, 0.5 * EXACT.reaction_s)
    assert followed.brake == pytest.approx((DOWN_MPS2 - COAST_MPS2) / FULL_BRAKE_MPS2)
    assert Seated().pace(100.0, 8.0, slower) == Pace(8.0, 0.0)
    assert Seated().pace(100.0, 12.0, Situation(advised_mps=30.0)) == free
    stubborn = PersonPlan(along="route", cruise_kmh=130.0, road=msgspec.structs.replace(EXACT, follows_advice=False))
    assert Seated(stubborn).pace(100.0, 12.0, slower) == free


def test_small_decelerations_need_no_brake() -> None:
    target = Seated().pace(100.0, 13.4)
    assert target.brake == 0.0
    assert target.target_mps < 13.4 + COAST_MPS2


def test_steering_is_late_and_leads_back() -> None:
    seated = Seated()
    for _ in range(HZ):
        middle = seated.at(100.0, 10.0)
        seated.guidance.look(middle)
        assert seated.guidance.steer(middle) == pytest.approx(0.0, abs=1e-6)
    aside = seated.at(100.0, 10.0, lateral_m=0.5)
    angles = []
    for _ in range(HZ):
        seated.guidance.look(aside)
        angles.append(seated.guidance.steer(aside))
    late = round(EXACT.visual_delay_s * HZ)
    assert angles[late - 1] == pytest.approx(0.0, abs=1e-6)
    assert angles[late + 1] < -0.01


def test_two_persons_differ_and_one_is_like_itself() -> None:
    def hands(seed: int) -> list[float]:
        seated, angles = Seated(PersonPlan(along="route", seed=seed)), []
        for tick in range(5 * HZ):
            seated.time_s = tick / HZ
            view = seated.at(100.0, 12.0)
            seated.guidance.look(view)
            angles.append(seated.guidance.steer(view))
        return angles

    assert hands(3) == hands(3)
    assert max(abs(one - other) for one, other in zip(hands(3), hands(4), strict=True)) > 0.005


def test_an_open_route_ends_at_its_end_and_a_closed_one_after_a_lap() -> None:
    opened = Seated(world="skid_pad")
    length_m = opened.route.length_m
    for s_m, there in ((0.0, False), (0.5 * length_m, False), (length_m - 1.0, True)):
        opened.guidance.look(opened.at(s_m, 5.0))
        assert opened.guidance.arrived(opened.at(s_m, 5.0)) is there
    for plan, ends in ((PLAN, True), (PersonPlan(along="route", stop=When(distance_m=1e5)), False)):
        lap = Seated(plan)
        for place in range(28):
            view = lap.at(100.0 * place, 10.0)
            lap.guidance.look(view)
        assert lap.guidance.arrived(view) is ends
