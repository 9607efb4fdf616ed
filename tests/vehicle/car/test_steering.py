"""The torque at the rim: what the hands are told of the tyres, on the whole car."""

import math

import pytest

from simconsole.values.platform import Ground
from tests.vehicle.driving import TICK_S, Drive, platform
from tests.vehicle.rolling import rolling


@pytest.mark.parametrize("speed_mps", [3.0, 15.0, 30.0])
def test_it_turns_the_wheel_back_to_the_middle_and_is_mirrored(speed_mps: float) -> None:
    angle = min(0.2, 3.0 * 2.6 / speed_mps**2)  # 3 m/s2
    left, right = (rolling(speed_mps).hold(1.5, clutch=1.0, road_wheel_rad=sign * angle) for sign in (1.0, -1.0))
    print(f"{speed_mps:.0f} m/s: {left.hand_wheel_torque_nm:.2f} N m at {left.ay_mps2:.1f} m/s2")
    assert left.ay_mps2 > 0.0
    assert left.hand_wheel_torque_nm < -0.3
    assert right.hand_wheel_torque_nm == -left.hand_wheel_torque_nm


def test_it_falls_before_the_front_tyres_have_given_all_they_have() -> None:
    drive = rolling(20.0, stability_control=False)
    torques, forces = [], []
    for tick in range(round(8.0 / TICK_S)):
        drive.hold(TICK_S, automatic=1, gear=1, throttle=0.35, road_wheel_rad=0.02 * tick * TICK_S)
        torques.append(abs(drive.seen.hand_wheel_torque_nm))
        forces.append(abs(drive.seen.ay_mps2))
    felt, full = torques.index(max(torques)), forces.index(max(forces))
    at_full = torques[full]
    print(
        f"most {max(torques):.1f} N m at {forces[felt]:.1f} m/s2, {at_full:.1f} N m at the most, {max(forces):.1f} m/s2"
    )
    assert felt * TICK_S < full * TICK_S - 0.3
    assert forces[felt] < 0.97 * max(forces)
    assert at_full < 0.9 * max(torques)


@pytest.mark.parametrize("brake", [0.0, 0.5])
@pytest.mark.parametrize("slope", [0.0, 0.1])
def test_hands_off_it_does_not_chatter_at_standstill(brake: float, slope: float) -> None:
    """On a level road with no brake, on a slope held by brake or hand brake, engine running, after a stop."""
    drive = rolling(5.0, Ground(1.0, slope, 0.05 * slope))
    held = {"brake": brake} if brake else {"handbrake": 1.0 if slope else 0.0}
    drive.hold(3.0, brake=0.5, clutch=1.0, road_wheel_rad=0.1)
    drive.hold(3.0, road_wheel_rad=0.1, **held)
    torques = [drive.hold(TICK_S, road_wheel_rad=0.1, **held).hand_wheel_torque_nm for _ in range(1000)]
    print(f"peak to peak {max(torques) - min(torques):.2g} N m")
    assert max(torques) - min(torques) < 0.2


def test_it_stays_light_when_parking_and_in_town() -> None:
    drive = Drive(platform())
    most = 0.0
    for tick in range(round(6.0 / TICK_S)):  # lock to lock on the spot
        drive.hold(TICK_S, brake=0.4, road_wheel_rad=0.6 * math.sin(0.5 * math.pi * tick * TICK_S))
        most = max(most, abs(drive.seen.hand_wheel_torque_nm))
    print(f"on the spot at most {most:.1f} N m")
    town = rolling(12.0)
    for tick in range(round(8.0 / TICK_S)):  # 5 m/s2 to both sides
        town.hold(TICK_S, automatic=1, gear=1, throttle=0.2, road_wheel_rad=0.09 * math.sin(tick * TICK_S))
        most = max(most, abs(town.seen.hand_wheel_torque_nm))
    print(f"in town too at most {most:.1f} N m")
    assert most < 12.0
