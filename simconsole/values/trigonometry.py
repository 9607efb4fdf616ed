"""sin, cos, atan and atan2 from + - * / alone: the same bits on every machine, plain and compiled.

The C library's functions differ between versions and processors (FMA variants), so none may stand in state feedback.
Method: subtract the nearest multiple of a quarter turn (Cody and Waite, Software Manual for the Elementary Functions,
1980: pi/2 in three parts, the first two with 33 bits so that the products are exact), then the Taylor series, long
enough that its remainder stays below half a unit in the last place of 1. Every function is exactly odd or even.

Bounds, tested against 60-digit values (tests/values/test_trigonometry.py): sin and cos 2.5e-16 absolute for
abs(x) <= 1e4 and 1e-15 for abs(x) <= 1e6; atan and atan2 3 units in the last place, everywhere. NaN in gives NaN out,
nothing raises.
"""

from typing import Final, NamedTuple

from simconsole.values.kernels import kernel

PI: Final = 3.141592653589793
TWO_PI: Final = 6.283185307179586
HALF_PI: Final = 1.5707963267948966
_HALF_PI_TAIL: Final = 6.123233995736766e-17  # pi/2 = HALF_PI + this, to 106 bits

_TWO_OVER_PI: Final = 0.6366197723675814
_FIRST_EIGHTH: Final = 0.785  # less than an eighth of a turn
_PART_1: Final = 1.5707963267341256  # first 33 bits of pi/2
_PART_2: Final = 6.077100506303966e-11  # next 33 bits
_PART_3: Final = 2.0222662487959506e-21  # the rest, rounded

# 1.5 * 2**52: adding and subtracting it rounds a double of less than 2**51 to the nearest integer, half to even.
_ROUND: Final = 6755399441055744.0

_S3: Final = -1.0 / 6.0
_S5: Final = 1.0 / 120.0
_S7: Final = -1.0 / 5040.0
_S9: Final = 1.0 / 362880.0
_S11: Final = -1.0 / 39916800.0
_S13: Final = 1.0 / 6227020800.0
_S15: Final = -1.0 / 1307674368000.0
_C4: Final = 1.0 / 24.0
_C6: Final = -1.0 / 720.0
_C8: Final = 1.0 / 40320.0
_C10: Final = -1.0 / 3628800.0
_C12: Final = 1.0 / 479001600.0
_C14: Final = -1.0 / 87178291200.0
_C16: Final = 1.0 / 20922789888000.0

_T3: Final = -1.0 / 3.0
_T5: Final = 1.0 / 5.0
_T7: Final = -1.0 / 7.0
_T9: Final = 1.0 / 9.0
_T11: Final = -1.0 / 11.0
_T13: Final = 1.0 / 13.0
_T15: Final = -1.0 / 15.0
_T17: Final = 1.0 / 17.0
_ATAN_QUARTER: Final = 0.24497866312686414
_ATAN_HALF: Final = 0.4636476090008061
_ATAN_THREE_QUARTERS: Final = 0.6435011087932844
_ATAN_ONE: Final = 0.7853981633974483


@kernel
def nearest(value: float) -> float:
    """Return the nearest whole number, half to even; exact for abs(value) < 2**51."""
    return (value + _ROUND) - _ROUND


@kernel
def sin(angle_rad: float) -> float:
    """Return the sine of an angle in rad. Error bound: see the module."""
    turns = nearest(angle_rad * _TWO_OVER_PI)
    rest = ((angle_rad - turns * _PART_1) - turns * _PART_2) - turns * _PART_3
    return _quadrant(turns - 4.0 * nearest(0.25 * turns), rest)


@kernel
def cos(angle_rad: float) -> float:
    """Return the cosine of an angle in rad. Error bound: see the module."""
    angle = abs(angle_rad)
    turns = nearest(angle * _TWO_OVER_PI)
    rest = ((angle - turns * _PART_1) - turns * _PART_2) - turns * _PART_3
    return _quadrant(turns + 1.0 - 4.0 * nearest(0.25 * (turns + 1.0)), rest)


class Direction(NamedTuple):
    """Cosine and sine of one angle."""

    cos: float
    sin: float


@kernel
def direction(angle_rad: float) -> Direction:
    """Return cosine and sine of an angle in rad, faster than one after the other: the same bits as `cos` and `sin`."""
    rest = angle_rad
    quarter = 0.0
    if abs(angle_rad) > _FIRST_EIGHTH:  # elsewhere there is no turn to take off
        turns = nearest(angle_rad * _TWO_OVER_PI)
        rest = ((angle_rad - turns * _PART_1) - turns * _PART_2) - turns * _PART_3
        quarter = turns - 4.0 * nearest(0.25 * turns)
    s = _sine_series(rest)
    c = _cosine_series(rest)
    if quarter == 0.0:
        return Direction(c, s)
    if quarter == 1.0:
        return Direction(-s, c)
    if quarter == -1.0:
        return Direction(s, -c)
    return Direction(-c, -s)


@kernel
def _quadrant(quarter: float, rest: float) -> float:
    """Return sin(quarter * pi/2 + rest) for quarter in -2..2 and abs(rest) <= pi/4."""
    if quarter == 0.0:
        return _sine_series(rest)
    if quarter == 1.0:
        return _cosine_series(rest)
    if quarter == -1.0:
        return -_cosine_series(rest)
    return -_sine_series(rest)


@kernel
def _sine_series(x: float) -> float:
    s = x * x
    tail = _S9 + s * (_S11 + s * (_S13 + s * _S15))
    return x + x * s * (_S3 + s * (_S5 + s * (_S7 + s * tail)))


@kernel
def _cosine_series(x: float) -> float:
    s = x * x
    tail = _C10 + s * (_C12 + s * (_C14 + s * _C16))
    # 1 - s/2 loses bits where s/2 is large; the second term gives them back (exact: 1 - half is a small sum).
    half = 0.5 * s
    head = 1.0 - half
    return head + (((1.0 - head) - half) + s * s * (_C4 + s * (_C6 + s * (_C8 + s * tail))))


@kernel
def atan(slope: float) -> float:
    """Return the angle in rad, -pi/2 to pi/2, whose tangent is `slope`."""
    size = abs(slope)
    angle = _atan_unit(size) if size <= 1.0 else HALF_PI - (_atan_unit(1.0 / size) - _HALF_PI_TAIL)
    if slope < 0.0:
        return -angle
    return angle


@kernel
def _atan_unit(x: float) -> float:
    """Return atan(x) for 0 <= x <= 1: atan(c) + atan((x - c) / (1 + c*x)) with the nearest c of 0, 1/4 ... 1."""
    near = 0.0
    angle = 0.0
    if x >= 0.125:
        near = 0.25
        angle = _ATAN_QUARTER
    if x >= 0.375:
        near = 0.5
        angle = _ATAN_HALF
    if x >= 0.625:
        near = 0.75
        angle = _ATAN_THREE_QUARTERS
    if x >= 0.875:
        near = 1.0
        angle = _ATAN_ONE
    return angle + _atan_series((x - near) / (1.0 + near * x))


@kernel
def _atan_series(x: float) -> float:
    s = x * x
    tail = _T11 + s * (_T13 + s * (_T15 + s * _T17))
    return x + x * s * (_T3 + s * (_T5 + s * (_T7 + s * (_T9 + s * tail))))


@kernel
def atan2(y: float, x: float) -> float:
    """Return the angle in rad of the vector (x, y), -pi to pi; 0 for the zero vector, whatever its signs of zero."""
    height = abs(y)
    width = abs(x)
    if height > width:
        angle = HALF_PI - (_atan_unit(width / height) - _HALF_PI_TAIL)
    elif width > 0.0:
        angle = _atan_unit(height / width)
    else:
        angle = height + width  # 0, or NaN
    if x < 0.0:
        angle = PI - (angle - 2.0 * _HALF_PI_TAIL)
    if y < 0.0:
        return -angle
    return angle


@kernel
def wrap_angle(angle_rad: float) -> float:
    """Return the angle in rad, brought into -pi..pi by whole turns; angles already inside come back unchanged."""
    if abs(angle_rad) <= PI:
        return angle_rad
    turns = 4.0 * nearest(angle_rad / TWO_PI)
    return ((angle_rad - turns * _PART_1) - turns * _PART_2) - turns * _PART_3
