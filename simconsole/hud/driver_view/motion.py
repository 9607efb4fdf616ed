"""What the picture shows of the vehicle: drawn between the two newest ticks, so that it moves at the display's rate."""

import math
from typing import NamedTuple

from simconsole.values.signals import Mode
from simconsole.values.state_vector import Snapshot
from simconsole.world.roads.running import NONE_RUNNING, RunningNow
from simconsole.world.traffic.road_users import RoadUser


class ShownVehicle(NamedTuple):
    """The driven vehicle at one moment between two ticks; pose of base_link in `map`."""

    t_s: float = 0.0
    x_m: float = 0.0
    y_m: float = 0.0
    z_m: float = 0.0
    yaw_rad: float = 0.0
    pitch_rad: float = 0.0
    roll_rad: float = 0.0
    road_wheel_rad: float = 0.0
    distance_m: float = 0.0
    brake: float = 0.0
    turn_indicators: float = 0.0  # 1 left, -1 right
    hazard_lights: float = 0.0
    mode: float = float(Mode.PARKED)
    others: tuple[RoadUser, ...] = ()
    tick: int = 0  # traffic lights show what they show at it
    tick_hz: int = 1
    signals: RunningNow = NONE_RUNNING  # unless another simulator runs them


def shown_vehicle(snapshot: Snapshot) -> ShownVehicle:
    """Return the vehicle as one tick has it."""
    vehicle, command = snapshot.vehicle, snapshot.command
    return ShownVehicle(
        t_s=snapshot.t_s,
        x_m=vehicle.x_m,
        y_m=vehicle.y_m,
        z_m=vehicle.z_m,
        yaw_rad=vehicle.yaw_rad,
        pitch_rad=vehicle.pitch_rad,
        roll_rad=vehicle.roll_rad,
        road_wheel_rad=vehicle.road_wheel_rad,
        distance_m=vehicle.distance_m,
        brake=command.brake,
        turn_indicators=command.turn_indicators,
        hazard_lights=command.hazard_lights,
        mode=snapshot.arbitration.mode,
        tick=snapshot.tick,
        tick_hz=snapshot.tick_hz,
    )


def between(older: ShownVehicle, newer: ShownVehicle, share: float) -> ShownVehicle:
    """Return the vehicle between two ticks: `share` 0 is the older, 1 the newer; never beyond either.

    Angles take the short way round. What is on or off (mode, lamps, pedals) is the newer's: it is never held back.
    """
    part = min(1.0, max(0.0, share))

    def mixed(one: float, other: float) -> float:
        return one + part * (other - one)

    def turned(one: float, other: float) -> float:
        return one + part * math.remainder(other - one, math.tau)

    return newer._replace(
        t_s=mixed(older.t_s, newer.t_s),
        x_m=mixed(older.x_m, newer.x_m),
        y_m=mixed(older.y_m, newer.y_m),
        z_m=mixed(older.z_m, newer.z_m),
        yaw_rad=turned(older.yaw_rad, newer.yaw_rad),
        pitch_rad=turned(older.pitch_rad, newer.pitch_rad),
        roll_rad=turned(older.roll_rad, newer.roll_rad),
        road_wheel_rad=mixed(older.road_wheel_rad, newer.road_wheel_rad),
        distance_m=mixed(older.distance_m, newer.distance_m),
    )


def moved(older: Snapshot, newer: Snapshot, age_s: float) -> ShownVehicle:
    """Return the vehicle one tick ago, which the two newest ticks enclose, when the newer is `age_s` old."""
    period_s = newer.t_s - older.t_s
    share = 1.0 if period_s <= 0.0 else age_s / period_s
    return between(shown_vehicle(older), shown_vehicle(newer), share)
