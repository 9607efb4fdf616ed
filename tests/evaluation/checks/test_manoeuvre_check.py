"""Characteristic values against their limits."""

import math

import pytest

from simconsole.evaluation.checks.manoeuvre_check import judge_limit
from simconsole.profiles.manoeuvre import Limit
from simconsole.values.errors import ProfileError

VALUES = {"stopping_distance_m": 40.0, "lowest_wheel_speed_share": math.nan}


@pytest.mark.parametrize("bounds", [{}, {"min": 40.0}, {"max": 40.0}, {"min": 39.0, "max": 41.0}])
def test_a_value_at_its_limit_is_inside(bounds: dict[str, float]) -> None:
    assert judge_limit(Limit(value="stopping_distance_m", **bounds), VALUES, "s.yaml") is None


@pytest.mark.parametrize(
    ("bounds", "told"),
    [
        ({"min": 40.5}, "stopping_distance_m: 40 not in 40.5 to inf"),
        ({"max": 39.5}, "stopping_distance_m: 40 not in -inf to 39.5"),
        ({"min": 50.0, "max": 30.0}, "stopping_distance_m: 40 not in 50 to 30"),
    ],
)
def test_a_value_beyond_it_is_told_with_both(bounds: dict[str, float], told: str) -> None:
    assert judge_limit(Limit(value="stopping_distance_m", **bounds), VALUES, "s.yaml") == told


def test_what_is_no_number_is_outside_every_limit() -> None:
    told = judge_limit(Limit(value="lowest_wheel_speed_share"), VALUES, "s.yaml")
    assert told == "lowest_wheel_speed_share: nan not in -inf to inf"


def test_a_value_that_the_manoeuvre_has_not_is_refused_with_those_it_has() -> None:
    with pytest.raises(ProfileError, match=r"^s\.yaml: limits: value: value speed: one of lowest_wheel_speed_share, "):
        judge_limit(Limit(value="speed", max=1.0), VALUES, "s.yaml")
