"""Screens and recordings: bounds that are refused, and a default screen on which text can be read."""

import math

import pytest

from simconsole.profiles.view import HudProfile, SceneProfile
from tests.profiles.refused import refusal


@pytest.mark.parametrize(
    ("kind", "text", "told"),
    [
        (HudProfile, "width_px: 319", "width_px: value 319: "),
        (HudProfile, "screen_width_m: 0", "screen_width_m: value 0: "),
        (HudProfile, "rate_hz: 241", "rate_hz: value 241: "),
        (HudProfile, "full_screen: true", "full_screen: value true: unknown key, did you mean fullscreen?"),
        (HudProfile, "view: {camera: cockpit}", 'view.camera: value "cockpit": one of bird, chase, driver'),
        (HudProfile, "view: {samples: 17}", "view.samples: value 17: "),
        (HudProfile, "view: {horizon: 0.05}", "view.horizon: value 0.05: "),
        (HudProfile, "view: {mirror: true}", "view.mirror: value true: unknown key, did you mean mirrors?"),
        (HudProfile, "view: {screens: []}", "view.screens: value []: "),
        (HudProfile, "view: {screens: [{yaw_deg: 181}]}", "view.screens[0].yaw_deg: value 181: "),
        (HudProfile, "view: {screens: [{horizontal_fov_deg: 151}]}", "view.screens[0].horizontal_fov_deg: value 151: "),
        (HudProfile, "view: {screens: [{width: 0}]}", "view.screens[0].width: value 0: "),
        (SceneProfile, "rate_hz: 251", "rate_hz: value 251: "),
        (SceneProfile, "chunk_s: 0", "chunk_s: value 0: "),
        (SceneProfile, "chase_back_m: 201", "chase_back_m: value 201: "),
    ],
)
def test_what_cannot_be_meant_is_refused(kind: type, text: str, told: str) -> None:
    assert told in refusal(text, kind)


def test_twenty_minutes_of_arc_are_enough_points_for_a_character_on_the_default_screen() -> None:
    plain = HudProfile()
    height_m = plain.eye_distance_m * math.tan(math.radians(20.0 / 60.0))
    assert height_m * plain.width_px / plain.screen_width_m > 8.0
    assert plain.rpm_red < plain.rpm_max
    assert SceneProfile().chunk_s <= SceneProfile().flush_s
