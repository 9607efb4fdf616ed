"""Values in the precision of float32, which many messages have."""

import struct
from typing import Final

_SINGLE: Final = struct.Struct("<f")
_BITS: Final = struct.Struct("<I")


def toward_zero(value: float) -> float:
    """Return the float32 that is next to a finite float64 and not larger: what was within a limit stays within it."""
    packed = _SINGLE.pack(value)
    (single,) = _SINGLE.unpack(packed)
    if abs(single) <= abs(value):
        return float(single)
    return float(_SINGLE.unpack(_BITS.pack(_BITS.unpack(packed)[0] - 1))[0])  # sign and magnitude: one step towards 0
