"""The models of commonroad-vehicle-models 3.0.2 on ramp-and-hold steering, compiled from their own source by numba."""

import dataclasses
import hashlib
import math
import sys
import types
from collections.abc import Callable
from pathlib import Path as File
from typing import Any, NamedTuple

import numba
import numpy as np
import vehiclemodels
import vehiclemodels.utils.tire_model as tires
from numpy.typing import NDArray
from vehiclemodels.init_mb import init_mb
from vehiclemodels.init_st import init_st
from vehiclemodels.parameters_vehicle2 import parameters_vehicle2
from vehiclemodels.utils.acceleration_constraints import acceleration_constraints
from vehiclemodels.utils.steering_constraints import steering_constraints
from vehiclemodels.utils.vehicle_dynamics_ks_cog import vehicle_dynamics_ks_cog
from vehiclemodels.vehicle_dynamics_mb import vehicle_dynamics_mb
from vehiclemodels.vehicle_dynamics_st import vehicle_dynamics_st

from simconsole.values.host.jit import _cached, _Late

STEERING_RADPS = 0.4
"""Their limit of the steering rate."""
DURATION_S = 3.0
SAMPLE_S = 0.02


class Input(NamedTuple):
    """Steer from straight ahead to an angle at their rate limit or in 0.2 s, whichever is slower; then hold."""

    speed_mps: float
    angle_rad: float

    @property
    def rate_radps(self) -> float:
        return math.copysign(min(abs(self.angle_rad) / 0.2, STEERING_RADPS), self.angle_rad)

    @property
    def ramp_s(self) -> float:
        return self.angle_rad / self.rate_radps


class Path(NamedTuple):
    """Samples every SAMPLE_S: position of the centre of gravity, yaw rate, roll (positive left side up)."""

    x_m: NDArray[np.float64]
    y_m: NDArray[np.float64]
    yaw_rate_radps: NDArray[np.float64]
    roll_rad: NDArray[np.float64]


def _copy(function: Callable[..., Any], **names: Any) -> Any:
    """Return `function` compiled, with globals replaced: their files stay as they are."""
    code = function.__code__
    return numba.njit(types.FunctionType(code, {**function.__globals__, **names}, function.__name__))


def _constants(settings: Any, name: str) -> Any:
    """Return their nested settings as a NamedTuple of floats and NamedTuples, which numba can take."""
    wanted: dict[str, Any] = {}
    for key, value in vars(settings).items():
        if dataclasses.is_dataclass(value):
            if key != "trailer":
                wanted[key] = _constants(value, key)
        elif isinstance(value, int | float):
            wanted[key] = float(value)
    record: Any = NamedTuple(name, [(key, Any) for key in wanted])  # type: ignore[misc]  # keys are theirs
    return record(**wanted)


BMW = parameters_vehicle2()
CONSTANTS = _constants(BMW, "bmw")

_limits = {
    "steering_constraints": _copy(steering_constraints),
    "acceleration_constraints": _copy(acceleration_constraints),
}
_slow = {"vehicle_dynamics_ks_cog": _copy(vehicle_dynamics_ks_cog, **_limits), **_limits}
_tires = types.ModuleType("tires")
_sign = _copy(tires.sign)
for _name in ("longitudinal", "lateral", "longitudinal_comb", "lateral_comb"):
    setattr(_tires, f"formula_{_name}", _copy(getattr(tires, f"formula_{_name}"), sign=_sign))
multi_body = _copy(vehicle_dynamics_mb, tireModel=_tires, **_slow)
single_track = _copy(vehicle_dynamics_st, **_slow)


def _run(start: Any, rate: float, ramp_s: float, step_s: float, steps: int, every: int) -> Any:
    """Integrate `model` with `constants`, both of which `_runge_kutta` adds, by Runge-Kutta 4."""
    x = start.copy()
    out = np.empty((steps // every, x.size))
    for index in range(steps):
        left = ramp_s - index * step_s
        share = min(max(left / step_s, 0.0), 1.0)  # the step in which the ramp ends is steered for a part
        u = [rate * share, 0.0]
        k1 = np.array(model(x, u, constants))  # type: ignore[name-defined]  # noqa: F821
        k2 = np.array(model(x + 0.5 * step_s * k1, u, constants))  # type: ignore[name-defined]  # noqa: F821
        k3 = np.array(model(x + 0.5 * step_s * k2, u, constants))  # type: ignore[name-defined]  # noqa: F821
        k4 = np.array(model(x + step_s * k3, u, constants))  # type: ignore[name-defined]  # noqa: F821
        x = x + step_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        if (index + 1) % every == 0:
            out[(index + 1) // every - 1] = x
    return out


def _sources() -> str:
    """Return 16 hex digits that change with their code, their car, this file and Python."""
    theirs = File(str(vehiclemodels.__file__)).parent
    text = hashlib.sha256(f"{sys.version}{CONSTANTS}".encode())
    for file in (File(__file__), *sorted(theirs.rglob("*.py"))):
        text.update(file.read_bytes())
    return text.hexdigest()[:16]


def _runge_kutta(model: Any, name: str) -> Any:
    """Return the run of one model; its machine code is kept with that of our kernels, which takes seconds to make."""
    run = types.FunctionType(_run.__code__, {"__name__": __name__, "np": np}, _run.__name__)
    run.__module__ = __name__
    late = _Late(run, lambda: {"model": model, "constants": CONSTANTS})
    return _cached(late, f"{_sources()}-{name}", _nrt=True)


_multi_body_run = _runge_kutta(multi_body, "multi-body")
_single_track_run = _runge_kutta(single_track, "single-track")


def _drive(run: Any, start: list[float], given: Input, step_s: float) -> Any:
    steps = round(DURATION_S / step_s)
    first = np.array(start, dtype=np.float64)
    return run(first, given.rate_radps, given.ramp_s, step_s, steps, round(SAMPLE_S / step_s))


def drive_multi_body(given: Input, step_s: float = 0.002) -> Path:
    """Drive their multi-body model. Its roll is positive to the other side."""
    core = [0.0, 0.0, 0.0, given.speed_mps, 0.0, 0.0, 0.0]
    out = _drive(_multi_body_run, init_mb(core, BMW), given, step_s)
    return Path(out[:, 0], out[:, 1], out[:, 5], -out[:, 6])


def drive_single_track(given: Input, step_s: float = 0.002) -> Path:
    """Drive their single-track model, which does not roll."""
    core = [0.0, 0.0, 0.0, given.speed_mps, 0.0, 0.0, 0.0]
    out = _drive(_single_track_run, init_st(core), given, step_s)
    return Path(out[:, 0], out[:, 1], out[:, 5], 0.0 * out[:, 0])
