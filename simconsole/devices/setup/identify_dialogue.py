"""`simconsole devices identify`: what the motor of the wheel at hand is like, written into its profile."""

import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

import msgspec

from simconsole.devices.force_feedback.aligning import shares_by_speed
from simconsole.devices.force_feedback.force_settings import force_settings
from simconsole.devices.force_feedback.identification import Identified, identify
from simconsole.devices.force_feedback.servo_range import servo_refusal
from simconsole.devices.force_feedback.weighing import weighed
from simconsole.devices.setup.calibration_dialogue import write_profile
from simconsole.devices.setup.device_commands import Pace, Say, realtime
from simconsole.devices.setup.force_feedback_check import announce
from simconsole.devices.setup.wheel_bench import WheelBench
from simconsole.profiles.device import CockpitProfile, Provenance
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.errors import DeviceError
from simconsole.values.labels import borne_label
from simconsole.values.units import RAD_PER_DEG, STANDARD_GRAVITY_MPS2
from simconsole.vehicle.rim_stiffness import rim_stiffness

WEIGHT_KG: Final = (0.1, 3.0)
RADIUS_M: Final = (0.05, 0.3)
WEIGHING_SHARE: Final = 0.8
"""Most of the motor's torque that may hold the weight."""


class Weight(NamedTuple):
    """What is hung on the right side of the rim, level with the hub."""

    mass_kg: float
    radius_m: float

    @property
    def torque_nm(self) -> float:
        """Its torque about the hub."""
        return self.mass_kg * STANDARD_GRAVITY_MPS2 * self.radius_m


def identify_motor(
    cockpit: CockpitProfile,
    path: Path | None,
    *,
    say: Say,
    ask: Callable[[str], str] = input,
    strength: float = 0.4,
    weight: Weight | None = None,
    virtual: bool = False,
    tick_hz: int = 250,
    pace: Callable[[int], Pace] = realtime,
    pressed: Callable[[], bool] = lambda: False,
) -> dict[str, Any]:
    """Find delay, torque over inertia and friction over inertia of the wheel's motor; write them into a profile.

    Args:
        cockpit: With force feedback.
        path: The profile to write; it must not be there yet. None: write none.
        say: Prints a line.
        ask: Puts a question; the answer to each is Enter.
        strength: Most of the motor's torque that the strokes may use, 0.05 to 0.6.
        weight: Gives the scale of the torque; without one the profile's is believed.
        virtual: On a simulated wheel behind virtual devices.
        tick_hz: Rate of the loop.
        pace: Makes a pace for a rate.
        pressed: Whether a key was pressed since it was asked last: it ends everything at once.

    Returns:
        Plain values; `refusal` is why the controller may not turn this wheel, empty where it may.

    Raises:
        DeviceError: a device is missing, it has no force feedback, does not move as a wheel does, or the file is there.
        KeyboardInterrupt: a key was pressed.
    """
    force = cockpit.force_feedback
    if force is None:
        raise DeviceError(f"{cockpit.title}: force_feedback: value missing: a profile of a wheel with a motor")
    _check_arguments(path, strength, weight)
    with ExitStack() as stack:
        bench = WheelBench(cockpit, force, virtual, tick_hz, pace, pressed, say, stack)
        say(f"{cockpit.title}: at most {strength * force.max_torque_nm:.1f} N m. Any key lets go at once.")
        announce(bench, "identify", "Hands OFF, fingers away from the spokes, for half a minute.", ask, say)
        found = identify(bench.turn, force, strength, tick_hz, say)
        scale = 1.0
        if weight is not None:
            scale = _weigh(bench, force, found, weight, tick_hz, ask, say)
    now = identified_profile(cockpit, force, found, scale, weight)
    assert now.force_feedback is not None
    results = {
        **_results(found, scale, weight, now.force_feedback),
        "torque_of_a_hatchback": borne_by_wheel(now, tick_hz),
    }
    for name, value in results.items():
        say(f"{name}: {value}")
    if path is not None:
        write_profile(path, now)
        say(f"{path}: written. Drive with it: simconsole drive --cockpit {path}")
    return {"cockpit": cockpit.title, "profile": None if path is None else str(path), **results}


def _check_arguments(path: Path | None, strength: float, weight: Weight | None) -> None:
    if path is not None and path.exists():
        raise DeviceError(f"{path}: file: value exists: a file that does not")
    if not 0.05 <= strength <= 0.6:
        raise DeviceError(f"strength: value {strength:g}: 0.05 to 0.6")
    if weight is None:
        return
    for name, value, (low, high) in (("mass", weight.mass_kg, WEIGHT_KG), ("radius", weight.radius_m, RADIUS_M)):
        if not low <= value <= high:
            raise DeviceError(f"weight: {name}: value {value:g}: {low:g} to {high:g}")


def _weigh(
    bench: WheelBench,
    force: ForceFeedback,
    found: Identified,
    weight: Weight,
    tick_hz: int,
    ask: Callable[[str], str],
    say: Say,
) -> float:
    def take_off() -> None:
        say("Take the weight off now, gently: the wheel is held for eight seconds more.")
        bench.hung_nm = 0.0

    text = f"The motor holds the wheel straight: then hang {weight.mass_kg:g} kg gently on the rim's right side, within"
    announce(bench, "weigh", f"{text} six seconds, {100.0 * weight.radius_m:g} cm from the hub.", ask, say)
    bench.hung_nm = weight.torque_nm
    limit_nm = WEIGHING_SHARE * force.max_torque_nm
    return weighed(bench.turn, found, weight.torque_nm, limit_nm, tick_hz, take_off)


def identified_profile(
    cockpit: CockpitProfile, force: ForceFeedback, found: Identified, scale: float, weight: Weight | None
) -> CockpitProfile:
    """Return the profile with what was found, and where each figure comes from.

    Raises:
        DeviceError: a figure is beyond what a profile may hold, so none of them is to be believed.
    """
    inertia = scale / found.accel_per_nm
    how: Literal["ratios", "weight"] = "ratios" if weight is None else "weight"
    motor = msgspec.structs.replace(
        force.motor,
        inertia_kgm2=_within("inertia, kg m2", inertia, 0.005, 0.5),
        damping_nms=_within("damping, N m s", found.damping_per_s * inertia, 0.0, 2.0),
        friction_nm=_within("friction, N m", found.friction_radps2 * inertia, 0.0, 2.0),
        delay_s=_within("delay, s", found.delay_s, 0.0, 0.05),
        identified=how,
    )
    date = time.strftime("%Y-%m-%d")
    source = f"simconsole devices identify, {date}; "
    sources = {
        "force_feedback.level_pushes": Provenance(status="captured", source=source + "it turned the way it was asked"),
        "force_feedback.motor": Provenance(status="captured", source=source + f"scale by {_scale_words(weight)}"),
        "force_feedback.motor.level_steps": cockpit.provenance.get(
            "force_feedback.motor.level_steps", Provenance(status="unverified", source="not measured")
        ),
    }
    if weight is not None:
        sources["force_feedback.max_torque_nm"] = Provenance(status="captured", source=source + _scale_words(weight))
    kept = {key: value for key, value in cockpit.provenance.items() if not key.startswith("force_feedback.motor")}
    most_nm = round(_within("most torque, N m", force.max_torque_nm * scale, 0.5, 30.0), 4)
    return msgspec.structs.replace(
        cockpit,
        force_feedback=msgspec.structs.replace(force, motor=motor, max_torque_nm=most_nm),
        provenance={**kept, **sources},
    )


def _scale_words(weight: Weight | None) -> str:
    if weight is None:
        return "the profile's max_torque_nm, which nobody measured"
    return f"a weight of {weight.mass_kg:g} kg at {weight.radius_m:g} m"


def _within(what: str, value: float, low: float, high: float) -> float:
    if not low <= value <= high:
        raise DeviceError(f"wheel: {what}: value {value:.3g}: {low:g} to {high:g}; turn it freely and identify again")
    return round(value, 6)


def borne_by_wheel(cockpit: CockpitProfile, tick_hz: int) -> str:
    """Return how much of a usual car's torque the wheel bears without swinging, by speed."""
    car = load_vehicle("hatchback")
    assert isinstance(car, CarProfile)
    lock_rad = car.steering.max_road_wheel_deg * RAD_PER_DEG
    force = force_settings(cockpit, car.steering.ratio, lock_rad, tick_hz, rim_stiffness(car))
    return borne_label(shares_by_speed(force))


def _results(found: Identified, scale: float, weight: Weight | None, force: ForceFeedback) -> dict[str, Any]:
    return {
        "delay_ms": round(1000.0 * found.delay_s, 2),
        "torque_per_inertia_radps2_per_nm": round(found.accel_per_nm / scale, 3),
        "friction_per_inertia_radps2": round(found.friction_radps2, 3),
        "damping_per_inertia_per_s": round(found.damping_per_s, 3),
        "max_torque_nm": force.max_torque_nm,
        "scale": _scale_words(weight),
        "refusal": servo_refusal(force) or "",
    }
