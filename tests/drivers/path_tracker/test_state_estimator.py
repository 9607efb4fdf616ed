import math

import numpy as np
import pytest

from simconsole.drivers.path_tracker.state_estimator import StateEstimator, VehicleMotion
from simconsole.drivers.path_tracker.tracker_settings import HATCHBACK, Timing
from tests.samples import Sample

PERIOD_S = 0.02


def on_circle(time_s: float, speed: float = 10.0, rate: float = 0.2) -> VehicleMotion:
    """A car that drives a circle, without slip."""
    yaw = rate * time_s
    return VehicleMotion(
        x_m=speed / rate * math.sin(yaw),
        y_m=speed / rate * (1.0 - math.cos(yaw)),
        yaw_rad=yaw,
        vx_mps=speed,
        vy_mps=0.0,
        yaw_rate_radps=rate,
    )


def test_white_noise_is_reduced_to_a_fifth(sample: Sample) -> None:
    rng = np.random.default_rng(sample.seed)
    estimator, errors = StateEstimator(HATCHBACK, Timing(delay_s=0.0)), []
    for step in range(1, 3000):
        true = on_circle(step * PERIOD_S)
        noise = rng.normal(size=3)
        seen = true._replace(
            x_m=true.x_m + 0.02 * noise[0],
            y_m=true.y_m + 0.02 * noise[1],
            yaw_rad=true.yaw_rad + math.radians(0.2) * noise[2],
        )
        found = estimator.observe(seen, step * PERIOD_S, 0.0).motion
        estimator.sent(0.0)
        errors.append((found.x_m - true.x_m, found.y_m - true.y_m, found.yaw_rad - true.yaw_rad))
    x, y, yaw = np.std(errors[500:], axis=0)
    assert max(x, y) < 0.02 / 5.0
    assert yaw < math.radians(0.2) / 5.0


@pytest.mark.parametrize("delay_s", [0.0, 0.013, 0.04, 0.1])
def test_a_steady_circle_is_predicted_through_the_delay(delay_s: float) -> None:
    estimator = StateEstimator(HATCHBACK, Timing(delay_s=delay_s))
    speed, rate = 10.0, 0.2
    slip = speed * rate * HATCHBACK.front_m * HATCHBACK.mass_kg / HATCHBACK.wheelbase_m  # rear axle's side force
    across = -speed * slip / HATCHBACK.rear_stiffness_nprad  # vy of base_link by the linear single track
    wheel = rate / speed * (HATCHBACK.wheelbase_m + HATCHBACK.understeer_radps2pm * speed * speed)
    estimator.reset(wheel)
    found = None
    for step in range(1, 40):
        time_s = step * PERIOD_S
        yaw = rate * time_s
        beta = math.atan2(across, speed)
        radius = math.hypot(speed, across) / rate
        seen = VehicleMotion(
            x_m=radius * math.sin(yaw + beta),
            y_m=-radius * math.cos(yaw + beta),
            yaw_rad=yaw,
            vx_mps=speed,
            vy_mps=across,
            yaw_rate_radps=rate,
        )
        found = estimator.observe(seen, time_s, 0.0)
        estimator.sent(wheel)
        later = rate * (time_s + delay_s)
        assert found.motion.x_m == pytest.approx(radius * math.sin(later + beta), abs=2e-3)
        assert found.motion.y_m == pytest.approx(-radius * math.cos(later + beta), abs=2e-3)
        assert found.motion.yaw_rad == pytest.approx(later, abs=1e-4)
        assert found.wheel == pytest.approx(wheel)
    assert found is not None


def test_wheels_follow_the_commands_under_way_and_no_others() -> None:
    estimator = StateEstimator(HATCHBACK, Timing(delay_s=0.04))
    estimator.reset(0.0)
    standing = VehicleMotion(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert estimator.observe(standing, 0.0, 0.0).wheel == 0.0
    estimator.sent(0.1)  # acts at 0.04
    assert estimator.observe(standing, 0.02, 0.0).wheel == pytest.approx(
        0.1 * (1.0 - math.exp(-0.02 / HATCHBACK.steering_lag_s))
    )
    estimator.sent(0.1)
    found = estimator.observe(standing, 0.06, 0.0)  # one measurement was lost
    assert found.wheel == pytest.approx(0.1 * (1.0 - math.exp(-0.06 / HATCHBACK.steering_lag_s)))


def test_a_lost_measurement_is_bridged_and_a_jump_believed() -> None:
    estimator = StateEstimator(HATCHBACK, Timing(delay_s=0.0))
    for time_s in (0.02, 0.04, 0.06, 0.14, 0.16):
        true = on_circle(time_s)
        found = estimator.observe(true, time_s, 0.0).motion
        assert (found.x_m, found.y_m) == pytest.approx((true.x_m, true.y_m), abs=1e-3)
    elsewhere = on_circle(3.0)
    assert estimator.observe(elsewhere, 0.18, 0.0).motion[:3] == elsewhere[:3]


def test_drifting_positions_are_followed_although_the_yaw_is_wrong(sample: Sample) -> None:
    """The estimate goes where the measured positions go: what is to be driven to lies among them."""
    rng = np.random.default_rng(sample.seed)
    estimator, errors = StateEstimator(HATCHBACK, Timing(delay_s=0.0)), []
    wrong = math.radians(0.5)
    for step in range(1, 3000):
        true = on_circle(step * PERIOD_S)
        drift_m = 0.03 * step * PERIOD_S
        noise = rng.normal(size=2)
        seen = true._replace(
            x_m=true.x_m + drift_m + 0.02 * noise[0],
            y_m=true.y_m + 0.02 * noise[1],
            yaw_rad=true.yaw_rad + wrong,
        )
        found = estimator.observe(seen, step * PERIOD_S, 0.0).motion
        estimator.sent(0.0)
        errors.append((found.x_m - true.x_m - drift_m, found.y_m - true.y_m, found.yaw_rad - true.yaw_rad))
    x, y, yaw = np.array(errors[500:]).T
    assert np.hypot(x, y).max() < 0.025  # 0.05 m and more where the yaw is believed
    assert abs(yaw.mean()) < 0.1 * wrong
