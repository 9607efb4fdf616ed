"""The helpers that every kernel is made of, at their edges."""

import math
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from simconsole.values.host.jit import compiled
from simconsole.values.kernels import (
    approach,
    clip,
    forget,
    is_finite,
    is_kernel,
    is_stage,
    kernel,
    put,
    stage,
    steady_clip,
)

finite = st.floats(allow_nan=False, allow_infinity=False)
bounded = st.floats(-1e6, 1e6)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_seen(value: float) -> None:
    assert not is_finite(value)
    assert not compiled(is_finite)(value)


@given(finite)
def test_every_finite_number_is_finite(value: float) -> None:
    assert is_finite(value)


@given(finite, bounded, bounded)
def test_clip_stays_inside_and_moves_nothing_that_is_inside(value: float, one: float, other: float) -> None:
    low, high = sorted((one, other))
    clipped = clip(value, low, high)
    assert low <= clipped <= high
    assert clipped == value or not low <= value <= high


@given(finite, bounded, bounded)
def test_a_steady_clip_has_the_bits_of_a_clip(value: float, one: float, other: float) -> None:
    low, high = sorted((one, other))
    expected = struct.pack("d", clip(value, low, high))
    assert struct.pack("d", steady_clip(value, low, high)) == expected
    assert struct.pack("d", compiled(steady_clip)(value, low, high)) == expected


def test_clip_lets_nan_through_so_that_finiteness_must_be_asked_first() -> None:
    assert math.isnan(clip(math.nan, -1.0, 1.0))


@given(bounded, bounded, st.floats(0.0, 1e6))
def test_approach_steps_towards_the_target_and_never_past_it(value: float, target: float, step: float) -> None:
    after = approach(value, target, step)
    assert min(value, target) <= after <= max(value, target)
    assert abs(after - value) <= step * (1 + 1e-12) + 1e-9
    if abs(target - value) <= step * (1 - 1e-12) - 1e-9:
        assert after == target


def test_put_touches_nothing_else() -> None:
    row = np.arange(8.0)
    put(row, 2, (20.0, 30.0, 40.0))
    assert row.tolist() == [0.0, 1.0, 20.0, 30.0, 40.0, 5.0, 6.0, 7.0]


def test_only_marked_functions_are_kernels() -> None:
    assert is_kernel(clip)
    assert not is_kernel(forget)
    assert not is_kernel(math.sqrt)
    assert not is_kernel(3.0)


def test_a_stage_is_a_kernel_too() -> None:
    step, part = stage(lambda value: value), kernel(lambda value: value)
    assert (is_kernel(step), is_stage(step)) == (True, True)
    assert (is_kernel(part), is_stage(part)) == (True, False)
