"""The car's torque closed over the hands: lead, damping, and the share that a late motor gets."""

import pytest

from simconsole.devices.force_feedback.aligning import (
    SHARES_KMH,
    aligning,
    answered,
    share_of,
    shares_by_speed,
    stiffness,
)
from simconsole.devices.force_feedback.force_settings import ForceSettings, force_settings
from simconsole.devices.force_feedback.guidance import GuidanceReference
from simconsole.devices.force_feedback.rim import Rim
from simconsole.devices.force_feedback.torque_parts import torque_parts
from simconsole.profiles.device import CockpitProfile
from simconsole.values.platform import RimStiffness
from simconsole.values.signals import VehicleState

STIFF = RimStiffness(5.0, 7.0, 10.0, 14.0, 19.0, relaxation_m=0.3, pulls=1.0)


@pytest.fixture
def force(t500: CockpitProfile) -> ForceSettings:
    return force_settings(t500, 15.0, 0.6, 250, STIFF)


def test_stiffness_is_straight_between_its_figures_and_ends_with_the_last(force: ForceSettings) -> None:
    assert [stiffness(speed, force) for speed in (0.0, 12.0, 24.0, 36.0, 48.0)] == pytest.approx(list(STIFF[:5]))
    assert [stiffness(speed, force) for speed in (6.0, 30.0, 99.0)] == pytest.approx([6.0, 12.0, 19.0])


def test_still_wheel_that_the_car_has_answered_gets_the_cars_torque_alone(force: ForceSettings) -> None:
    assert aligning(-1.7, 0.0, 0.0, 0.0, 12.0, 0.7, 0.0, force) == -1.7


def test_torque_leads_and_damps(force: ForceSettings) -> None:
    assert aligning(0.0, 0.1, 0.0, 0.0, 12.0, 0.0, 0.0, force) == pytest.approx(-1.2)
    slow = aligning(0.0, 0.0, 0.0, 1.0, 12.0, 0.0, 0.0, force)
    fast = aligning(0.0, 0.0, 0.0, 1.0, 12.0, 1.0, 0.0, force)
    assert fast < slow < 0.0
    assert aligning(0.0, 0.0, 0.1, 0.0, 12.0, 1.0, 0.0, force) < 0.0, "against a change of the yaw rate"


def test_guidance_takes_over_the_damping(force: ForceSettings) -> None:
    turning = [aligning(0.0, 0.0, 0.1, 1.0, 12.0, 1.0, guided, force) for guided in (0.0, 0.5, 1.0)]
    assert turning[0] < turning[1] < turning[2] == 0.0


def test_share_falls_with_stiffness_and_delay_and_is_full_with_the_shipped_figures(force: ForceSettings) -> None:
    late = force._replace(rate_loop_per_s=0.3 * force.rate_loop_per_s)
    assert share_of(15.0, 0.7, force) == 1.0
    assert share_of(15.0, 0.7, late) < 1.0
    assert share_of(60.0, 0.7, late) == pytest.approx(share_of(30.0, 0.7, late) / 2.0)
    assert share_of(30.0, 1.0, late) < share_of(30.0, 0.2, late)


def test_shares_by_speed_are_those_that_the_torque_has(force: ForceSettings) -> None:
    late = force._replace(rate_loop_per_s=0.3 * force.rate_loop_per_s)
    shares = dict(shares_by_speed(late))
    assert tuple(shares) == SHARES_KMH
    vehicle = VehicleState(*(0.0,) * len(VehicleState._fields))._replace(vx_mps=120.0 / 3.6)
    still, nothing = Rim(0.0, 0.0), GuidanceReference(0.0, 0.0)
    parts = torque_parts(False, still, still, vehicle, nothing, 0.0, 1.0, 0.0, 0.0, late)
    assert parts.car_share == shares[120.0] < 1.0


def test_tyres_answer_over_their_relaxation(force: ForceSettings) -> None:
    ticks, angle = round(0.3 / 20.0 / 0.004), 0.0
    for _ in range(ticks):
        angle = answered(angle, 0.1, 20.0, force, 0.004)
    assert angle == pytest.approx(1.5 * (1.0 - 0.37), rel=0.1)
