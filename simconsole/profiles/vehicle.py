"""Profiles of vehicles: values from a data sheet or set by hand, with bounds and units in the keys."""

from typing import Annotated, TypeAlias

import msgspec

from simconsole.profiles.parts.chassis import AxleProfile, BodyProfile, SteeringProfile
from simconsole.profiles.parts.drivetrain import AidsProfile, AutomaticProfile, EngineProfile, GearboxProfile
from simconsole.profiles.parts.ranges import Length, require
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.tyre import TirTyre
from simconsole.profiles.validation import RegisteredName
from simconsole.values.units import STANDARD_GRAVITY_MPS2


class CarProfile(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="platform", tag="car"
):
    """A car with a manual gearbox that can also work itself."""

    body: BodyProfile
    """Mass, inertia and shape of the car."""
    front: AxleProfile
    """The front axle with its tyres and brakes."""
    rear: AxleProfile
    """The rear axle with its tyres and brakes."""
    steering: SteeringProfile
    """Hand wheel to road wheels and back."""
    engine: EngineProfile
    """The combustion engine."""
    gearbox: GearboxProfile
    """Clutch, gears, final drive and differential."""
    automatic: AutomaticProfile
    """How the car works clutch and gears itself."""
    aids: AidsProfile
    """Driver aids and their switches."""
    tyre: TirTyre | None = None
    """A tyre from a PAC2002 file for all wheels; left out, the tyres that the axles describe."""

    def __post_init__(self) -> None:
        """Refuse an automatic that does not fit the engine, and wheels too light for their tyres at steps of 1 ms.

        Raises:
            ValueError: names the key.
        """
        auto, engine = self.automatic, self.engine
        for key, speed in (
            ("automatic.launch_from_rpm", auto.launch_from_rpm),
            ("automatic.lock_from_rpm", auto.lock_from_rpm),
        ):
            require(speed > engine.idle_rpm, f"{key} {speed} must be above engine.idle_rpm {engine.idle_rpm}")
        up = auto.up_full_rpm
        require(up < engine.limit_rpm, f"automatic.up_full_rpm {up} must be below engine.limit_rpm {engine.limit_rpm}")
        for name, axle in (("front", self.front), ("rear", self.rear)):
            given = {} if self.tyre is None else self.tyre.coefficients
            slip_stiffness = max(axle.slip_stiffness, given.get("PKX1", 0.0) * given.get("LKX", 1.0))
            stiffness = slip_stiffness / axle.relaxation_x_m * self.body.mass_kg * STANDARD_GRAVITY_MPS2
            lever = axle.wheel_radius_m**2
            # Semi-implicit steps of h are stable to h^2 k / m = 4 and h d / m = 2; an eighth and a quarter of that.
            least = lever * max(stiffness * 1e-6 / 0.5, axle.damping_nspm * 1e-3 / 0.5)
            wheel = axle.wheel_inertia_kgm2
            require(wheel >= least, f"{name}.wheel_inertia_kgm2 {wheel} must be {least:.3g} or more for these tyres")


class BallProfile(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="platform", tag="ball"
):
    """The ball of the roll-a-ball example."""

    radius_m: Annotated[float, msgspec.Meta(ge=0.02, le=5.0)]
    """Radius of the ball."""
    max_accel_mps2: Annotated[float, msgspec.Meta(ge=0.1, le=20.0)]
    """Strongest acceleration of the ball."""
    brake_mps2: Annotated[float, msgspec.Meta(ge=0.1, le=20.0)]
    """Braking at full pedal."""
    rolling_mps2: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)]
    """Deceleration when the ball rolls by itself."""
    approach_s: Annotated[float, msgspec.Meta(ge=0.02, le=5.0)]
    """Time constant of the last part of the way to a target."""
    turn_per_s: Annotated[float, msgspec.Meta(ge=0.0, le=20.0)]
    """How fast the heading turns per road-wheel angle."""
    steering_ratio: Annotated[float, msgspec.Meta(ge=1.0, le=30.0)]
    """Turning of the hand wheel per turning of the road wheels, where a person steers it."""
    max_road_wheel_deg: Annotated[float, msgspec.Meta(ge=5.0, le=60.0)]
    """Largest road-wheel angle to either side."""


class OwnProfile(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="platform", tag="own"
):
    """A vehicle that another package has registered (entry point `simconsole.vehicles`), or an FMU (`kind: fmu`)."""

    kind: RegisteredName
    """Name under which the other package has registered the vehicle, or `fmu`."""
    parameters: dict[str, float] = {}
    """Parameters of the vehicle that differ from its own values; each has bounds of its own."""
    file: Annotated[str, msgspec.Meta(max_length=4096)] | None = None
    """An FMU beside the profile; left out where the kind needs no file."""
    file_sha256: str = ""
    """SHA-256 of that file; filled in when it is read."""
    names: dict[str, str] = {}
    """Fields of `VehicleCommand` and `VehicleState`, and what the file calls them."""
    length_m: Length = 4.2
    """Length of the vehicle, for contact with others, for what is drawn, and for gaps."""
    width_m: Length = 1.8
    """Width of the vehicle, for contact with others and for what is drawn."""
    height_m: Length = 1.5
    """Height of the vehicle, for what is drawn."""
    wheelbase_m: Annotated[float, msgspec.Meta(ge=0.1, le=10.0)] = 2.6
    """Distance between the axles."""
    rear_overhang_m: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)] = 0.8
    """How far the vehicle reaches behind its rear axle."""
    steering_ratio: Annotated[float, msgspec.Meta(ge=1.0, le=30.0)] = 15.0
    """Turning of the hand wheel per turning of the road wheels."""
    max_road_wheel_deg: Annotated[float, msgspec.Meta(ge=5.0, le=60.0)] = 35.0
    """Largest road-wheel angle to either side."""


VehicleProfile: TypeAlias = CarProfile | BallProfile | TurtlebotProfile | OwnProfile
