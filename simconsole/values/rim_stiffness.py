"""What a car's steering is like about the middle, as far as a wheel's motor must know it."""

from typing import Final, NamedTuple


class RimStiffness(NamedTuple):
    """Torque at the rim per rad of the hand wheel before the car answers by turning, in N m per rad, by speed."""

    at_0mps: float
    at_12mps: float
    at_24mps: float
    at_36mps: float
    at_48mps: float
    relaxation_m: float  # length over which the front tyres answer


NO_STIFFNESS: Final = RimStiffness(*(0.0,) * len(RimStiffness._fields))
"""A vehicle whose steering feels nothing."""
