"""Kernels in lanes: every construct that kernels use gives each lane what the plain function gives it."""

import math
import random
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest

from simconsole.kernels import Row, approach, clip, is_finite, kernel, put, take
from simconsole.lane_values import LANES
from simconsole.lanes import lane_step
from simconsole.trigonometry import atan, sin, wrap_angle
from tests.samples import Sample

GEARS = (3.5, 2.0, 1.3)
IN_WIDTH = 3
OUT_AT = 3
EDGES = (0.0, -0.0, 1.0, -1.0, 2.5, math.inf, -math.inf, math.nan, 1e-310, 1e300)


class Pair(NamedTuple):
    one: float
    two: float


@kernel
def early(a: float, b: float, c: float) -> Pair:
    if a < b:
        if c > 0.0:
            return Pair(a, 1.0)
        b = b + 1.0
    elif a != c:
        return Pair(c, two=2.0)
    else:
        b += 2.0
    if not is_finite(b):
        b = -c if c == c else 5.0
    return Pair(b * a, 3.0)


@kernel
def choices(a: float, b: float, c: float) -> Pair:
    inside = -1.0 < a <= 1.0 and not b > c
    chosen = Pair(a, b) if inside or c == 2.5 else Pair(b, c)
    first, second = chosen.two, chosen.one
    sign = inside != (a > 0.0) if False else a >= 0.0
    return Pair(first if sign else -second, abs(clip(a, -0.5, 0.5) - approach(b, c, 0.25)))


@kernel
def search(a: float, b: float, c: float) -> Pair:
    gear = 1.0
    speed = clip(abs(a), 0.0, 50.0) if a == a else 7.0
    if b > 0.0:
        while gear < 6.0 and speed > 3.0 * gear:
            gear += 1.0
            speed = speed - 0.125 * gear
    total = 0.0
    for index in range(3):
        total += GEARS_SUM * index
    return Pair(gear + total, math.sqrt(speed) / c)


GEARS_SUM = GEARS[0] + GEARS[1] + GEARS[2]


@kernel
def angles(a: float, b: float, c: float) -> Pair:
    return Pair(sin(a) + atan(b), wrap_angle(c))


@kernel
def looped(a: float, b: float, c: float, substeps: int) -> Pair:
    pair = Pair(a, b)
    done = False
    for _ in range(substeps):
        if pair.one > c:
            done = not done
            pair = Pair(pair.two, pair.one - 0.5)
        else:
            pair = Pair(pair.one + 0.25, pair.two)
    return Pair(1.0 if done else pair.one, pair.two)


@kernel
def step_early(previous: Row, row: Row, parameters: Row, substeps: int) -> None:
    """A docstring is no statement."""
    put(row, OUT_AT, early(*take(previous, 0, IN_WIDTH)))


@kernel
def step_choices(previous: Row, row: Row, parameters: Row, substeps: int) -> None:
    a, b, c = take(previous, 0, IN_WIDTH)
    put(row, OUT_AT, choices(a, c=c, b=b))


@kernel
def step_search(previous: Row, row: Row, parameters: Row, substeps: int) -> None:
    put(row, OUT_AT, search(*take(previous, 0, IN_WIDTH)))


@kernel
def step_angles(previous: Row, row: Row, parameters: Row, substeps: int) -> None:
    put(row, OUT_AT, angles(*take(previous, 0, IN_WIDTH)))


@kernel
def step_looped(previous: Row, row: Row, parameters: Row, substeps: int) -> None:
    a, b, c = take(previous, 0, IN_WIDTH)
    put(row, OUT_AT, looped(a, b, c, substeps))


STEPS = [step_early, step_choices, step_search, step_angles, step_looped]


@pytest.mark.parametrize("step", STEPS, ids=lambda step: step.__name__)
def test_a_lane_holds_what_the_plain_function_gives(step: Callable[..., None], sample: Sample) -> None:
    rng = random.Random(sample.seed)
    blocks = 40
    rows = np.zeros((blocks, OUT_AT + 2, LANES))
    for block in rows:
        for column in range(IN_WIDTH):
            block[column] = [rng.choice([*EDGES, rng.gauss(0.0, 2.0), rng.gauss(0.0, 9.0)]) for _ in range(LANES)]
    constants = np.zeros(1)
    before = rows.copy()
    lane_step(step, 0, OUT_AT + 2, 1, True).run(rows.ctypes.data, constants.ctypes.data, 7, blocks)
    compared = 0
    for block, start in zip(rows, before, strict=True):
        for lane in range(LANES):
            alone = start[:, lane].copy()
            try:
                step(alone, alone, constants, 7)
            except ZeroDivisionError:
                continue  # in lanes an infinity; kernels divide by nothing that can be 0
            assert repr(alone.tolist()) == repr(block[:, lane].tolist())
            compared += 1
    assert compared > 100


@kernel
def conditional_store(previous: Row, row: Row, parameters: Row, substeps: int) -> None:
    (a,) = take(previous, 0, 1)
    if a > 0.0:
        put(row, 1, (a,))


@kernel
def left_loop(previous: Row, row: Row, parameters: Row, substeps: int) -> None:
    (a,) = take(previous, 0, 1)
    while a < 3.0:
        a += 1.0
        if a > 2.0:
            break
    put(row, 1, (a,))


@kernel
def power(previous: Row, row: Row, parameters: Row, substeps: int) -> None:
    (a,) = take(previous, 0, 1)
    put(row, 1, (a**2,))


@kernel
def stranger(previous: Row, row: Row, parameters: Row, substeps: int) -> None:
    (a,) = take(previous, 0, 1)
    put(row, 1, (math.floor(a),))


@pytest.mark.parametrize(
    ("step", "what"),
    [
        (conditional_store, "outside every condition"),
        (left_loop, "left_loop: lanes have no way for `while a < 3.0"),
        (power, "lanes have no Pow"),
        (stranger, "stranger: lanes have no way for `math.floor"),
        (len, "is not a kernel"),
    ],
)
def test_what_lanes_cannot_do_is_refused(step: Callable[..., Any], what: str) -> None:
    with pytest.raises(TypeError, match=what):
        lane_step(step, 0, 2, 1, True)
