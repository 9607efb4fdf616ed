"""The impulse where two bodies touch in the plane. A kernel.

Planar impact mechanics: Brach and Brach, Vehicle Accident Analysis and Reconstruction Methods, SAE 2005, chapter 6. The
impulse along the common normal ends the approach but for the restitution, the one along the surface ends sliding there
as far as friction goes. Restitution of cars that strike each other at more than walking pace is 0 to 0.3 in tests (as
summaries of that chapter say; the book was not at hand), 0.1 here; friction between sheet metal is about 0.5.
"""

from typing import Final, NamedTuple

from simconsole.values.kernels import kernel

RESTITUTION: Final = 0.1
FRICTION: Final = 0.5


class Mobility(NamedTuple):
    """By how many m/s the place of contact yields to 1 N s, both bodies together; axes normal and along the surface."""

    normal: float
    along: float
    mixed: float


class Impulse(NamedTuple):
    """What acts on the first body; the second gets the opposite."""

    normal_ns: float
    along_ns: float


@kernel
def impulse(normal_mps: float, sliding_mps: float, change_mps: float, at: Mobility) -> Impulse:
    """Return the impulse of a touch, none where it would pull.

    Args:
        normal_mps: velocity of the first body at the place, against the second one's, along the normal towards it.
        sliding_mps: the same along the surface.
        change_mps: by how much the first of the two shall change.
        at: what the bodies are like there.
    """
    determinant = at.normal * at.along - at.mixed * at.mixed
    normal_ns = (change_mps * at.along + sliding_mps * at.mixed) / determinant
    along_ns = (-sliding_mps * at.normal - change_mps * at.mixed) / determinant
    if abs(along_ns) > FRICTION * normal_ns:
        share = FRICTION if sliding_mps < 0.0 else -FRICTION
        normal_ns = change_mps / (at.normal + share * at.mixed)
        along_ns = share * normal_ns
    if normal_ns <= 0.0 or normal_mps >= 0.0:
        normal_ns, along_ns = 0.0, 0.0
    return Impulse(normal_ns, along_ns)
