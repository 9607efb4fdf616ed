"""How a stop that nobody steers should be: `python -m tests.faults.stops` measures it for a handful of settings.

The controller falls silent at three places and at every 40 m of the course, with nobody in the seat; the table is that
of docs/decisions/0009-stops-that-nobody-steers.md.
"""

import random
from copy import copy
from typing import Any, NamedTuple

import numpy as np

from simconsole.profiles.faults import Silent
from simconsole.tick.advance import SETTINGS
from simconsole.values.signals import Mode
from simconsole.values.state_vector import Snapshot
from tests.faults.course import CAR_M, HZ, LANE_M, PERIOD_TICKS, PLACES, Circuit, LoopTracker

SECONDS = 14.0
EVERY_M = 40.0
NOISE_RAD = 0.005


class Stop(NamedTuple):
    """Settings of control/, by their names."""

    blind_stop_decel_mps2: float
    blind_stop_jerk_mps3: float
    stop_road_wheel_decay_radps: float


STOPS = (
    Stop(2.5, 1.5, 0.05),
    Stop(2.5, 1.5, 0.01),
    Stop(3.5, 5.0, 0.05),
    Stop(3.5, 5.0, 0.02),
    Stop(3.5, 5.0, 0.01),
    Stop(3.5, 5.0, 0.007),
    Stop(3.5, 5.0, 0.0),
    Stop(4.0, 10.0, 0.01),
)


class NoisyTracker(LoopTracker):
    """A controller whose last word before its silence is never quite the right one."""

    def __init__(self, *arguments: Any, sigma_rad: float) -> None:
        super().__init__(*arguments)
        self._sigma_rad = sigma_rad
        self._random = random.Random(1)

    def publish(self, snapshot: Snapshot) -> None:
        super().publish(snapshot)
        if snapshot.tick % PERIOD_TICKS == 0:
            angle = self._command.road_wheel_rad + self._random.gauss(0.0, self._sigma_rad)
            self._command = self._command._replace(road_wheel_rad=angle)


def beside_m(track: Circuit, place_m: float, sigma_rad: float) -> float:
    """Return how far from the lane's centre the car gets at most, from the safe stop on."""
    state = track.state_at(place_m)
    silent = Silent(at_s=Snapshot(state.tick, HZ, state.vector).t_s + 1.0)
    controller = NoisyTracker(copy(track.tracker), {}, False, sigma_rad=sigma_rad)
    driven = track.drive(state, SECONDS, [silent], controller=controller)
    assert driven.at_rest
    stop = driven.tick_of(Mode.MINIMAL_RISK) - driven.first_tick
    _, lateral = driven.course.project_all(driven.column("vehicle.x_m"), driven.column("vehicle.y_m"), place_m)
    return float(np.abs(lateral[stop:]).max())


def main() -> None:
    """Print the table."""
    track = Circuit()
    before = track.console.settings.copy()
    along = np.arange(60.0, track.course.length_m - 150.0, EVERY_M)
    for stop in STOPS:
        for name, value in stop._asdict().items():
            track.console.settings[SETTINGS.control.at(name)] = value
        places = [beside_m(track, place, 0.0) for place in PLACES.values()]
        cells = [f"{value:.2f} m" for value in places]
        for sigma in (0.0, NOISE_RAD):
            beside = np.array([beside_m(track, float(place), sigma) for place in along])
            kept = np.mean(beside <= 0.5 * (LANE_M - CAR_M))
            cells.append(f"{100.0 * kept:.0f} %")
            if sigma == 0.0:
                cells += [f"{np.sqrt(np.mean(beside**2)):.2f} m", f"{np.quantile(beside, 0.9):.2f} m"]
        numbers = " | ".join(f"{value:g}" for value in stop)
        print(f"| {numbers} | {' | '.join(cells)} |", flush=True)
    track.console.settings[:] = before


if __name__ == "__main__":
    main()
