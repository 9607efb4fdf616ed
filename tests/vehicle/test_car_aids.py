"""ABS, stability control, traction control and hill hold do what they are for, and can be switched off."""

import math

import pytest

from simconsole.units import MPS_PER_KMH, STANDARD_GRAVITY_MPS2
from simconsole.vehicle.platform import Ground

from .driving import TICK_S, Drive, platform
from .rolling import RADIUS_M, rolling

RATIO = 15.5
CG_TO_REAR_M = 1.56


def least_spin(drive: Drive) -> float:
    """Return the slowest wheel's circumferential speed as a share of the car's."""
    s = drive.state
    return float(min(s.fl_radps, s.fr_radps, s.rl_radps, s.rr_radps) * RADIUS_M / s.vx_mps)


def stop(anti_lock: bool) -> tuple[float, float]:
    """Brake fully from 100 km/h; return the distance and the least spin above 10 km/h."""
    drive = rolling(100.0 * MPS_PER_KMH, anti_lock=anti_lock)
    least = 1.0
    while drive.seen.vx_mps > 0.0:
        drive.hold(TICK_S, brake=1.0, clutch=1.0)
        if drive.state.vx_mps > 10.0 * MPS_PER_KMH:
            least = min(least, least_spin(drive))
    return drive.seen.x_m, least


def test_anti_lock_stops_shorter_than_locked_wheels_and_lets_none_lock() -> None:
    with_m, with_least = stop(True)
    without_m, without_least = stop(False)
    print(
        f"100-0 km/h: {with_m:.1f} m, wheels at least {with_least:.2f}; locked {without_m:.1f} m, {without_least:.2f}"
    )
    assert 34.0 < with_m < 46.0
    assert with_m < without_m - 1.0
    assert with_least > 0.5
    assert without_least == 0.0


def split(anti_lock: bool) -> tuple[float, float]:
    """Brake on mu 1.0 / 0.3 with a steering driver; return the greatest offset in m and yaw in deg."""
    drive = rolling(100.0 * MPS_PER_KMH, Ground(1.0, 0.0, 0.0, 0.3), anti_lock=anti_lock)
    offset = yaw = 0.0
    while drive.seen.vx_mps > 0.3:
        seen = drive.seen
        wanted = -0.12 * (seen.y_m + 1.3 * seen.yaw_rad) - 0.9 * seen.yaw_rad - 0.25 * seen.yaw_rate_radps
        drive.hold(0.02, brake=1.0, clutch=1.0, road_wheel_rad=max(-0.5, min(0.5, wanted)))
        offset, yaw = max(offset, abs(drive.seen.y_m)), max(yaw, math.degrees(abs(drive.seen.yaw_rad)))
    return offset, yaw


def test_split_friction_is_held_with_anti_lock_only() -> None:
    offset, yaw = split(True)
    print(f"split friction: {offset:.2f} m aside, {yaw:.1f} deg")
    assert offset < 1.0
    assert yaw < 6.0
    assert split(False)[1] > 6.0


def slowly_increasing() -> float:
    """Return A in deg at the hand wheel: what gives 0.3 g at 80 km/h, turning at 13.5 deg/s (FMVSS 126)."""
    drive = rolling(80.0 * MPS_PER_KMH)
    hand = 0.0
    while abs(drive.seen.ay_mps2) < 0.3 * STANDARD_GRAVITY_MPS2:
        hand += 13.5 * TICK_S
        drive.hold(TICK_S, road_wheel_rad=math.radians(hand) / RATIO, clutch=1.0)
    return hand


def sine_with_dwell(hand_deg: float, stability_control: bool) -> tuple[float, float, float]:
    """Return the yaw-rate ratios 1.0 and 1.75 s after the end of steer, and the displacement 1.07 s after its begin."""
    drive = rolling(80.0 * MPS_PER_KMH, stability_control=stability_control)
    peak, late, displaced = 0.0, [], 0.0
    end = 1.0 / 0.7 + 0.5
    for tick in range(round((end + 1.75) / TICK_S)):
        t = tick * TICK_S
        wave = math.sin(2.0 * math.pi * 0.7 * t)
        if t > 0.75 / 0.7:
            wave = -1.0 if t < 0.75 / 0.7 + 0.5 else math.sin(2.0 * math.pi * 0.7 * (t - 0.5))
        seen = drive.hold(
            TICK_S, clutch=1.0, road_wheel_rad=math.radians(hand_deg) / RATIO * (wave if t < end else 0.0)
        )
        if 0.5 / 0.7 < t < end:
            peak = max(peak, abs(seen.yaw_rate_radps))
        if t <= 1.07:
            displaced = abs(seen.y_m + CG_TO_REAR_M * seen.yaw_rad)
        if t >= end + 1.0 - TICK_S:
            late.append(abs(seen.yaw_rate_radps))
    return late[0] / peak, late[-1] / peak, displaced


def test_sine_with_dwell_passes_with_stability_control_and_fails_without() -> None:
    unit = slowly_increasing()
    for angle in [*(factor * unit for factor in (1.5, 2.5, 3.5, 4.5, 5.0, 5.5, 6.0, 6.5)), 225.0, 270.0]:
        after_1, after_175, displaced = sine_with_dwell(angle, True)
        print(f"{angle:.0f} deg ({angle / unit:.1f} A): {after_1:.3f}, {after_175:.3f}, {displaced:.2f} m")
        assert after_1 < 0.35
        assert after_175 < 0.20
        assert displaced > 1.83 or angle < 5.0 * unit
    assert sine_with_dwell(6.5 * unit, False)[0] > 0.35


def test_traction_control_keeps_the_driven_wheels_near_the_road() -> None:
    spins = []
    for on in (True, False):
        drive = rolling(3.0, Ground(0.3, 0.0, 0.0), traction_control=on)
        most = 0.0
        for _ in range(500):
            drive.hold(TICK_S, automatic=1, gear=1, throttle=1.0)
            most = max(most, drive.state.fl_radps * RADIUS_M - drive.state.vx_mps)
        spins.append((most, drive.seen.vx_mps))
    print(f"spin, speed with and without: {spins}")
    assert spins[0][0] < 0.6 * spins[1][0]
    assert spins[0][1] > 0.95 * spins[1][1]


@pytest.mark.parametrize("hill_hold", [True, False])
def test_hill_hold_gives_two_seconds(hill_hold: bool) -> None:
    drive = rolling(0.0, Ground(1.0, 0.15, 0.0), hill_hold=hill_hold)
    drive.hold(1.0, brake=0.5)
    rolled = -drive.hold(1.8).x_m
    assert (rolled < 0.01) == hill_hold
    assert drive.hold(2.0).vx_mps < -1.0


def test_hands_off_at_standstill_the_rim_is_quiet_and_in_bends_it_is_light() -> None:
    drive = Drive(platform())
    torques = [drive.hold(TICK_S, brake=0.3).hand_wheel_torque_nm for _ in range(1000)]
    assert max(torques) - min(torques) < 0.2
    drive = rolling(20.0)
    most = 0.0
    for tick in range(1000):
        seen = drive.hold(TICK_S, automatic=1, gear=1, throttle=0.3, road_wheel_rad=0.04 * math.sin(0.01 * tick))
        most = max(most, abs(seen.hand_wheel_torque_nm))
    print(f"at most {most:.1f} N m")
    assert 1.0 < most < 12.0
