"""What fixed things do to a vehicle that runs into them, also over many ticks."""

import math

import numpy as np
import pytest

from simconsole.values.host.jit import compiled, plain
from simconsole.values.layout import read, write
from simconsole.values.signals import NO_OBSTACLE_TOUCHED, ObstacleImpact, VehicleState
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.world.obstacles.impulse import FRICTION, RESTITUTION
from simconsole.world.obstacles.sides import Body, FixedThings, fixed_things
from simconsole.world.obstacles.striking import OUT_MPS, strike, struck_by
from simconsole.world.roads.road_map import BUILDING, CONE, WALL, Obstacle
from tests.bits import difference
from tests.samples import Sample
from tests.world.nets import straight_map

MASS_KG, INERTIA_KGM2 = 1400.0, 2000.0
BODY = Body(
    half_length_m=2.0,
    half_width_m=0.9,
    middle_ahead_m=1.4,
    cg_ahead_m=1.3,
    per_kg=1.0 / MASS_KG,
    per_kgm2=1.0 / INERTIA_KGM2,
)
FRONT_M = 3.4
HOUSE = ((20.0, -10.0), (30.0, -10.0), (30.0, 10.0), (20.0, 10.0))
STANDING = VehicleState(*(0.0,) * len(VehicleState._fields))
TICK_S = 0.004


def things(*corners: tuple[float, float], kind: str = BUILDING, body: Body = BODY) -> FixedThings:
    return fixed_things([Obstacle(kind, np.array(corners))], straight_map().lanes, body)


def vehicle(x_m: float, y_m: float = 0.0, yaw_rad: float = 0.0, vx_mps: float = 10.0) -> VehicleState:
    return STANDING._replace(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad, vx_mps=vx_mps)


class Slider:
    """A body without tyres: it moves on as it moves, and is pushed forward by its own acceleration."""

    def __init__(self, state: VehicleState, fixed: FixedThings) -> None:
        self.state, self.fixed, self.struck = state, fixed, list[ObstacleImpact]()

    def go(self, ticks: int, push_mps2: float = 0.0) -> VehicleState:
        for _ in range(ticks):
            found = struck_by(self.state, self.struck[-1].touches if self.struck else 0.0, self.fixed)
            self.struck.append(found)
            self._move(found, push_mps2)
        return self.state

    def _move(self, found: ObstacleImpact, push_mps2: float) -> None:
        s, b = self.state, BODY.cg_ahead_m
        vx = s.vx_mps + found.vx_mps + push_mps2 * TICK_S
        vy, turn = s.vy_mps + b * s.yaw_rate_radps + found.vy_mps, s.yaw_rate_radps + found.yaw_rate_radps
        cosine, sine = math.cos(s.yaw_rad), math.sin(s.yaw_rad)
        dx, dy = (vx * cosine - vy * sine) * TICK_S, (vx * sine + vy * cosine) * TICK_S
        x, y = s.x_m + b * cosine + dx, s.y_m + b * sine + dy
        yaw = s.yaw_rad + turn * TICK_S
        turned = math.cos(yaw - s.yaw_rad), math.sin(yaw - s.yaw_rad)
        vx, vy = vx * turned[0] + vy * turned[1], vy * turned[0] - vx * turned[1]
        self.state = s._replace(
            x_m=x - b * math.cos(yaw),
            y_m=y - b * math.sin(yaw),
            yaw_rad=yaw,
            vx_mps=vx,
            vy_mps=vy - b * turn,
            yaw_rate_radps=turn,
        )


def test_who_has_room_is_not_touched() -> None:
    for x_m in (-500.0, 0.0, 20.0 - FRONT_M - 0.001, 40.0, 5000.0, math.nan):
        assert struck_by(vehicle(x_m), 0.0, things(*HOUSE)) == NO_OBSTACLE_TOUCHED
    assert struck_by(vehicle(18.0), 0.0, fixed_things([], straight_map().lanes, BODY)) == NO_OBSTACLE_TOUCHED


def test_head_on_the_speed_turns_round_but_for_the_restitution_without_a_turn() -> None:
    found = struck_by(vehicle(20.0 - FRONT_M + 0.03), 0.0, things(*HOUSE))
    assert found.touches == 1.0
    assert found.vx_mps == pytest.approx(-(1.0 + RESTITUTION) * 10.0)
    assert (found.vy_mps, found.yaw_rate_radps) == pytest.approx((0.0, 0.0), abs=1e-9)


@pytest.mark.parametrize("left", [1.0, -1.0])
def test_who_strikes_with_one_side_turns_to_it(left: float) -> None:
    low, high = sorted((0.4 * left, 10.0 * left))
    house = ((20.0, low), (30.0, low), (30.0, high), (20.0, high))
    found = struck_by(vehicle(20.0 - FRONT_M + 0.02), 0.0, things(*house))
    assert -10.9 < found.vx_mps < -5.0
    assert found.yaw_rate_radps * left > 0.5


@pytest.mark.parametrize("deep_m", [0.01, 0.3, 1.0])
def test_a_wall_without_thickness_and_a_post_hold_up_too(deep_m: float) -> None:
    front = 20.0 - FRONT_M + deep_m
    wall = struck_by(vehicle(front), 0.0, things((20.0, -5.0), (20.0, 5.0), kind=WALL))
    assert wall.vx_mps == pytest.approx(-11.0)
    post = struck_by(vehicle(front), 0.0, things((20.0, -0.1), (20.2, -0.1), (20.2, 0.1), (20.0, 0.1)))
    assert post.vx_mps == pytest.approx(-11.0, abs=0.1)


def test_who_moves_away_is_not_held() -> None:
    assert struck_by(vehicle(20.0 - FRONT_M + 0.1, vx_mps=-0.5), 0.0, things(*HOUSE)) == NO_OBSTACLE_TOUCHED
    behind = vehicle(30.0 + 0.6 - 0.05, vx_mps=-4.0)  # its rear overhang is 0.6 m
    assert struck_by(behind, 0.0, things(*HOUSE)).vx_mps == pytest.approx(4.4)
    assert struck_by(behind._replace(vx_mps=4.0), 0.0, things(*HOUSE)) == NO_OBSTACLE_TOUCHED


def test_along_a_wall_friction_takes_speed_and_the_far_end_does_not_catch() -> None:
    wall = things((0.0, 0.88), (60.0, 0.88), (60.0, 4.0), (0.0, 4.0))
    found = struck_by(vehicle(20.0, yaw_rad=0.0)._replace(vy_mps=1.0), 0.0, wall)
    assert found.vy_mps == pytest.approx(-(1.0 + RESTITUTION), abs=0.05)
    assert found.vx_mps == pytest.approx(FRICTION * found.vy_mps, abs=0.05)
    entering = struck_by(vehicle(-FRONT_M + 0.5)._replace(vy_mps=0.1), 0.0, wall)
    assert entering.vx_mps > -1.0, "two centimetres of its end are not the wall"


def test_between_two_houses_both_push() -> None:
    rows = [
        Obstacle(BUILDING, np.array(((0.0, side * 0.88), (60.0, side * 0.88), (60.0, side * 4.0), (0.0, side * 4.0))))
        for side in (1.0, -1.0)
    ]
    fixed = fixed_things(rows, straight_map().lanes, BODY)
    for sideways in (1.0, -1.0):
        found = struck_by(vehicle(20.0)._replace(vy_mps=sideways), 0.0, fixed)
        assert found.touches == 1.0
        assert abs(sideways + found.vy_mps) < 0.2


def test_a_cone_takes_little_and_only_once() -> None:
    cone = things((20.0, -0.15), (20.3, -0.15), (20.3, 0.15), (20.0, 0.15), kind=CONE)
    found = struck_by(vehicle(20.0 - FRONT_M + 0.03), 0.0, cone)
    assert -0.04 < found.vx_mps < -0.02
    assert struck_by(vehicle(20.0 - FRONT_M + 0.07), 1.0, cone) == NO_OBSTACLE_TOUCHED._replace(touches=1.0)
    driven = Slider(vehicle(10.0), cone)
    driven.go(1000)
    touched = np.array([one.touches for one in driven.struck])
    assert np.count_nonzero(np.diff(touched, prepend=0.0) > 0.0) == 1
    assert driven.state.vx_mps > 9.95


def test_a_vehicle_that_takes_no_impulse_is_told_of_the_touch() -> None:
    ball = BODY._replace(per_kg=0.0, per_kgm2=0.0, cg_ahead_m=0.0)
    found = struck_by(vehicle(20.0 - FRONT_M + 0.03), 0.0, things(*HOUSE, body=ball))
    assert found == NO_OBSTACLE_TOUCHED._replace(touches=1.0)


@pytest.mark.parametrize("yaw_deg", [0.0, 5.0, 30.0, 60.0])
def test_an_engine_does_not_press_it_through_a_wall(yaw_deg: float) -> None:
    pushed = Slider(vehicle(12.0, yaw_rad=math.radians(yaw_deg), vx_mps=3.0), things(*HOUSE))
    deepest = 0.0
    for _ in range(100):
        s = pushed.go(50, push_mps2=5.0)
        ahead, aside = BODY.middle_ahead_m + BODY.half_length_m, BODY.half_width_m
        corners = [
            (
                s.x_m + x * math.cos(s.yaw_rad) - y * math.sin(s.yaw_rad),
                s.y_m + x * math.sin(s.yaw_rad) + y * math.cos(s.yaw_rad),
            )
            for x in (ahead, ahead - 2.0 * BODY.half_length_m)
            for y in (aside, -aside)
        ]
        beside = max(abs(y) for _, y in corners) > 9.0
        deepest = max([deepest, *(0.0 if beside else x - 20.0 for x, _ in corners if 20.0 < x < 25.0)])
    print(f"measured: at most {100.0 * deepest:.1f} cm deep in 20 s")
    assert deepest < 0.15


def test_energy_is_not_made_but_for_leaving(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    touched = 0
    for _ in range(sample.of(300, 20_000)):
        house = rng.uniform((10.0, -10.0), (30.0, 10.0)) + rng.normal(0.0, 3.0, (5, 2))
        state = vehicle(
            rng.uniform(8.0, 32.0), rng.uniform(-10.0, 10.0), rng.uniform(-3.2, 3.2), rng.uniform(-20.0, 20.0)
        )
        state = state._replace(vy_mps=rng.uniform(-5.0, 5.0), yaw_rate_radps=rng.uniform(-2.0, 2.0))
        fixed = things(*map(tuple, house.tolist()))
        found = struck_by(state, 0.0, fixed)
        vx, vy = state.vx_mps, state.vy_mps + BODY.cg_ahead_m * state.yaw_rate_radps
        before = MASS_KG * (vx**2 + vy**2) + INERTIA_KGM2 * state.yaw_rate_radps**2
        turn = state.yaw_rate_radps + found.yaw_rate_radps
        after = MASS_KG * ((vx + found.vx_mps) ** 2 + (vy + found.vy_mps) ** 2) + INERTIA_KGM2 * turn**2
        assert after <= before + MASS_KG * OUT_MPS**2
        touched += found.touches > 0.0
    assert touched > 5


def test_both_executions_write_equal_bits(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    some = [Obstacle(BUILDING, rng.uniform(0.0, 40.0, 2) + rng.normal(0.0, 4.0, (4, 2))) for _ in range(20)]
    fixed = fixed_things(some, straight_map().lanes, BODY)
    slow, quick = plain(strike), compiled(strike)
    touched = 0
    for _ in range(sample.of(300, 20_000)):
        previous = np.zeros(PLATFORM_AT)
        state = vehicle(*rng.uniform((-10.0, -10.0, -3.2, -20.0), (50.0, 50.0, 3.2, 20.0)).tolist())
        write(previous, LAYOUT.vehicle, state)
        one, other = np.zeros(PLATFORM_AT), np.zeros(PLATFORM_AT)
        slow(previous, one, fixed)
        quick(previous, other, fixed)
        assert not difference(one, other)
        touched += read(one, LAYOUT.obstacle).touches > 0.0
    assert touched > 20
