"""Speed advice in words."""

import pytest

from simconsole.hud.advice import advice_label
from simconsole.hud.view import HudMemory, view
from simconsole.profiles.control import ControlProfile
from simconsole.profiles.view import ENGLISH, HudProfile
from simconsole.values.labels import notice_label
from simconsole.values.signals import Notice
from simconsole.world.rules.speed_advice import NO_ADVICE, STOP, Advice, Advised
from tests.hud.test_view import settings_for, snapshot


@pytest.mark.parametrize(
    ("low_kmh", "high_kmh", "target_kmh", "said"),
    [
        (34.2, 45.9, 45.9, "green at 35 to 45 km/h"),
        (40.0, 50.0, 50.0, "green at 40 to 50 km/h"),
        (41.2, 42.6, 42.6, "green at 43 km/h"),
        (41.2, 41.4, 41.3, "green at 41 km/h"),
    ],
)
def test_band_is_told_in_whole_speeds_that_lie_in_it(
    low_kmh: float, high_kmh: float, target_kmh: float, said: str
) -> None:
    advice = Advice(Advised.SPEED, low_kmh / 3.6 + 1e-9, high_kmh / 3.6 + 1e-9, target_kmh / 3.6)
    assert advice_label(advice, ENGLISH) == said.replace("40 to", "41 to")


def test_stopping_and_nothing() -> None:
    assert advice_label(STOP, ENGLISH) == "prepare to stop"
    assert advice_label(NO_ADVICE, ENGLISH) == ""


def told(advice: Advice = NO_ADVICE, **fields: float) -> str:
    """What the display tells below the mode."""
    settings = settings_for(HudProfile(), ControlProfile())
    return view(snapshot(250, **fields), 0.0, HudMemory(), settings, advice=advice)[0].notice_label


def test_the_display_tells_advice_unless_there_is_a_notice() -> None:
    band = Advice(Advised.SPEED, 35.0 / 3.6, 45.5 / 3.6, 45.5 / 3.6)
    assert told() == ""
    assert told(band) == "green at 35 to 45 km/h"
    assert told(STOP) == "prepare to stop"
    notice = notice_label(Notice.RED_LIGHT)
    assert told(band, rules__red_light=1.0) == notice != ""


def test_the_display_tells_that_traffic_is_lost_where_there_is_nothing_else_to_tell() -> None:
    lost = {"ahead__traffic_lost": 1.0}
    assert told(NO_ADVICE, **lost) == "traffic has failed: the road is empty"
    assert told(STOP, **lost) == "prepare to stop"
    assert told(NO_ADVICE, **lost, rules__red_light=1.0) == notice_label(Notice.RED_LIGHT)
