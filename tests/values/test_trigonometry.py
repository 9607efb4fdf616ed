"""The kernels against 60-digit references computed here with `decimal`, and the twin."""

import math
import random
from collections.abc import Callable
from decimal import Decimal, localcontext
from typing import Any

import pytest

from simconsole.values import trigonometry as trig
from simconsole.values.host.jit import compiled
from tests.samples import Sample

DIGITS = 60


def arctan_reference(x: Decimal) -> Decimal:
    """Return atan(x): halve the angle until the series is short."""
    halvings = 0
    while abs(x) > Decimal("0.02"):
        x = x / (1 + (1 + x * x).sqrt())
        halvings += 1
    term, total, n = x, x, 1
    while abs(term) > Decimal(10) ** -(DIGITS + 5):
        term = -term * x * x
        n += 2
        total += term / n
    return total * 2**halvings  # type: ignore[no-any-return]


def sine_reference(x: Decimal, pi: Decimal) -> Decimal:
    x = x - (x / (2 * pi)).to_integral_value() * 2 * pi
    term, total, n = x, x, 1
    while abs(term) > Decimal(10) ** -(DIGITS + 5):
        term = -term * x * x / ((n + 1) * (n + 2))
        n += 2
        total += term
    return total


@pytest.fixture(scope="module")
def pi() -> Decimal:
    with localcontext() as context:
        context.prec = DIGITS + 30
        return 4 * arctan_reference(Decimal(1))


def angles(limit: float, count: int, seed: int) -> list[float]:
    rng = random.Random(seed)
    near_quarters = [math.nextafter(k * math.pi / 2, 1e9 * (-1) ** k) for k in range(-40, 41)]
    special = [0.0, -0.0, 1e-300, math.pi, -math.pi, 6.5, limit, -limit, *near_quarters]
    return special + [rng.uniform(-limit, limit) for _ in range(count)] + [rng.gauss(0.0, 2.0) for _ in range(count)]


@pytest.mark.parametrize(("limit", "bound"), [(1e4, 2.5e-16), (1e6, 1e-15)])
def test_sine_and_cosine_stay_within_the_stated_bound(limit: float, bound: float, pi: Decimal, sample: Sample) -> None:
    worst = 0.0
    with localcontext() as context:
        context.prec = DIGITS + 30
        for x in angles(limit, sample.of(600, 6_000), sample.seed):
            exact = Decimal(x)
            worst = max(worst, float(abs(Decimal(trig.sin(x)) - sine_reference(exact, pi))))
            worst = max(worst, float(abs(Decimal(trig.cos(x)) - sine_reference(exact + pi / 2, pi))))
    print(f"worst error {worst:.3g}")
    assert worst <= bound


def test_arctangents_stay_within_three_units_in_the_last_place(pi: Decimal, sample: Sample) -> None:
    rng = random.Random(sample.seed)
    worst = 0.0
    with localcontext() as context:
        context.prec = DIGITS + 30
        for _ in range(sample.of(1500, 10_000)):
            slope = rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-20.0, 20.0)
            exact = arctan_reference(Decimal(slope))
            worst = max(worst, float(abs(Decimal(trig.atan(slope)) - exact)) / math.ulp(float(exact)))
            y, x = rng.gauss(0.0, 1.0), rng.gauss(0.0, 1.0)
            exact = arctan_reference(Decimal(y) / Decimal(x))
            if x < 0.0:
                exact += pi if y >= 0.0 else -pi
            worst = max(worst, float(abs(Decimal(trig.atan2(y, x)) - exact)) / math.ulp(float(exact)))
    print(f"worst error {worst:.3g} ulp")
    assert worst <= 3.0


def test_constants_are_pi(pi: Decimal) -> None:
    with localcontext() as context:
        context.prec = DIGITS
        assert abs(Decimal(trig._PART_1) + Decimal(trig._PART_2) + Decimal(trig._PART_3) - pi / 2) < Decimal("1e-36")
        assert abs(Decimal(trig.HALF_PI) + Decimal(trig._HALF_PI_TAIL) - pi / 2) < Decimal("1e-32")
    assert math.pi == trig.PI
    assert math.tau == trig.TWO_PI


def test_symmetry_is_exact(sample: Sample) -> None:
    for x in angles(1e4, sample.of(300, 300_000), sample.seed):
        assert trig.sin(-x) == -trig.sin(x)
        assert trig.cos(-x) == trig.cos(x)
        assert trig.atan(-x) == -trig.atan(x)
        assert trig.atan2(-x, 0.7) == -trig.atan2(x, 0.7)


def test_named_points() -> None:
    assert trig.sin(0.0) == 0.0
    assert trig.cos(0.0) == 1.0
    assert trig.atan(math.inf) == trig.HALF_PI
    assert trig.atan2(0.0, 0.0) == 0.0
    assert trig.atan2(0.0, -1.0) == trig.PI
    assert trig.atan2(1.0, 0.0) == trig.HALF_PI
    for function in (trig.sin, trig.cos, trig.atan, trig.wrap_angle, lambda x: trig.atan2(x, 1.0)):
        assert math.isnan(function(math.nan))
    assert math.isnan(trig.atan2(1.0, math.nan))


def test_wrapping_keeps_the_direction_and_the_range(sample: Sample) -> None:
    for x in angles(1e4, sample.of(600, 600_000), sample.seed):
        wrapped = trig.wrap_angle(x)
        assert abs(wrapped) <= trig.PI
        assert abs(math.sin(wrapped) - math.sin(x)) < 1e-15
        assert abs(math.cos(wrapped) - math.cos(x)) < 1e-15
        assert trig.wrap_angle(wrapped) == wrapped
    assert trig.wrap_angle(3.5) == pytest.approx(3.5 - 2.0 * math.pi, abs=1e-15)


@pytest.mark.parametrize("function", [trig.sin, trig.cos, trig.atan, trig.wrap_angle])
def test_compiled_twin_has_equal_bits(function: Callable[[float], float], sample: Sample) -> None:
    fast = compiled(function)
    for x in [*angles(1e4, sample.of(3000, 300_000), sample.seed), math.inf, -math.inf, 1e18]:
        plain_bits, fast_bits = function(x), fast(x)
        assert plain_bits == fast_bits or (math.isnan(plain_bits) and math.isnan(fast_bits)), x


def test_compiled_atan2_has_equal_bits(sample: Sample) -> None:
    rng = random.Random(sample.seed)
    fast = compiled(trig.atan2)
    values = [0.0, -0.0, 1.0, -1.0]
    pairs = [(y, x) for y in values for x in values]
    pairs += [(rng.gauss(0.0, 1.0), rng.gauss(0.0, 1.0)) for _ in range(sample.of(3000, 300_000))]
    for y, x in pairs:
        assert trig.atan2(y, x) == fast(y, x)


@pytest.mark.parametrize("execution", [lambda f: f, compiled])
def test_direction_is_cosine_and_sine_to_the_last_bit(execution: Callable[..., Any], sample: Sample) -> None:
    both = execution(trig.direction)
    quarters = [0.25 * k * math.pi for k in range(-40, 41)]
    for angle in [*quarters, *angles(1e4, sample.of(5000, 200_000), sample.seed)]:
        assert tuple(both(angle)) == (trig.cos(angle), trig.sin(angle)), angle
