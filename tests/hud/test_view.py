import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from simconsole.hud.view import HudMemory, HudSettings, settings_of, shown_speed, view
from simconsole.profiles.control import ControlProfile
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.view import HudProfile
from simconsole.values.platform import Pose
from simconsole.values.signals import FAR, NEVER_TICKS, GateLimit, Mode, Reason
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot, columns
from simconsole.values.units import MPS_PER_KMH

TICK_HZ = 250
COLUMNS = columns(Pose)


def snapshot(tick: int = 250, **fields: float) -> Snapshot:
    row = np.zeros(PLATFORM_AT + 3)
    for name, value in fields.items():
        row[COLUMNS.index(name.replace("__", "."))] = value
    return Snapshot(tick, TICK_HZ, row)


def settings_for(
    hud: HudProfile, control: ControlProfile, vehicle: str = "hatchback", by_keyboard: bool = False
) -> HudSettings:
    car = load_vehicle(vehicle)
    cockpit = load("devices", "t500rs_th8rs", CockpitProfile)
    return settings_of(hud, control, cockpit, car, by_keyboard=by_keyboard)


def speeds(kmh: list[float], step_s: float = 0.25) -> list[int]:
    memory, shown = HudMemory(), []
    for index, value in enumerate(kmh):
        number, since = shown_speed(value * MPS_PER_KMH, index * step_s, memory)
        memory = HudMemory(number, since)
        shown.append(number)
    return shown


def test_the_shown_speed_is_an_integer_with_half_a_kmh_of_hysteresis() -> None:
    assert speeds([36.9, 37.4, 37.6, 37.9, 38.1]) == [37, 37, 37, 37, 38]
    assert speeds([38.0, 37.4, 37.1, 36.9]) == [38, 38, 38, 37]


def test_a_speed_on_the_edge_does_not_flicker() -> None:
    rng = np.random.default_rng(7)
    edge = (37.5 + 0.1 * rng.standard_normal(400)).tolist()
    shown = speeds(edge)
    assert sum(a != b for a, b in pairwise(shown)) == 0, "seed 7"


def test_digits_change_at_most_five_times_a_second() -> None:
    shown = speeds([float(kmh) for kmh in range(240)], 1.0 / 60.0)
    assert sum(a != b for a, b in pairwise(shown)) <= 5 * 4
    assert shown[-1] >= 239 - 13


def test_a_speed_that_stays_is_reached_exactly_enough() -> None:
    for target in np.linspace(0.0, 130.0, 261).tolist():
        assert abs(speeds([0.0, target, target])[-1] - target) <= 1.0


def test_a_car_that_stands_shows_zero() -> None:
    """Its model comes to rest ever more slowly: a speed that nobody sees is no 1 km/h."""
    assert speeds([3.0, 1.0, 0.01, 0.001]) == [3, 1, 0, 0]
    assert speeds([0.0, 0.3, 0.06, 0.3, 1.1, 0.3]) == [0, 0, 0, 0, 1, 1]


def test_reversing_shows_no_minus() -> None:
    assert speeds([-7.0]) == [7]


def test_a_drive_that_starts_anew_is_shown_at_once() -> None:
    memory = HudMemory(shown_speed=80, shown_s=500.0)
    assert shown_speed(0.0, 1.0, memory) == (0, 1.0)


def test_data_is_stale_after_half_a_second() -> None:
    assert not view(snapshot(), 0.5, HudMemory(), HudSettings())[0].stale
    assert view(snapshot(), 0.51, HudMemory(), HudSettings())[0].stale


def test_the_content_comes_from_the_state_vector() -> None:
    row = snapshot(
        tick=500,
        vehicle__vx_mps=10.0,
        vehicle__engine_radps=314.159265,
        vehicle__engine_running=1.0,
        vehicle__gear=2.0,
        vehicle__clutch=0.25,
        vehicle__road_wheel_rad=-0.1,
        vehicle__distance_m=321.0,
        command__throttle=0.5,
        command__brake=0.125,
        command__handbrake=1.0,
        driver__throttle=0.75,
        arbitration__mode=Mode.SHARED,
        arbitration__reason=Reason.PERSON_ASKED,
        arbitration__remote_lateral=0.5,
        ros__sequence=3.0,
        ros__age_ticks=5.0,
    )
    shown, memory = view(row, 0.0, HudMemory(), HudSettings())
    assert (shown.t_s, shown.shown_kmh, shown.gear) == (2.0, 36, "2")
    assert shown.rpm == pytest.approx(3000.0)
    assert (shown.mode_label, shown.reason_label, shown.refusal_label) == ("SHARED", "driver asked", "")
    assert (shown.throttle, shown.brake, shown.clutch, shown.handbrake) == (0.5, 0.125, 0.25, 1.0)
    assert (shown.driver_throttle, shown.remote_lateral, shown.hand_wheel_deg) == pytest.approx(
        (0.75, 0.5, -1.5 * 180.0 / math.pi)
    )
    assert shown.link_age_s == pytest.approx(0.02)
    assert shown.distance_m == 321.0
    assert memory == HudMemory(36, 2.0)
    assert shown.force == "none"


def test_no_command_ever_is_no_link() -> None:
    never = snapshot(ros__sequence=0.0, ros__age_ticks=0.0)
    assert view(never, 0.0, HudMemory(), HudSettings())[0].link_age_s is None
    gone = snapshot(ros__sequence=4.0, ros__age_ticks=NEVER_TICKS)
    assert view(gone, 0.0, HudMemory(), HudSettings())[0].link_age_s is None


def test_a_refusal_is_shown_beside_the_reason_of_the_mode() -> None:
    row = snapshot(
        arbitration__mode=Mode.MANUAL,
        arbitration__reason=Reason.BRAKE_OVERRIDE,
        arbitration__refusal=Reason.REFUSED_BRAKE_PRESSED,
    )
    shown, _ = view(row, 0.0, HudMemory(), HudSettings())
    assert shown.reason_label == "driver braked"
    assert shown.refusal_label == "refused: brake is pressed"


def test_the_countdown_ends_when_the_arbitration_acts() -> None:
    settings = settings_for(HudProfile(), ControlProfile(minimal_risk_after_s=8.0))
    row = snapshot(arbitration__mode=Mode.TAKEOVER_REQUESTED, arbitration__takeover_stage=1.0, memory__mode_ticks=500.0)
    shown, _ = view(row, 0.0, HudMemory(), settings)
    assert shown.remaining_s == pytest.approx(6.0)
    assert shown.takeover_stage == 1
    later = snapshot(arbitration__mode=Mode.TAKEOVER_REQUESTED, memory__mode_ticks=9999.0)
    assert view(later, 0.0, HudMemory(), settings)[0].remaining_s == 0.0
    assert view(snapshot(memory__mode_ticks=500.0), 0.0, HudMemory(), settings)[0].remaining_s == 0.0


def test_settings_come_from_their_profiles() -> None:
    control = ControlProfile(minimal_risk_after_s=12.0, command_stale_s=0.4)
    found = settings_for(HudProfile(rpm_max=8000.0, rpm_red=6800.0), control)
    assert found[:4] == (8000.0, 6800.0, 12.0, 0.4)
    assert (found.manual_button, found.reset_button) == ("cross", "R2")
    assert found.hand_wheel_lock_deg == pytest.approx(found.hand_wheel_per_road_wheel * 34.0, abs=60.0)
    assert found.top_gear == 6
    assert settings_for(HudProfile(), control, by_keyboard=True).manual_button == "Backspace"
    assert settings_for(HudProfile(), control, vehicle="ball").top_gear == 0


@pytest.mark.parametrize(
    ("throttle", "brake", "clutch", "worst"),
    [(2.0, 2.0, 2.0, 2.0), (2.0, 4.0, 3.0, 4.0), (2.0, 2.0, 3.0, 3.0), (2.0, 0.0, 1.0, 0.0), (1.0, 2.0, 2.0, 1.0)],
)
def test_pedals_are_as_good_as_their_worst(throttle: float, brake: float, clutch: float, worst: float) -> None:
    row = snapshot(driver__throttle_validity=throttle, driver__brake_validity=brake, driver__clutch_validity=clutch)
    assert view(row, 0.0, HudMemory(), HudSettings())[0].pedals_validity == worst


def test_sign_of_the_motor_says_on_limit_lost_or_none() -> None:
    memory, shown = HudMemory(), []
    ticks = [(0, 0.0, 0.0), (1, 1.0, 0.0), (2, 1.0, 1.0), (60, 1.0, 0.0), (100, 1.0, 0.0), (101, 0.0, 0.0)]
    for tick, motor, clipped in ticks:
        row = snapshot(tick, sample__wheel_motor=motor, torque__clipped=clipped)
        content, memory = view(row, 0.0, memory, HudSettings())
        shown.append(content.force)
    assert shown == ["none", "on", "limit", "limit", "on", "lost"]


def test_sign_of_the_motor_tells_of_a_wheel_that_bears_a_share_only() -> None:
    shares = [(0.5, 1.0), (0.98, 1.0), (0.997, 1.0), (0.5, 0.0), (0.0, 1.0)]
    rows = [snapshot(sample__wheel_motor=1.0, torque__car_share=at, torque__enabled=on) for at, on in shares]
    assert [view(row, 0.0, HudMemory(), HudSettings())[0].force for row in rows] == [
        *("eased", "eased", "on", "on", "on")
    ]


def test_sign_of_an_eased_motor_does_not_flicker_where_the_share_is_nearly_all() -> None:
    memory, shown = HudMemory(), []
    for tick, share in enumerate((0.996, 0.994, 0.996, 0.994, 1.0, 0.996)):
        row = snapshot(tick, sample__wheel_motor=1.0, torque__car_share=share, torque__enabled=1.0)
        content, memory = view(row, 0.0, memory, HudSettings())
        shown.append(content.force)
    assert shown == ["on", "eased", "eased", "eased", "on", "on"]


def test_can_is_shown_only_where_there_is_a_bus() -> None:
    assert view(snapshot(), 0.0, HudMemory(), HudSettings())[0].can_up is None
    assert view(snapshot(), 0.0, HudMemory(), HudSettings(), can_up=False)[0].can_up is False
    assert view(snapshot(), 0.0, HudMemory(), HudSettings())[0].link is None
    assert view(snapshot(), 0.0, HudMemory(), HudSettings(), link="lost")[0].link == "lost"


@pytest.mark.fault("D08")
@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"driver__lever_fault": 1.0}, "two gears"),
        ({"command__gate_active": float(GateLimit.GEAR | GateLimit.RATE)}, "not now"),
        ({"command__gate_active": float(GateLimit.RATE)}, ""),
    ],
)
def test_what_is_wrong_with_the_lever_is_said(fields: dict[str, Any], words: str) -> None:
    """D08: the gear is kept, and the driver is told why."""
    shown, _ = view(snapshot(**fields), 0.0, HudMemory(), HudSettings())
    assert shown.lever_label == words


@pytest.mark.parametrize(
    ("lane", "limit_mps", "shown"), [(3.0, 13.889, 50), (3.0, FAR, 0), (-1.0, FAR, 70), (-1.0, 13.889, 70)]
)
def test_the_limit_is_that_of_the_lane_or_of_the_road_without_lanes(lane: float, limit_mps: float, shown: int) -> None:
    vector = np.zeros(PLATFORM_AT)
    for name, value in (("lane", lane), ("speed_limit_mps", limit_mps)):
        vector[LAYOUT.situation.at(name)] = value
    told, _ = view(Snapshot(1, 250, vector), 0.0, HudMemory(), HudSettings(limit_kmh=70.0))
    assert told.limit_kmh == shown
