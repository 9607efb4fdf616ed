"""A car in a steady bend whose hand wheel is let go of: the console, the car and a simulated wheel in steps of 1 ms."""

import math
from functools import cache
from typing import NamedTuple

import msgspec
import numpy as np

from simconsole.devices.calibration.cockpit_settings import CockpitSettings, cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample, wheel_raw
from simconsole.devices.force_feedback.motor import SimulatedWheelPort, WheelMotor
from simconsole.devices.force_feedback.simulated_wheel import HANDS_OFF, Arm, SimulatedWheel, step_wheel
from simconsole.drivers.manoeuvre_driver.run_up import RunUp
from simconsole.drivers.speed_holder import SpeedHolder
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.profiles.vehicle import CarProfile
from simconsole.session.resolution import load_scenario, resolve
from simconsole.tick.advance import Console, advance_vector
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.host.jit import compiled
from simconsole.values.signals import NO_COMMAND, NO_EVENTS
from simconsole.values.state_vector import Snapshot, TickInputs, input_vector
from simconsole.vehicle.rim_stiffness import rim_stiffness
from tests.paths import ROOT
from tests.samples import Sample

TICK_HZ = 250
FAST_MPS = 53.0
"""Above it the wheel is turned more slowly: the angle of a bend falls by the square of the speed, in a car that
oversteers by more."""
MOST_S = 150.0
"""How long a car may take to its speed and into its bend."""
HELD = Arm(400.0, 6.0, 0.0, 60.0, 0.0)
COCKPIT = "t500rs_th8rs"


class Draw(NamedTuple):
    """What a wheel really is, beside the shipped profile."""

    inertia: float = 1.0
    torque: float = 1.0
    friction_nm: float = 0.2
    delay_ms: int = 12


ENDS = [
    Draw(inertia, torque, friction_nm, delay_ms)
    for inertia in (0.5, 2.0)
    for torque in (0.5, 2.0)
    for friction_nm in (0.03, 0.3)
    for delay_ms in (5, 32)
]
"""The corners of the range that wheels of this class have."""
SOME_ENDS = ENDS[::5]
"""Four of them that have both values of each figure."""


def draws(rng: np.random.Generator, count: int) -> list[Draw]:
    """Return a Latin hypercube over that range."""
    shuffled = [(rng.permutation(count) + rng.random(count)) / count for _ in range(4)]
    return [
        Draw(2.0 ** (2.0 * a - 1.0), 2.0 ** (2.0 * b - 1.0), 0.03 + 0.27 * c, 5 + int(27.999 * d))
        for a, b, c, d in zip(*shuffled, strict=True)
    ]


def wheels(sample: Sample) -> list[Draw]:
    """Return the shipped wheel, and corners of that range: one that is drawn, or all of them with 60 between them."""
    rng = np.random.default_rng(sample.seed)
    return [
        Draw(),
        *(ENDS if sample.long else [SOME_ENDS[rng.integers(len(SOME_ENDS))]]),
        *draws(rng, sample.of(0, 60)),
    ]


def true_force(shipped: ForceFeedback, draw: Draw) -> ForceFeedback:
    """Return the wheel as it is."""
    motor = msgspec.structs.replace(
        shipped.motor,
        inertia_kgm2=shipped.motor.inertia_kgm2 * draw.inertia,
        friction_nm=draw.friction_nm,
        delay_s=draw.delay_ms / 1000.0,
    )
    return msgspec.structs.replace(shipped, motor=motor, max_torque_nm=shipped.max_torque_nm * draw.torque)


@cache
def session_of(vehicle: str) -> ResolvedSession:
    session = load_scenario(str(ROOT / "profiles/scenarios/handling/step_steer.yaml"))[0].session
    scenario = msgspec.structs.replace(session.scenario, vehicle=vehicle)
    mode = msgspec.structs.replace(session.mode, tick_hz=TICK_HZ)
    control = msgspec.structs.replace(session.features.control, manual_automatic=True)
    features = msgspec.structs.replace(session.features, control=control)
    return resolve(msgspec.structs.replace(session, scenario=scenario, mode=mode, features=features), COCKPIT)


def console_of(vehicle: str, force: ForceFeedback | None) -> tuple[Console, ResolvedSession, np.ndarray]:
    session = session_of(vehicle)
    cockpit = session.cockpit if force is None else msgspec.structs.replace(session.cockpit, force_feedback=force)
    session = msgspec.structs.replace(session, cockpit=cockpit)
    console, state = assemble(session, compiled)
    return console, session, state.vector


class Bend(NamedTuple):
    """A car in a steady bend."""

    vector: np.ndarray
    tick: int
    hand_rad: float
    throttle: float
    lateral_mps2: float
    speed_mps: float


def after(snapshot: Snapshot, intent: Intent, settings: CockpitSettings, console: Console) -> Snapshot:
    """Return the next tick, in which hands and feet do this."""
    sample = raw_sample(intent, settings)._replace(wheel_motor=1.0)
    inputs = input_vector(TickInputs(sample, NO_COMMAND, NO_EVENTS))
    return Snapshot(snapshot.tick + 1, TICK_HZ, advance_vector(snapshot.vector, inputs, console))


@cache
def at_speed(vehicle: str, speed_kmh: float) -> Snapshot:
    """Drive a car straight on up to a speed; the last tick of MOST_S where it does not reach it."""
    console, session, vector = console_of(vehicle, None)
    assert isinstance(session.vehicle, CarProfile)
    settings = cockpit_settings(session.cockpit, TICK_HZ)
    pilot = RunUp(speed_kmh, session.vehicle.steering.ratio, lambda snapshot, time_s: None, rolling=False)
    snapshot = Snapshot(0, TICK_HZ, vector)
    while snapshot.t_s < MOST_S:
        wanted = pilot(snapshot)
        if wanted is None:
            break
        snapshot = after(snapshot, wanted, settings, console)
    return snapshot


@cache
def bend(vehicle: str, speed_kmh: float, lateral_mps2: float) -> Bend | None:
    """Drive into a bend with the wheel held; None where the car does not reach the speed."""
    console, session, _ = console_of(vehicle, None)
    settings = cockpit_settings(session.cockpit, TICK_HZ)
    hand_rad, intent = 0.0, Intent()
    hold = SpeedHolder(speed_kmh / 3.6)
    snapshot = at_speed(vehicle, speed_kmh)
    began = snapshot.tick
    while snapshot.t_s < MOST_S:
        vehicle_now, time_s = snapshot.vehicle, (snapshot.tick - began) / TICK_HZ
        if time_s > 7.0:
            return Bend(
                snapshot.vector, snapshot.tick, hand_rad, intent.throttle, vehicle_now.ay_mps2, vehicle_now.vx_mps
            )
        if time_s < 5.0:
            vx_mps = vehicle_now.vx_mps
            slower = min(1.0, 25.0 / vx_mps, (FAST_MPS / vx_mps) ** 6)
            hand_rad += 0.15 * (lateral_mps2 - vehicle_now.ay_mps2) / TICK_HZ * slower
        intent = Intent(hand_wheel_rad=hand_rad, throttle=hold(snapshot), gear=1.0)
        snapshot = after(snapshot, intent, settings, console)
    return None


class Released(NamedTuple):
    """What a wheel did that was let go of."""

    rad: np.ndarray  # tick by tick
    torque_nm: np.ndarray
    share: float
    swings_deg: list[float]  # from extreme to extreme
    friction_band_deg: float  # up to which friction holds it


def let_go(vehicle: str, start: Bend, true: ForceFeedback, found: ForceFeedback, seconds: float = 6.0) -> Released:
    """Hold the wheel in the bend for a second, let go, and return its motion."""
    console, session, _ = console_of(vehicle, found)
    settings = cockpit_settings(session.cockpit, TICK_HZ)
    wheel = SimulatedWheel(true, session.cockpit.wheel.lock_to_lock_deg, tick_hz=TICK_HZ, step=compiled(step_wheel))
    wheel.state = wheel.state._replace(rad=start.hand_rad, hands_rad=start.hand_rad)
    motor = WheelMotor(SimulatedWheelPort(wheel), found, lambda shot: shot.t_s)
    rest = raw_sample(Intent(throttle=start.throttle, gear=1.0), settings)._replace(wheel_motor=1.0)
    snapshot = Snapshot(start.tick, TICK_HZ, start.vector)
    rads, torques = [], []
    for tick in range(round((1.0 + seconds) * TICK_HZ)):
        held = tick < TICK_HZ
        axis = wheel_raw(wheel.turn(HELD if held else HANDS_OFF, start.hand_rad if held else None), settings)
        sample = rest._replace(wheel_axis=round(axis * 32767.0) / 32768.0)
        row = advance_vector(snapshot.vector, input_vector(TickInputs(sample, NO_COMMAND, NO_EVENTS)), console)
        snapshot = Snapshot(snapshot.tick + 1, TICK_HZ, row)
        motor.publish(snapshot)
        if not held:
            rads.append(wheel.state.rad)
            torques.append(snapshot.torque.torque_nm)
    share = snapshot.torque.car_share
    dry_nm = found.motor.friction_nm + found.friction_nm
    assert isinstance(session.vehicle, CarProfile)
    rim = rim_stiffness(session.vehicle)
    pull = rim.at_12mps if rim.pulls else found.centring_spring_nm_per_rad
    band_deg = math.degrees(dry_nm / (pull * found.car_share * share))
    return Released(np.array(rads), np.array(torques), share, swings(np.degrees(rads)), band_deg)


def swings(angle_deg: np.ndarray, least_deg: float = 0.3) -> list[float]:
    """Return the ways from extreme to extreme, those below `least_deg` left out."""
    found, extreme, direction = [], angle_deg[0], 0.0
    last = angle_deg[0]
    for angle in angle_deg[1:]:
        if direction == 0.0:
            if abs(angle - extreme) > least_deg:
                direction = math.copysign(1.0, angle - extreme)
                last, extreme = extreme, angle
        elif (angle - extreme) * direction > 0.0:
            extreme = angle
        elif (extreme - angle) * direction > least_deg:
            found.append(abs(extreme - last))
            last, extreme, direction = extreme, angle, -direction
    if direction != 0.0:
        found.append(abs(extreme - last))
    return found
