"""What the simulated person sees and feels in one tick. Pure."""

from typing import NamedTuple

from simconsole.drivers.simulated_person.situation import NOTHING_AHEAD, Situation
from simconsole.values.state_vector import Snapshot


class View(NamedTuple):
    """What the person sees and feels in one tick."""

    time_s: float
    x_m: float
    y_m: float
    yaw_rad: float
    speed_mps: float
    distance_m: float
    engine_radps: float
    engine_running: float
    gear: float  # in the gearbox
    mode: float
    hand_wheel_rad: float = 0.0  # where the wheel is, which is not always where the hands want it
    situation: Situation = NOTHING_AHEAD


def view_of(snapshot: Snapshot, situation: Situation = NOTHING_AHEAD) -> View:
    """Return what a snapshot shows, with what is ahead on the way."""
    vehicle = snapshot.vehicle
    return View(
        time_s=snapshot.t_s,
        x_m=vehicle.x_m,
        y_m=vehicle.y_m,
        yaw_rad=vehicle.yaw_rad,
        speed_mps=vehicle.vx_mps,
        distance_m=vehicle.distance_m,
        engine_radps=vehicle.engine_radps,
        engine_running=vehicle.engine_running,
        gear=vehicle.gear,
        mode=snapshot.arbitration.mode,
        hand_wheel_rad=snapshot.driver.hand_wheel_rad,
        situation=situation,
    )
