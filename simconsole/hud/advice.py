"""Speed advice in words, for the driver's display. Pure."""

from typing import Final

from simconsole.hud.language import say
from simconsole.profiles.view import LanguageProfile
from simconsole.values.units import KMH_PER_MPS
from simconsole.world.rules.speed_advice import Advice, Advised

BAND: Final = "green at {low} to {high} km/h"
ONE_SPEED: Final = "green at {high} km/h"
PREPARE: Final = "prepare to stop"
WIDEST: Final = {"low": "100", "high": "130"}
"""What takes most room."""


def advice_label(advice: Advice, language: LanguageProfile) -> str:
    """Return what is advised, empty where nothing is: whole km/h that lie in the band, or its only one."""
    if advice.kind is Advised.NOTHING:
        return ""
    if advice.kind is Advised.STOP:
        return say(language, PREPARE)
    low, high = -int(-advice.low_mps * KMH_PER_MPS // 1.0), int(advice.high_mps * KMH_PER_MPS // 1.0)
    if low < high:
        return say(language, BAND, low=f"{low}", high=f"{high}")
    return say(language, ONE_SPEED, high=f"{round(advice.target_mps * KMH_PER_MPS)}")
