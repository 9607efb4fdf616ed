"""The display of who drives a robot: m/s and how fast it turns, and nothing of what only a car has."""

import itertools
import math

import pytest

from simconsole.hud.layout import check_screen, layout
from simconsole.hud.reading import HudReading
from simconsole.hud.screen import Screen
from simconsole.hud.view import HudMemory, HudSettings, view
from simconsole.session.resolution import load_session, resolve
from simconsole.session.view.external_view import display_settings
from simconsole.values.signals import Mode
from tests.hud.pictures import GERMAN, SCREEN, SCREENS, texts
from tests.hud.test_view import snapshot

ROBOT = HudSettings(is_robot=True)
OF_CARS = ("dial.needle", "dial.red", "dial.number", "gear", "gear.frame", "rpm", "rpm.bar", "limit", "pedal.clutch")
DRIVING = snapshot(
    tick=500, vehicle__vx_mps=-0.184, vehicle__yaw_rate_radps=-math.radians(14.7), vehicle__distance_m=12.34,
    arbitration__mode=Mode.MANUAL, command__turn_indicators=1.0,
)  # fmt: skip


@pytest.mark.parametrize("has_view", [False, True])
def test_speeds_are_those_of_a_robot_and_there_is_nothing_of_a_car(has_view: bool) -> None:
    shown, _ = view(DRIVING, 0.0, HudMemory(), ROBOT)
    items = layout(shown, SCREEN._replace(has_view=has_view))
    told = {item.text for item in texts(items)}
    assert {"0.18", "m/s", "-15 °/s", "12.3 m"} <= told
    assert not {"km/h", "SHIFTER", "ENGINE", "HAND BRAKE", "x1000 rpm", "CLUTCH"} & told
    roles = {item.role for item in items}
    assert not [role for role in roles if role.startswith(OF_CARS) or role.startswith("indicator")]


def test_a_robot_that_stands_shows_zero_and_speaks_the_language() -> None:
    standing = snapshot(tick=500, vehicle__yaw_rate_radps=-0.001)
    shown, _ = view(standing, 0.0, HudMemory(), ROBOT._replace(language=GERMAN.language))
    assert (shown.speed_text, shown.speed_unit, shown.turn_text, shown.distance_text(2)) == (
        "0,00", "m/s", "0 °/s", "0,0 m",
    )  # fmt: skip


def test_of_the_speed_not_every_centimetre_is_told_at_once() -> None:
    memory, told = HudMemory(), []
    for tick in range(500, 750):  # 1 s
        now = snapshot(tick=tick, vehicle__vx_mps=0.001 * (tick - 500))
        shown, memory = view(now, 0.0, memory, ROBOT)
        told.append(shown.shown_cmps)
    assert sum(one != other for one, other in itertools.pairwise(told)) <= 5
    assert told[-1] >= 18


@pytest.mark.parametrize("size", SCREENS)
@pytest.mark.parametrize("has_view", [False, True])
def test_every_text_can_be_read(size: str, has_view: bool) -> None:
    screen: Screen = SCREENS[size]._replace(has_view=has_view)
    check_screen(screen, "hud", ROBOT)


def test_a_robots_session_has_this_display_and_no_road() -> None:
    settings = display_settings(resolve(load_session("turtlebot3_burger")))
    assert settings.is_robot
    assert (settings.limit_kmh, settings.guidance) == (0.0, None)
    assert not display_settings(resolve(load_session("seated"))).is_robot


def test_a_display_of_another_program_is_told_whole_kmh() -> None:
    assert HudReading(ROBOT)(DRIVING)["shown_speed"] == 1, "0.66 km/h"
