from typing import Any

import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.hud.banner import Alert
from simconsole.hud.guidance import guidance_of
from simconsole.hud.reading import HudReading
from simconsole.hud.view import HudSettings
from simconsole.values.signals import Event, Mode, Notice, Reason
from tests.hud.test_guidance import route_of
from tests.hud.test_view import TICK_HZ, snapshot

SETTINGS = HudSettings(takeover_window_s=10.0, hand_wheel_per_road_wheel=15.0)


def test_every_field_of_the_message_is_read_and_fits() -> None:
    read = HudReading(SETTINGS._replace(limit_kmh=50.0))(
        snapshot(vehicle__vx_mps=10.0, vehicle__gear=3.0, vehicle__engine_radps=200.0, situation__lane=-1.0)
    )
    kind = standard_registry().struct("simconsole_msgs/Hud")
    assert {"header", *read} == set(kind.__struct_fields__)
    kind(**read)
    assert (read["speed"], read["shown_speed"], read["gear"], read["engine_speed"]) == (10.0, 36, "3", 200.0)
    assert read["speed_limit"] == pytest.approx(50.0 / 3.6)
    assert (read["mode_words"], read["alert"], read["alert_words"]) == ("PARKED", Alert.NONE, "")


def test_a_takeover_counts_down_to_the_moment_the_console_acts() -> None:
    reading = HudReading(SETTINGS)
    mode = float(Mode.TAKEOVER_REQUESTED)
    first = reading(snapshot(memory__mode_ticks=0.0, arbitration__takeover_stage=1.0, arbitration__mode=mode))
    ticks = 6.5 * TICK_HZ
    later = reading(snapshot(memory__mode_ticks=ticks, arbitration__takeover_stage=2.0, arbitration__mode=mode))
    assert (first["alert"], first["alert_words"], first["takeover_remaining"]) == (Alert.TAKE_OVER, "TAKE OVER", 10.0)
    assert (later["alert"], later["alert_words"]) == (Alert.TAKE_OVER_NOW, "TAKE OVER NOW")
    assert later["takeover_remaining"] == pytest.approx(3.5)
    assert later["takeover_stage"] == 2


def test_notices_and_refusals_are_alerts_in_their_own_words() -> None:
    reading = HudReading(SETTINGS)
    refused = reading(snapshot(arbitration__refusal=float(Reason.REFUSED_TOO_FAST)))
    assert refused["alert"] == Alert.REFUSED
    assert refused["alert_words"] == refused["refusal_words"] != ""
    noticed = reading(snapshot(arbitration__notice=float(Notice.CENTRE_WHEEL)))
    assert noticed["alert"] == Alert.NOTICE
    assert noticed["alert_words"] == noticed["notice_words"] != ""


def test_a_pause_says_so() -> None:
    assert HudReading(SETTINGS)(snapshot(events__events=float(Event.PAUSE)))["mode_words"] == "PAUSED"


def test_the_next_turn_and_the_lanes_limit_are_told() -> None:
    urban = route_of("urban")
    reading = HudReading(SETTINGS._replace(guidance=guidance_of(urban)))
    at = urban.at(900.0)
    place: dict[str, Any] = {"vehicle__x_m": at.x_m, "vehicle__y_m": at.y_m, "vehicle__yaw_rad": at.yaw_rad}
    read = reading(snapshot(**place, situation__lane=4.0, situation__speed_limit_mps=30.0 / 3.6))
    (turn,) = urban.turns
    assert read["turn_distance"] == pytest.approx(turn.s_m - 900.0, abs=1.0)
    assert (read["turn_angle"], read["turn_exit"], read["turn_ends"]) == (turn.angle_rad, turn.exit, False)
    assert read["speed_limit"] == pytest.approx(30.0 / 3.6)
    beside = reading(snapshot(vehicle__x_m=at.x_m + 500.0, vehicle__y_m=at.y_m))
    assert (beside["turn_distance"], beside["turn_ends"]) == (-1.0, False)


def test_steering_and_lamps_are_as_the_car_has_them() -> None:
    read = HudReading(SETTINGS)(
        snapshot(vehicle__road_wheel_rad=0.1, command__turn_indicators=-1.0, command__hazard_lights=1.0)
    )
    assert read["hand_wheel"] == pytest.approx(1.5)
    assert (read["turn_indicators"], read["hazard_lights"]) == (-1, True)
