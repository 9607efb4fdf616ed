"""The operators' plots: which lines each shows, and what is computed for them. Pure arrays, no rerun."""

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np

from simconsole.scene.entities import Array, Colour
from simconsole.values.signals import NEVER_TICKS
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS, RPM_PER_RADPS
from simconsole.world.route import Route

CAR: Final[Colour] = (142, 152, 170)
"""As all of these, to be seen on a dark and on a light ground."""
PERSON: Final[Colour] = (255, 176, 32)
AUTOPILOT: Final[Colour] = (54, 217, 123)
APPLIED: Final[Colour] = (80, 150, 255)
LIMIT: Final[Colour] = (235, 80, 80)
OTHER: Final[Colour] = (178, 128, 214)

LATERAL_CM: Final = "scene.lateral_cm"
ROS_AGE_MS: Final = "scene.ros_age_ms"
ECU_AGE_MS: Final = "scene.ecu_age_ms"
LIMIT_KMH: Final = "scene.limit_kmh"
COMPUTED: Final = (LATERAL_CM, ROS_AGE_MS, ECU_AGE_MS, LIMIT_KMH)
"""What no state vector holds as it is shown."""
CM_PER_M: Final = 100.0
MS_PER_S: Final = 1000.0
NOT_YET: Final = np.nan
"""A line has a gap where there is nothing to show."""


class Series(NamedTuple):
    """One line of a plot."""

    name: str
    column: str
    factor: float
    colour: Colour


class Plot(NamedTuple):
    """One plot: its entity path, its title with unit, its lines and its fixed range, if any."""

    path: str
    title: str
    series: tuple[Series, ...]
    low: float | None = None
    high: float | None = None


def _pedal(name: str) -> Plot:
    """Return the plot of a pedal: what each side asks for, and what is applied."""
    asked = (
        Series("driver asks", f"arbitration.person_{name}", 1.0, PERSON),
        Series("autopilot asks", f"arbitration.remote_{name}", 1.0, AUTOPILOT),
        Series("applied", f"command.{name}", 1.0, APPLIED),
    )
    return Plot(f"plots/{name}", f"{name} asked and applied, 0 to 1", asked, -0.05, 1.05)


LINK_AGE: Final = Plot(
    "plots/link_age",
    "age of the newest command, ms",
    (
        Series("ROS", ROS_AGE_MS, 1.0, AUTOPILOT),
        Series("CAN", ECU_AGE_MS, 1.0, PERSON),
    ),
)
AUTHORITY: Final = Plot(
    "plots/authority",
    "autopilot's authority, 0 to 1",
    (
        Series("lateral", "arbitration.remote_lateral", 1.0, AUTOPILOT),
        Series("longitudinal", "arbitration.remote_longitudinal", 1.0, OTHER),
    ),
    -0.05,
    1.05,
)
PLOTS: Final[tuple[Plot, ...]] = (
    Plot(
        "plots/speed",
        "speed, km/h",
        (
            Series("car", "vehicle.vx_mps", KMH_PER_MPS, CAR),
            Series("limit", LIMIT_KMH, 1.0, LIMIT),
        ),
    ),
    Plot("plots/lateral_error", "lateral error, cm, left positive", (Series("car", LATERAL_CM, 1.0, CAR),)),
    Plot(
        "plots/road_wheel",
        "road wheel asked and applied, deg, left positive",
        (
            Series("driver asks", "arbitration.person_road_wheel_rad", DEG_PER_RAD, PERSON),
            Series("autopilot asks", "arbitration.remote_road_wheel_rad", DEG_PER_RAD, AUTOPILOT),
            Series("applied", "command.road_wheel_rad", DEG_PER_RAD, APPLIED),
            Series("car", "vehicle.road_wheel_rad", DEG_PER_RAD, CAR),
        ),
    ),
    Plot(
        "plots/wheel_torque",
        "hand wheel torque, N m, left positive",
        (
            Series("wheel", "torque.torque_nm", 1.0, APPLIED),
            Series("of the car", "torque.car_nm", 1.0, CAR),
            Series("servo", "torque.servo_nm", 1.0, AUTOPILOT),
            Series("guidance", "torque.guide_nm", 1.0, OTHER),
            Series("hands", "torque.human_nm", 1.0, PERSON),
        ),
    ),
    _pedal("throttle"),
    _pedal("brake"),
    LINK_AGE,
    AUTHORITY,
    Plot("plots/engine", "engine, rpm", (Series("engine", "vehicle.engine_radps", RPM_PER_RADPS, CAR),)),
)
ROBOT_PLOTS: Final[tuple[Plot, ...]] = (
    Plot(
        "plots/speed",
        "speed asked and driven, m/s",
        (
            Series("asked", "command.target_speed_mps", 1.0, APPLIED),
            Series("robot", "vehicle.vx_mps", 1.0, CAR),
        ),
    ),
    Plot(
        "plots/yaw_rate",
        "yaw rate asked and driven, deg/s, left positive",
        (
            Series("asked", "command.target_yaw_rate_radps", DEG_PER_RAD, APPLIED),
            Series("robot", "vehicle.yaw_rate_radps", DEG_PER_RAD, CAR),
        ),
    ),
    LINK_AGE,
    AUTHORITY,
)
"""Of what has neither engine nor steered wheels, and follows no path."""


def plots_of(is_robot: bool) -> tuple[Plot, ...]:
    """Return the plots of a robot, or of any other vehicle."""
    return ROBOT_PLOTS if is_robot else PLOTS


def plot_columns(is_robot: bool) -> tuple[str, ...]:
    """Return the columns of a state vector that the plots read."""
    lines = (line.column for plot in plots_of(is_robot) for line in plot.series if line.column not in COMPUTED)
    return tuple(dict.fromkeys((*lines, "vehicle.x_m", "vehicle.y_m", "ros.age_ticks", "ecu.age_ticks")))


class Follower:
    """Where the vehicle is along its route, followed from each piece of a drive to the next."""

    def __init__(self, route: Route | None = None) -> None:
        self.route = route
        self.s_m: float | None = None

    def follow(self, x_m: Array, y_m: Array) -> tuple[Array, Array] | None:
        """Return (s_m, lateral_m) of places in their order; None without a route or without places."""
        if self.route is None or not len(x_m):
            return None
        along, lateral = self.route.project_all(x_m, y_m, self.s_m)
        self.s_m = float(along[-1])
        return along, lateral


def plot_lines(
    table: Mapping[str, Array], tick_hz: int, follower: Follower, is_robot: bool = False
) -> dict[str, Array]:
    """Return each plot's lines [N, lines], by its entity path; NaN where there is nothing to show.

    Args:
        table: `plot_columns` of state vectors in their order.
        tick_hz: ticks per second.
        follower: of the route.
        is_robot: whose plots they are.
    """
    found = {**table, **_computed(table, tick_hz, follower)}
    plots = plots_of(is_robot)
    return {plot.path: np.column_stack([line.factor * found[line.column] for line in plot.series]) for plot in plots}


def _computed(table: Mapping[str, Array], tick_hz: int, follower: Follower) -> dict[str, Array]:
    nothing = np.full(len(table["vehicle.x_m"]), NOT_YET)
    place = follower.follow(table["vehicle.x_m"], table["vehicle.y_m"])
    limit = nothing
    if place is not None and follower.route is not None:
        limit = KMH_PER_MPS * follower.route.limits_at(place[0])
    return {
        LATERAL_CM: nothing if place is None else CM_PER_M * place[1],
        LIMIT_KMH: limit,
        ROS_AGE_MS: _age_ms(table["ros.age_ticks"], tick_hz),
        ECU_AGE_MS: _age_ms(table["ecu.age_ticks"], tick_hz),
    }


def _age_ms(age_ticks: Array, tick_hz: int) -> Array:
    return np.where(age_ticks < NEVER_TICKS, age_ticks * (MS_PER_S / tick_hz), NOT_YET)
