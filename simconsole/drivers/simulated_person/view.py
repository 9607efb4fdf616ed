"""What the simulated person sees and feels in one tick. Pure."""

from typing import NamedTuple

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


def view_of(snapshot: Snapshot) -> View:
    """Return what a snapshot shows."""
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
    )
