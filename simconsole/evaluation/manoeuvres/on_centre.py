"""Torque at the rim: on-centre handling by a weave (ISO 13674-1), and the effort of turning the wheel on the spot."""

import math
from collections.abc import Generator

import numpy as np

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.manoeuvre_driver.run_up import SETTLE_S, RunUp
from simconsole.drivers.speed_holder import SpeedHolder
from simconsole.evaluation.manoeuvres.attempt import Attempt, Driving, Line, Panel, Result, part, traces, undriven
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.profiles.manoeuvre import ParkingEffort, Weave
from simconsole.values.platform import Platform
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import DEG_PER_RAD, MPS_PER_KMH, RAD_PER_DEG, STANDARD_GRAVITY_MPS2

TRIAL_DEG = 8.0
"""Amplitude of the trial weave that tells how far the hand wheel must go."""
SETTLED_CYCLES = 2
ON_CENTRE_MPS2 = 0.5
"""The gradients are slopes within this much lateral acceleration about the place that they are of."""
TENTH_G_MPS2 = 0.1 * STANDARD_GRAVITY_MPS2


def weave(spec: Weave, car: Platform) -> Driving:
    """Weave once to see how far the hand wheel must go for the lateral acceleration, then weave that far."""
    trial = yield from _weave(spec, car, TRIAL_DEG)
    if trial is None:
        return undriven("weave", spec.speed_kmh)
    gain = _amplitude(trial.column("vehicle.ay_mps2")) / TRIAL_DEG
    driven = yield from _weave(spec, car, spec.lateral_mps2 / gain)
    if driven is None:
        return undriven("weave", spec.speed_kmh)
    lateral = driven.column("vehicle.ay_mps2")
    hand = driven.column("driver.hand_wheel_rad") * DEG_PER_RAD
    torque = -driven.column("vehicle.hand_wheel_torque_nm")  # of the hands
    centre = _branches(lateral, torque, 0.0)
    tenth = _outwards(lateral, torque, TENTH_G_MPS2)
    angle = _branches(lateral, hand, 0.0)
    middle = _branches(torque, lateral, 0.0)
    values = {
        "lateral_acceleration_amplitude_mps2": _amplitude(lateral),
        "steering_torque_gradient_at_0_g_nm_per_g": centre.slope * STANDARD_GRAVITY_MPS2,
        "steering_torque_at_0_g_nm": centre.half_height,
        "steering_torque_at_01_g_nm": tenth.value,
        "steering_torque_gradient_at_01_g_nm_per_g": tenth.slope * STANDARD_GRAVITY_MPS2,
        "lateral_acceleration_at_0_nm_g": middle.half_height / STANDARD_GRAVITY_MPS2,
        "steering_sensitivity_g_per_100_deg": 100.0 / (angle.slope * STANDARD_GRAVITY_MPS2),
        "steering_angle_hysteresis_deg": 2.0 * angle.half_height,
    }
    panels = (
        Panel("Torque of the hands", "lateral acceleration / m/s²", "torque / N m", (Line("", lateral, torque),)),
        Panel("Hand-wheel angle", "lateral acceleration / m/s²", "angle / deg", (Line("", lateral, hand),)),
    )
    return Result(values, panels)


class _Crossing:
    """A loop's two branches where x passes a place: mean slope and value, and half of the height between them."""

    def __init__(self, slope: float, value: float, half_height: float) -> None:
        self.slope = slope
        self.value = value
        self.half_height = half_height


def _line(x: Array, y: Array, place: float, rising: bool) -> tuple[float, float]:
    """Return slope and value at a place of one branch of a loop: that on which x rises, or falls."""
    moving = np.gradient(x) > 0.0
    near = (np.abs(x - place) < ON_CENTRE_MPS2) & (moving == rising)
    slope, value = np.polyfit(x[near] - place, y[near], 1)
    return float(slope), float(value)


def _branches(x: Array, y: Array, place: float) -> _Crossing:
    up, down = _line(x, y, place, True), _line(x, y, place, False)
    return _Crossing(0.5 * (up[0] + down[0]), 0.5 * (up[1] + down[1]), 0.5 * abs(up[1] - down[1]))


def _outwards(x: Array, y: Array, place: float) -> _Crossing:
    """Return the same where x leaves the centre, to either side."""
    left, right = _line(x, y, place, True), _line(x, y, -place, False)
    return _Crossing(0.5 * (left[0] + right[0]), 0.5 * (left[1] - right[1]), 0.0)


def _amplitude(values: Array) -> float:
    return 0.5 * float(np.ptp(values))


def _weave(spec: Weave, car: Platform, hand_deg: float) -> Generator[Attempt, Drive, Drive | None]:
    """Return the settled cycles of one weave; None: the car does not reach the speed."""
    hold = SpeedHolder(spec.speed_kmh * MPS_PER_KMH)

    def turn(snapshot: Snapshot, time_s: float) -> Intent | None:
        if time_s * spec.frequency_hz >= SETTLED_CYCLES + spec.cycles:
            return None
        hand = hand_deg * RAD_PER_DEG * math.sin(math.tau * spec.frequency_hz * time_s)
        return Intent(hand_wheel_rad=hand, throttle=hold(snapshot), gear=1.0)

    pilot = RunUp(spec.speed_kmh, car.steering_ratio, turn, rolling=False)
    driven = yield Attempt(f"weave, {hand_deg:.0f} deg", pilot, 120.0)
    if pilot.began_tick is None:
        return None
    settled = round(SETTLED_CYCLES / spec.frequency_hz * driven.tick_hz)
    return part(driven, pilot.began_tick - driven.first_tick + settled)


def parking_effort(spec: ParkingEffort, car: Platform) -> Driving:
    """Turn the hand wheel slowly to both sides on the spot, with the brake on."""
    quarter_s = spec.hand_wheel_deg / spec.hand_wheel_degps

    def turn(snapshot: Snapshot) -> Intent | None:
        quarters = (snapshot.t_s - 2.0 * SETTLE_S) / quarter_s
        if snapshot.t_s < SETTLE_S:
            return Intent()
        if quarters > 8.0:
            return None
        wave = abs((max(quarters, 0.0) + 3.0) % 4.0 - 2.0) - 1.0  # a triangle: 0, 1, 0, -1, 0 after each quarter
        return Intent(hand_wheel_rad=-spec.hand_wheel_deg * RAD_PER_DEG * wave, brake=0.3)

    driven = yield Attempt("on the spot", turn, 2.0 * SETTLE_S + 8.5 * quarter_s)
    torque = -driven.column("vehicle.hand_wheel_torque_nm")
    hand = driven.column("driver.hand_wheel_rad") * DEG_PER_RAD
    values = {
        "parking_torque_nm": float(np.abs(torque).max()),
        "parking_torque_at_centre_nm": float(np.abs(torque[hand > 0.0][-1])),
    }
    loop = Panel("Torque of the hands", "angle / deg", "torque / N m", (Line("", hand[::5], torque[::5]),))
    return Result(values, (loop, traces("Torque of the hands", "torque / N m", {"": (driven, torque)})))
