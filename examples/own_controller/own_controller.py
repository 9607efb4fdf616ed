"""An own controller as a plain function: it drives the urban course once, and records two signals of its own."""

import math

import simconsole

session = simconsole.load("bridge")
route, place_m, wheelbase_m = session.route, 0.0, 2.6
own = simconsole.OwnSignals("lateral_m", "wanted_mps")


def controller(seen: simconsole.Snapshot) -> simconsole.Command:
    """Pure pursuit, slower in bends."""
    global place_m
    car = seen.vehicle
    place_m, lateral_m, _ = route.project(car.x_m, car.y_m, place_m)
    goal = route.at(place_m + (ahead_m := 3.0 + 0.5 * car.vx_mps))
    bearing_rad = math.atan2(goal.y_m - car.y_m, goal.x_m - car.x_m) - car.yaw_rad
    bend_1pm = max(abs(route.curvature_at(place_m + d)) for d in (0.0, ahead_m, 2.0 * ahead_m))
    own.set(lateral_m=lateral_m, wanted_mps=(wanted_mps := min(10.0, math.sqrt(2.0 / (bend_1pm + 1e-6)))))
    return simconsole.hold_speed(wanted_mps, math.atan(2.0 * wheelbase_m * math.sin(bearing_rad) / ahead_m))


drive = session.run(controller, signals=own, until=lambda seen: place_m >= route.length_m, duration_s=600.0)
print(drive, drive.metrics["autonomous"], f"largest |lateral| {abs(drive.column('own.lateral_m')[200:]).max():.3f} m")
