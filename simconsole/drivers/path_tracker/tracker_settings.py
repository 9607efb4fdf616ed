"""Parameters of the path tracker: the car's model, the comfort limits, the timing and the cost."""

import math
from typing import Final, NamedTuple

TRACKERS: Final = ("preview", "pure_pursuit", "stanley")
"""Ways to steer by their names: the path tracker with preview, and two plain ones to compare with."""


class CarModel(NamedTuple):
    """The controller's linear single-track model, by default of the car in profiles/vehicles/hatchback.yaml.

    The axles' stiffness is an eighth below the profile's, which is that of small slip: measured as the value with
    which the car follows random courses best.
    """

    mass_kg: float = 1300.0
    yaw_inertia_kgm2: float = 1900.0
    front_m: float = 1.04  # centre of gravity to front axle
    rear_m: float = 1.56  # centre of gravity to rear axle
    front_stiffness_nprad: float = 80_300.0  # both wheels of the axle
    rear_stiffness_nprad: float = 66_900.0
    steering_lag_s: float = 0.05
    max_road_wheel_rad: float = 0.6

    @property
    def wheelbase_m(self) -> float:
        """Distance of the axles."""
        return self.front_m + self.rear_m

    @property
    def understeer_radps2pm(self) -> float:
        """Road-wheel angle per lateral acceleration beyond the kinematic angle (rad s2/m), > 0: understeering.

        m/L (l_r/C_f - l_f/C_r), any text on the linear single-track model (Riekert and Schunck, 1940).
        """
        balance = self.rear_m / self.front_stiffness_nprad - self.front_m / self.rear_stiffness_nprad
        return self.mass_kg / self.wheelbase_m * balance


class Comfort(NamedTuple):
    """Limits of the speed profile."""

    lateral_mps2: float = 1.9  # planned; the car itself stays within 2.5
    accelerate_mps2: float = 1.6
    brake_mps2: float = 1.6
    brake_most_mps2: float = 2.0  # where the car is faster than planned
    smoothing_s: float = 1.0  # window of the moving average: jerk is bounded by the change of acceleration over it
    lateral_jerk_mps3: float = 2.5  # on the curvature ramps; the console's gate lets 7 pass
    margin_mps: float = 0.3  # kept below the speed limit, so that overshoot does not exceed it


class Gate(NamedTuple):
    """What the console lets pass of steering while the autopilot drives; by default that of a session as shipped."""

    lateral_mps2: float = 5.0
    lateral_jerk_mps3: float = 7.0  # 0: no limit


class Timing(NamedTuple):
    """The control loop's time structure."""

    period_s: float = 0.02
    delay_s: float = 0.01  # from the pose's time stamp to the command at the actuator
    preview_steps: int = 60
    pose_share: float = 0.04  # of a measured position in the estimate; the rest is the measured velocities' work
    yaw_share: float = 0.02


class Weights(NamedTuple):
    """The quadratic cost: per m2 of offset, per (m/s)2 of drift, per rad2 of steering change in one period."""

    offset: float = 1.0
    drift: float = 0.05
    change: float = 5.0
    gentle_mps: float = 8.0


HATCHBACK: Final = CarModel()
COMFORT: Final = Comfort()
GATE: Final = Gate()
TIMING: Final = Timing()
WEIGHTS: Final = Weights()

_ASKED_SHARE: Final = 0.9
_PLANNED_ACCEL_SHARE: Final = 0.7
_PLANNED_JERK_SHARE: Final = 0.5
_MOST_ASKED: Final = Gate(4.5, 6.0)


def asked_at_most(gate: Gate) -> Gate:
    """Return how much lateral acceleration and jerk a command may ask for, so that the gate cuts nothing of it."""
    return Gate(
        min(_MOST_ASKED.lateral_mps2, _ASKED_SHARE * gate.lateral_mps2),
        min(_MOST_ASKED.lateral_jerk_mps3, _ASKED_SHARE * (gate.lateral_jerk_mps3 or math.inf)),
    )


def planned_within(comfort: Comfort, gate: Gate) -> Comfort:
    """Return the limits of a speed profile from which steering against errors has room below the gate's."""
    return comfort._replace(
        lateral_mps2=min(comfort.lateral_mps2, _PLANNED_ACCEL_SHARE * gate.lateral_mps2),
        lateral_jerk_mps3=min(comfort.lateral_jerk_mps3, _PLANNED_JERK_SHARE * (gate.lateral_jerk_mps3 or math.inf)),
    )
