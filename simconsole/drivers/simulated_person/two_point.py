"""Steering by two points of the road: the far one tells how it bends, the near one where the car is in its lane. Pure.

The law is that of Salvucci and Gray, "A two-point visual control model of steering", Perception 33 (2004) 1233-1248:
the rate of the hand wheel is k_far times the rate of the far point's direction, plus k_near times that of the near
point's, plus k_I times the near point's direction itself. The gains stand to each other as 16 : 4 : 3 1/s, those of
Salvucci, "Modeling driver behavior in a cognitive architecture", Human Factors 48 (2006) 362-380. Ours is:

- The scale. A direction is expressed as the hand-wheel angle whose circle leads to a point at the far point's distance
  (`wheel_to`), by wheelbase, steering ratio and understeer of the car that the person is used to. With k_far + k_near
  = 1 the wheel then turns as far as a bend needs, whatever its radius and the speed.
- The last term is what is missing at the wheel, not the direction itself: in a bend of constant radius the near point
  lies aside although nothing has to be corrected.
- The distances. 8 m is that of Neumann and Deml, "The two-point visual control model of steering: new empirical
  evidence", LNCS 6777 (2011) 493-502; at low speed the points come nearer. Theirs for the far region, 0.9 s, swings at
  motorway speeds with the delays of eye, arm and car; 1.3 s does not.
"""

import math
from typing import Final, NamedTuple

from simconsole.profiles.person import Habits, RoadHabits

NEAREST_M: Final = 4.5
NEAR_S: Final = 0.7
"""Below near_m / NEAR_S of speed the near point comes nearer, down to NEAREST_M."""
SLOW_MPS: Final = 3.0
"""Slower than this the near point is corrected more slowly: at rest not at all."""
MOST_RAD: Final = 8.0
"""No car needs more of the hand wheel to one side."""


class Points(NamedTuple):
    """Hand-wheel angles in rad that lead to the two points."""

    near_rad: float
    far_rad: float


def distances_m(speed_mps: float, road: RoadHabits) -> tuple[float, float]:
    """Return how far ahead of base_link the near and the far point are, along the road."""
    near_m = min(road.near_m, max(NEAREST_M, NEAR_S * speed_mps))
    return near_m, max(near_m, road.far_s * speed_mps)


def wheel_to(ahead_m: float, left_m: float, speed_mps: float, habits: Habits, road: RoadHabits) -> float:
    """Return the hand-wheel angle in rad of the circle through a point, `ahead_m` and `left_m` of base_link.

    A circle from base_link along x through the point has the curvature 2 y / (x^2 + y^2); the car's part is the linear
    single-track model's.
    """
    curvature_1pm = 2.0 * left_m / (ahead_m * ahead_m + left_m * left_m)
    length_m = habits.wheelbase_m + road.understeer_radps2pm * speed_mps * speed_mps
    return curvature_1pm * length_m * habits.steering_ratio


class TwoPointSteering:
    """The hand wheel of a person who steers by two points; `turn` once per tick."""

    def __init__(self, road: RoadHabits, tick_s: float) -> None:
        """Take the person's habits and the length of a tick."""
        self._road = road
        self._tick_s = tick_s
        self._wheel_rad = 0.0
        self._shown_rad: float | None = None

    def begin(self, hand_wheel_rad: float) -> None:
        """Go on from where the wheel is: somebody else has steered."""
        self._wheel_rad = hand_wheel_rad
        self._shown_rad = None

    def turn(self, points: Points, speed_mps: float, hand_wheel_rad: float) -> float:
        """Return the wanted hand-wheel angle in rad, from what is seen and where the wheel is felt to be."""
        near_m, far_m = distances_m(speed_mps, self._road)
        share = near_m / far_m
        weight = self._road.near_gain * share
        shown_rad = (1.0 - weight) * points.far_rad + weight * points.near_rad
        turned_rad = 0.0 if self._shown_rad is None else shown_rad - self._shown_rad
        self._shown_rad = shown_rad
        rate = self._road.near_rate_1ps * share * min(1.0, max(0.0, speed_mps / SLOW_MPS))
        wheel_rad = self._wheel_rad + turned_rad + rate * (points.near_rad - hand_wheel_rad) * self._tick_s
        self._wheel_rad = math.copysign(min(MOST_RAD, abs(wheel_rad)), wheel_rad)
        return self._wheel_rad
