"""An FMU as a platform: stepped once a tick, between compiled stages; its pose by its velocities unless it has one."""

import hashlib
from typing import Final, NamedTuple

import numpy as np

from simconsole.profiles.vehicle import OwnProfile
from simconsole.values.errors import ProfileError
from simconsole.values.ground import ground_row
from simconsole.values.kernels import Row
from simconsole.values.layout import Part, read, write
from simconsole.values.platform import Platform, Pose
from simconsole.values.signals import VehicleCommand, VehicleState
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.values.trigonometry import direction, wrap_angle
from simconsole.values.units import RAD_PER_DEG
from simconsole.vehicle.fmu.unit import Unit
from simconsole.vehicle.registered import OwnSettings, OwnVehicle

STEP_S: Final = 0.001
DEFAULTS: Final = {"coast_accel_mps2": 0.0, "full_throttle_accel_mps2": 3.0, "full_brake_accel_mps2": -8.0}
"""What pedals give in a unit that does not say so."""
POSE: Final = ("x_m", "y_m", "yaw_rad")


class FmuState(NamedTuple):
    """What the unit cannot be asked again: how far it is, and where that has brought it."""

    steps: float  # of 1 ms
    x_m: float
    y_m: float
    yaw_rad: float
    distance_m: float


_STATE: Final = Part(FmuState, PLATFORM_AT)


class FmuStep:
    """The step of one unit. It keeps what it was told: a tick that is made again is made from its beginning."""

    def __init__(self, profile: OwnProfile, start: dict[str, float], pose: Pose) -> None:
        self._inputs = [name for name in VehicleCommand._fields if name in profile.names]
        self._outputs = [name for name in VehicleState._fields if name in profile.names and name not in self._inputs]
        self._unit = Unit(
            profile.file or "",
            profile.file_sha256,
            [profile.names[name] for name in self._inputs],
            [profile.names[name] for name in self._outputs],
        )
        self._start, self._pose = start, pose
        self._told: list[tuple[int, tuple[float, ...]]] = []  # substeps and inputs of each tick
        self._steps = 0  # -1: it has failed and must begin anew
        self.initial = self._begin()
        self.digest = hashlib.sha256(profile.file_sha256.encode()).hexdigest()

    def __call__(self, previous: Row, vector: Row, parameters: Row, ground: Row, substeps: int) -> None:
        """Make one tick, as `Platform.step` does.

        Raises:
            VehicleError: the unit fails, or has no finite number for an output.
        """
        before, command = read(previous, _STATE), read(vector, LAYOUT.command)
        if int(before.steps) != self._steps:
            self._go_back(int(before.steps))
        inputs = tuple(float(getattr(command, name)) for name in self._inputs)
        found = self._advance(substeps, inputs)
        step_s = substeps * STEP_S
        after = self._moved(before, read(previous, LAYOUT.vehicle), found, step_s, float(substeps))
        write(vector, LAYOUT.vehicle, self._seen(found, after, command.road_wheel_rad))
        write(vector, _STATE, after)

    def seen(self, state: FmuState) -> VehicleState:
        """Return the vehicle at its beginning."""
        return self._seen(self.initial, state, 0.0)

    def _begin(self) -> dict[str, float]:
        self._told.clear()
        self._steps = -1
        found = self._unit.begin(self._start)
        self._steps = 0
        return dict(zip(self._outputs, found, strict=True))

    def _advance(self, substeps: int, inputs: tuple[float, ...]) -> dict[str, float]:
        at, self._steps = self._steps, -1
        found = self._unit.step(at * STEP_S, substeps * STEP_S, inputs)
        self._told.append((substeps, inputs))
        self._steps = at + substeps
        return dict(zip(self._outputs, found, strict=True))

    def _go_back(self, steps: int) -> None:
        """Begin anew and make again what the unit was told up to there."""
        told = list(self._told)
        self._begin()
        for substeps, inputs in told:
            if self._steps >= steps:
                break
            self._advance(substeps, inputs)
        if self._steps != steps:
            raise ProfileError(f"FMU: asked to go on from {steps} ms, which it has never been at")

    def _moved(
        self, before: FmuState, seen: VehicleState, found: dict[str, float], step_s: float, steps: float
    ) -> FmuState:
        """Return the state after a tick: the pose by the mean velocities of the tick, where the unit has none."""
        vx, vy, rate = (
            0.5 * (getattr(seen, name) + found.get(name, 0.0)) for name in ("vx_mps", "vy_mps", "yaw_rate_radps")
        )
        way = direction(before.yaw_rad + 0.5 * rate * step_s)
        x_m = before.x_m + step_s * (vx * way.cos - vy * way.sin)
        y_m = before.y_m + step_s * (vx * way.sin + vy * way.cos)
        return FmuState(
            steps=before.steps + steps,
            x_m=found.get("x_m", x_m),
            y_m=found.get("y_m", y_m),
            yaw_rad=wrap_angle(found.get("yaw_rad", before.yaw_rad + rate * step_s)),
            distance_m=before.distance_m + step_s * (vx * vx + vy * vy) ** 0.5,
        )

    def _seen(self, found: dict[str, float], state: FmuState, road_wheel_rad: float) -> VehicleState:
        values = {**dict.fromkeys(VehicleState._fields, 0.0), **DEFAULTS, "engine_running": 1.0, "gear": 1.0}
        values |= {"road_wheel_rad": road_wheel_rad, **found}
        own = {"x_m": state.x_m, "y_m": state.y_m, "yaw_rad": state.yaw_rad, "distance_m": state.distance_m}
        return VehicleState(**{**values, **own})


def build_fmu(settings: OwnSettings) -> Platform:
    """Return an FMU as a platform.

    Raises:
        ProfileError: it cannot be used, or the profile maps what no command and no state has.
    """
    profile, pose = settings.profile, settings.pose
    if profile.file is None:
        raise ProfileError("vehicle: file: value missing: an FMU beside the profile")
    known = {*VehicleCommand._fields, *VehicleState._fields}
    for name in profile.names:
        if name not in known:
            raise ProfileError(f"vehicle: names: {name}: a field of VehicleCommand or VehicleState")
    step = FmuStep(profile, dict(settings.parameters), pose)
    state = FmuState(0.0, pose.x_m, pose.y_m, wrap_angle(pose.yaw_rad), 0.0)
    return Platform(
        name="fmu",
        state=FmuState,
        initial_state=tuple(state),
        initial_vehicle=step.seen(state),
        parameters=np.zeros(1),
        ground=ground_row(settings.ground),
        step=step,
        steering_ratio=profile.steering_ratio,
        max_road_wheel_rad=profile.max_road_wheel_deg * RAD_PER_DEG,
        wheelbase_m=profile.wheelbase_m,
        length_m=profile.length_m,
        width_m=profile.width_m,
        height_m=profile.height_m,
        rear_overhang_m=profile.rear_overhang_m,
        compiled=False,
        exact=False,
    )


FMU: Final = OwnVehicle(parameters=None, build=build_fmu)
