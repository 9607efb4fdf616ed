"""Environments of gymnasium: the library's own checker, seeds, rewards, ends, processes, the gate."""

import warnings
from typing import Any

import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import simconsole
from simconsole import DrivingEnvironment, vector_environment
from simconsole.cli.api.environment import LEFT_LANE
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Mode
from simconsole.world.lane_view import MOST, LaneView

STRAIGHT = np.zeros(1, np.float32)


def held(seen: np.ndarray) -> np.ndarray:
    """A law that holds the lane."""
    view = LaneView(*seen.tolist())
    wheel = -0.08 * view.lateral_m - 0.6 * view.heading_rad + 2.6 * view.curvature_5m_1pm
    return np.array([wheel / 0.4], np.float32)


@pytest.fixture(scope="module")
def environment() -> DrivingEnvironment:
    return DrivingEnvironment(speed_mps=8.0, longest_s=20.0)


@pytest.mark.parametrize("options", [{"speed_mps": 8.0}, {}])
def test_the_checker_of_gymnasium_passes_it(options: dict[str, Any]) -> None:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        check_env(DrivingEnvironment(longest_s=5.0, **options), skip_render_check=True)
    assert [str(warning.message) for warning in told if "spec" not in str(warning.message)] == []


def episode(environment: DrivingEnvironment, seed: int, law: Any = held) -> tuple[list[float], list[np.ndarray], bool]:
    seen, _ = environment.reset(seed=seed)
    rewards, views, terminated, truncated = [], [seen], False, False
    while not (terminated or truncated):
        seen, reward, terminated, truncated, _ = environment.step(law(seen))
        rewards.append(float(reward))
        views.append(seen)
    return rewards, views, terminated


def test_equal_seeds_are_equal_episodes_and_others_are_others(environment: DrivingEnvironment) -> None:
    first, second, other = (episode(environment, seed) for seed in (5, 5, 6))
    assert np.array_equal(first[1], second[1])
    assert first[0] == second[0]
    assert not np.array_equal(first[1][0], other[1][0])


def test_who_holds_the_lane_collects_the_way_and_is_truncated(environment: DrivingEnvironment) -> None:
    rewards, views, terminated = episode(environment, 3)
    assert not terminated
    assert len(rewards) == 200
    assert max(abs(view[1]) for view in views) < 1.0
    assert 80.0 < sum(rewards) < 160.0  # of at most 8 m/s for 20 s, from standstill
    assert views[-1][0] == pytest.approx(8.0, abs=0.5)


def test_who_leaves_the_lane_is_told_so_at_once(environment: DrivingEnvironment) -> None:
    rewards, views, terminated = episode(environment, 3, lambda seen: np.ones(1, np.float32))
    assert terminated
    assert rewards[-1] == LEFT_LANE
    assert abs(views[-1][1]) > 1.75 or environment.snapshot.arbitration.mode != Mode.AUTONOMOUS
    assert all(abs(view[1]) <= 1.75 for view in views[:-1])


def test_an_episode_begins_engaged_where_it_is_told_to(environment: DrivingEnvironment) -> None:
    seen, info = environment.reset(seed=1, options={"s_m": 120.0})
    view = LaneView(*seen.tolist())
    assert info["s_m"] == pytest.approx(120.0, abs=0.5)
    assert (view.speed_mps, environment.snapshot.arbitration.mode) == (pytest.approx(0.0, abs=0.05), Mode.AUTONOMOUS)
    assert abs(view.lateral_m) <= 0.41
    assert abs(view.heading_rad) <= 0.031


def test_places_are_spread_over_the_route(environment: DrivingEnvironment) -> None:
    places = [environment.reset(seed=seed)[1]["s_m"] for seed in range(12)]
    assert max(places) - min(places) > 0.5 * 2600.0


def test_an_action_passes_the_gate_like_any_other_command() -> None:
    """Full lock at once: the road wheels turn no faster than the gate lets automation turn them."""
    environment = DrivingEnvironment(step_ms=20)
    environment.reset(seed=2)
    environment.step(np.array([1.0, 0.0], np.float32))
    assert environment.snapshot.ros.road_wheel_rad == pytest.approx(0.4)
    assert 0.0 < environment.snapshot.command.road_wheel_rad <= 0.02 + 1e-9  # 1 rad/s for 20 ms


def test_with_two_actions_the_second_is_the_acceleration() -> None:
    environment = DrivingEnvironment()
    environment.reset(seed=2, options={"s_m": 5.0})
    for _ in range(20):
        seen, *_ = environment.step(np.array([0.0, 1.0], np.float32))
    assert seen[0] == pytest.approx(2.3, abs=0.5)  # it creeps off by its clutch first
    for _ in range(20):
        seen, *_ = environment.step(np.array([0.0, -1.0], np.float32))
    assert seen[0] == pytest.approx(0.0, abs=0.1)


def test_an_observation_is_never_out_of_its_bounds() -> None:
    environment = DrivingEnvironment(half_lane_m=1e9, longest_s=60.0)
    environment.reset(seed=4)
    for _ in range(300):
        seen, *_ = environment.step(np.array([0.5, 1.0], np.float32))
        assert environment.observation_space.contains(seen)
    assert (np.abs(seen) <= np.array(MOST)).all()


@pytest.mark.parametrize("step_ms", [0, 3, 204])
def test_a_step_is_a_whole_number_of_ticks(step_ms: int) -> None:
    with pytest.raises(ProfileError, match=f"step_ms: value {step_ms}"):
        DrivingEnvironment(step_ms=step_ms)


def test_what_it_has_not_is_refused() -> None:
    with pytest.raises(ProfileError, match=r"environment\.world"):
        DrivingEnvironment("roll_a_ball")
    session = simconsole.load("bridge").with_values({"environment.world": "urban_signals", "environment.traffic": {}})
    with pytest.raises(ProfileError, match=r"environment\.traffic"):
        DrivingEnvironment(session)
    person = simconsole.load("bridge").with_values({"features.control.person_required": True})
    with pytest.raises(ProfileError, match="person_required"):
        DrivingEnvironment(person).reset(seed=1)


def test_many_in_processes_of_their_own_are_as_one_alone(environment: DrivingEnvironment) -> None:
    many = vector_environment(2, speed_mps=8.0, longest_s=20.0)
    try:
        seen, _ = many.reset(seed=[7, 8])
        rows = [[row] for row in seen]
        for _ in range(30):
            seen, *_ = many.step(np.zeros((2, 1), np.float32))
            for row, views in zip(seen, rows, strict=True):
                views.append(row)
    finally:
        many.close()
    for seed, views in zip((7, 8), rows, strict=True):
        alone = [environment.reset(seed=seed)[0], *(environment.step(STRAIGHT)[0] for _ in range(30))]
        kept = next((at for at, view in enumerate(alone) if abs(view[1]) > 1.75), len(alone))  # then it begins anew
        assert kept > 10
        assert np.array_equal(np.array(views[:kept]), np.array(alone[:kept]))
