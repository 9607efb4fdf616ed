"""The way from unknown to live and back."""

import math

import pytest

from simconsole.devices.calibration.validity import axis_good, mask_good, next_validity
from simconsole.values.signals import NEVER_TICKS
from simconsole.values.validity import ARMED, LIVE, LOST, STALE, UNKNOWN

LIMIT = 25.0


def after(previous: float, age: float = 0.0, refused: float = 0.0, at_rest: bool = False) -> float:
    return next_validity(previous, age, refused, LIMIT, at_rest)


@pytest.mark.parametrize("raw", [0.0, 1.0, -1.0, 1.00003, -1.00003])
def test_axis_in_range_is_good(raw: float) -> None:
    assert axis_good(raw)


@pytest.mark.parametrize("raw", [math.nan, math.inf, -math.inf, 1.02, -7.0, 1e300])
def test_axis_out_of_range_is_refused(raw: float) -> None:
    assert not axis_good(raw)


@pytest.mark.parametrize("mask", [0.0, 1.0, 2.0**24 - 1])
def test_whole_mask_is_good(mask: float) -> None:
    assert mask_good(mask)


@pytest.mark.parametrize("mask", [math.nan, math.inf, -1.0, 0.5, 2.0**24])
def test_other_masks_are_refused(mask: float) -> None:
    assert not mask_good(mask)


@pytest.mark.parametrize("before", [UNKNOWN, LOST])
def test_only_rest_arms(before: float) -> None:
    assert after(before) == UNKNOWN
    assert after(before, at_rest=True) == ARMED


@pytest.mark.parametrize("before", [ARMED, LIVE, STALE])
def test_armed_goes_live_wherever_it_stands(before: float) -> None:
    assert after(before) == LIVE


def test_silence_is_held_for_its_limit_and_then_stale() -> None:
    assert after(LIVE, age=LIMIT) == LIVE
    assert after(LIVE, age=LIMIT + 1) == STALE
    assert after(UNKNOWN, age=LIMIT + 1) == UNKNOWN
    assert after(LOST, age=LIMIT + 1) == LOST


def test_refused_readings_are_held_for_the_same_limit() -> None:
    assert after(LIVE, refused=LIMIT) == LIVE
    assert after(LIVE, refused=LIMIT + 1) == STALE
    assert after(UNKNOWN, refused=1.0, at_rest=True) == UNKNOWN


@pytest.mark.parametrize("age", [NEVER_TICKS, 2 * NEVER_TICKS, math.inf, math.nan, -1.0])
def test_gone_device_or_impossible_age_is_lost(age: float) -> None:
    for before in (ARMED, LIVE, STALE, LOST):
        assert after(before, age=age, at_rest=True) == LOST
    assert after(UNKNOWN, age=age, at_rest=True) == UNKNOWN
