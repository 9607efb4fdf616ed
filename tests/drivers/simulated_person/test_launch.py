"""Throttle and clutch of a person who drives off."""

import pytest

from simconsole.drivers.simulated_person.launch import clutch_through_bite
from simconsole.drivers.simulated_person.view import View
from simconsole.profiles.person import Habits
from simconsole.values.signals import Mode

STANDING = View(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 84.0, 1.0, 0.0, float(Mode.MANUAL))


def test_foot_feels_for_the_bite() -> None:
    habits = Habits()
    free, labouring, dying = (STANDING._replace(engine_radps=speed) for speed in (180.0, 120.0, 60.0))
    assert clutch_through_bite(0.6, free, habits, 0.004) == pytest.approx(0.6 - 0.004 * habits.bite_release_per_s)
    assert clutch_through_bite(0.6, labouring, habits, 0.004) > 0.6
    assert clutch_through_bite(0.6, dying, habits, 0.004) > clutch_through_bite(0.6, labouring, habits, 0.004)
