"""What of a tick is heard."""

import math
from typing import Any

import pytest

from simconsole.hud.sound.heard import Listener, SoundSettings, Tone, heard, squeal
from simconsole.values.signals import Button, Event, GearFault, Mode, Notice, Reason
from tests.hud.test_view import TICK_HZ, snapshot

CAR = SoundSettings(cylinders=4, wheelbase_m=2.6)


def test_engine_speed_load_and_road_speed_are_the_cars() -> None:
    found = heard(
        snapshot(
            vehicle__engine_radps=300.0,
            vehicle__engine_running=1.0,
            command__throttle=0.4,
            vehicle__vx_mps=12.0,
            vehicle__vy_mps=5.0,
        ),
        CAR,
    )
    assert (found.engine_radps, found.load, found.speed_mps) == (300.0, 0.4, 13.0)


def test_what_has_no_engine_has_no_engine_sound() -> None:
    moment = snapshot(vehicle__engine_radps=300.0, vehicle__engine_running=1.0)
    assert heard(moment, SoundSettings(cylinders=0)).engine_radps == 0.0


def test_in_a_pause_nothing_is_heard() -> None:
    moment = snapshot(events__events=float(Event.PAUSE), vehicle__engine_radps=300.0, vehicle__vx_mps=20.0)
    found = heard(moment, CAR)
    assert (found.engine_radps, found.speed_mps, found.tone) == (0.0, 0.0, Tone.NONE)


def test_tyres_squeal_where_they_slide() -> None:
    rolling = snapshot(vehicle__vx_mps=20.0, vehicle__road_wheel_rad=0.02, vehicle__yaw_rate_radps=0.15)
    assert squeal(rolling, CAR) == (0.0, 0.0)
    understeer = snapshot(vehicle__vx_mps=20.0, vehicle__road_wheel_rad=0.4, vehicle__yaw_rate_radps=0.3)
    assert squeal(understeer, CAR) == (1.0, 0.0)
    drift = snapshot(
        vehicle__vx_mps=15.0, vehicle__vy_mps=-5.0, vehicle__yaw_rate_radps=1.5, vehicle__road_wheel_rad=-0.07
    )
    assert squeal(drift, CAR)[1] == 1.0
    assert squeal(drift, CAR)[0] == 0.0
    parking = snapshot(vehicle__vx_mps=1.0, vehicle__road_wheel_rad=0.5)
    assert squeal(parking, CAR) == (0.0, 0.0)


def test_backwards_a_steered_wheel_that_rolls_does_not_squeal() -> None:
    steer_rad, vx_mps = 0.3, -8.0
    rolling = snapshot(
        vehicle__vx_mps=vx_mps,
        vehicle__road_wheel_rad=steer_rad,
        vehicle__yaw_rate_radps=vx_mps * math.tan(steer_rad) / CAR.wheelbase_m,
    )
    assert squeal(rolling, CAR) == (0.0, 0.0)


def test_a_locked_wheel_squeals() -> None:
    locked = snapshot(vehicle__vx_mps=20.0)
    free_radps = 20.0 / CAR.wheel_radius_m
    wheels = CAR._replace(wheels=(0, 1, 2, 3))
    locked.vector[:4] = (0.0, free_radps, free_radps, free_radps)
    assert squeal(locked, wheels) == (1.0, 0.0)
    locked.vector[:4] = (free_radps, free_radps, free_radps, 2.0 * free_radps)
    assert squeal(locked, wheels) == (0.0, 1.0)
    locked.vector[:4] = (free_radps,) * 4
    assert squeal(locked, wheels) == (0.0, 0.0)


def test_horn_relay_and_grinding_gear_are_heard_while_they_last() -> None:
    found = heard(
        snapshot(
            driver__pressed=float(Button.HORN | Button.MARK),
            command__turn_indicators=-1.0,
            vehicle__gear_fault=float(GearFault.GRIND),
        ),
        CAR,
    )
    assert (found.horn, found.indicators, found.grind) == (True, True, True)
    quiet = heard(snapshot(driver__pressed=float(Button.MARK), vehicle__gear_fault=float(GearFault.MISSED)), CAR)
    assert (quiet.horn, quiet.indicators, quiet.grind) == (False, False, False)
    assert heard(snapshot(command__hazard_lights=1.0), CAR).indicators


@pytest.mark.parametrize(
    ("values", "tone"),
    [
        ({"arbitration__mode": Mode.MANUAL}, Tone.NONE),
        ({"arbitration__mode": Mode.TAKEOVER_REQUESTED, "arbitration__takeover_stage": 1.0}, Tone.TAKE_OVER),
        ({"arbitration__mode": Mode.TAKEOVER_REQUESTED, "arbitration__takeover_stage": 2.0}, Tone.TAKE_OVER_NOW),
        ({"arbitration__mode": Mode.MINIMAL_RISK}, Tone.STOPPING),
        ({"arbitration__mode": Mode.EMERGENCY_STOP}, Tone.STOPPING),
        ({"arbitration__mode": Mode.MANUAL, "arbitration__refusal": Reason.REFUSED_TOO_FAST}, Tone.WARNING),
        ({"arbitration__mode": Mode.MANUAL, "arbitration__notice": Notice.THROTTLE_HELD}, Tone.WARNING),
        ({"arbitration__mode": Mode.AUTONOMOUS, "rules__red_light": 1.0}, Tone.WARNING),
    ],
)
def test_the_most_urgent_is_told(values: dict[str, Any], tone: Tone) -> None:
    assert heard(snapshot(**values), CAR).tone is tone


def told(listener: Listener, t_s: float, mode: Mode) -> Tone:
    return listener(snapshot(arbitration__mode=float(mode))._replace(tick=round(t_s * TICK_HZ))).tone


def test_a_change_of_who_drives_rings_once() -> None:
    listener = Listener(CAR)
    assert told(listener, 0.0, Mode.MANUAL) is Tone.NONE, "a drive that begins changes nothing"
    assert told(listener, 1.0, Mode.AUTONOMOUS) is Tone.ENGAGED
    assert told(listener, 1.5, Mode.AUTONOMOUS) is Tone.ENGAGED
    assert told(listener, 1.7, Mode.AUTONOMOUS) is Tone.NONE
    assert told(listener, 2.0, Mode.MANUAL) is Tone.RELEASED
    assert told(listener, 2.1, Mode.EMERGENCY_STOP) is Tone.STOPPING, "what is urgent goes before a chime"
    assert told(listener, 9.0, Mode.PARKED) is Tone.NONE
    assert told(listener, 0.0, Mode.PARKED) is Tone.NONE, "a drive that starts anew"
