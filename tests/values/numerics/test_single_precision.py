import math
import struct

import numpy as np

from simconsole.values.numerics.single_precision import toward_zero


def test_what_a_float32_can_hold_stays() -> None:
    for value in (0.0, 0.5, -3.25, 2.0**-140, 1e30 * 0.0):
        assert toward_zero(value) == value


def test_it_is_the_next_float32_and_never_larger() -> None:
    rng = np.random.default_rng(3)
    for value in (1.2, -1.2, 80.1, -12.000001, *rng.normal(0.0, 10.0, 500).tolist()):
        single = toward_zero(value)
        assert struct.unpack("<f", struct.pack("<f", single))[0] == single
        assert abs(single) <= abs(value)
        assert np.nextafter(np.float32(single), np.float32(math.copysign(math.inf, value))).astype(float) * np.sign(
            value
        ) > abs(value)
