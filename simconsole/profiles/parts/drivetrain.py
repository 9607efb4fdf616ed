"""Parts of a car: driver aids, engine, gearbox, the automatic."""

from itertools import pairwise
from typing import Annotated, Literal

from msgspec import Meta, Struct

from simconsole.profiles.parts.ranges import Ratio, Rpm, Seconds, Share, Torque, require


class AidsProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Driver aids and their switches."""

    anti_lock: bool
    """The car has anti-lock brakes, and they are on."""
    traction_control: bool
    """The car has traction control, and it is on."""
    stability_control: bool
    """The car has stability control, and it is on."""
    hill_hold: bool
    """The car has hill hold, which keeps the brakes on for a moment when a hill is driven off, and it is on."""
    characteristic_speed_kmh: Annotated[float, Meta(ge=20.0, le=500.0)] | None = None
    """Characteristic speed by which stability control expects a yaw rate; left out, by the car's own tyres and
    steering."""
    stability_lateral_mps2: Annotated[float, Meta(ge=1.0, le=15.0)]
    """Most lateral acceleration that stability control expects of the car on dry ground."""
    stability_nm_per_radps: Annotated[float, Meta(ge=0.0, le=100000.0)]
    """Brake torque of stability control per yaw rate beyond what it tolerates."""
    stability_nm: Torque
    """Most brake torque of stability control."""


class TorquePoint(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One point of the full-throttle curve."""

    at_rpm: Rpm
    """Engine speed of the point; above 0, and higher than that of the point before."""
    torque_nm: Annotated[float, Meta(ge=0.0, le=2000.0)]
    """Torque at the flywheel with full throttle at this speed."""


class EngineProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The engine. The curve rises from nothing at half its first speed and is level after its last point."""

    inertia_kgm2: Annotated[float, Meta(ge=0.01, le=5.0)]
    """Moment of inertia of engine and flywheel."""
    curve: Annotated[tuple[TorquePoint, ...], Meta(min_length=1, max_length=7)]
    """Full-throttle torque by engine speed, speeds ascending. It rises from nothing at half its first speed and is
    level after its last point."""
    drag_nm: Torque
    """Friction and pumping torque at standstill of the engine."""
    drag_nm_per_1000rpm: Annotated[float, Meta(ge=0.0, le=100.0)]
    """Friction and pumping torque that is added per 1000 revolutions a minute."""
    hold_nm: Torque
    """Friction that is added while nothing burns: compression."""
    idle_rpm: Annotated[float, Meta(ge=300.0, le=3000.0)]
    """Speed that the engine idles at; above `fire_rpm` and below half of `limit_rpm`."""
    idle_gain_nm_per_rpm: Annotated[float, Meta(ge=0.0, le=5.0)]
    """Torque that the idle governor adds per speed below `idle_rpm`."""
    idle_max_nm: Torque
    """Most torque of combustion that the idle governor gives."""
    stall_rpm: Annotated[float, Meta(ge=50.0, le=2000.0)]
    """Speed below which a running engine dies; below `fire_rpm`."""
    fire_rpm: Annotated[float, Meta(ge=60.0, le=2500.0)]
    """Speed from which a dead engine runs again; below `idle_rpm`."""
    starter_nm: Torque
    """Torque of the starter, which cranks a dead engine while the driveline is open."""
    limit_rpm: Annotated[float, Meta(ge=1000.0, le=20000.0)]
    """Speed at which the limiter cuts the engine off."""
    cylinders: Annotated[int, Meta(ge=1, le=16)] = 4
    """Number of cylinders of a four-stroke engine; only to be heard."""

    def __post_init__(self) -> None:
        """Refuse speeds out of order.

        Raises:
            ValueError: names the key.
        """
        speeds = [point.at_rpm for point in self.curve]
        require(speeds[0] > 0.0, "curve[0].at_rpm must be above 0")
        require(all(a < b for a, b in pairwise(speeds)), f"curve at_rpm {speeds} must rise from point to point")
        require(self.stall_rpm < self.fire_rpm, f"stall_rpm {self.stall_rpm} must be below fire_rpm {self.fire_rpm}")
        require(self.fire_rpm < self.idle_rpm, f"fire_rpm {self.fire_rpm} must be below idle_rpm {self.idle_rpm}")
        most = 0.5 * self.limit_rpm
        require(self.idle_rpm < most, f"idle_rpm {self.idle_rpm} must be below half of limit_rpm {self.limit_rpm}")


class GearboxProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Clutch, gears and final drive."""

    forward: Annotated[tuple[Ratio, ...], Meta(min_length=1, max_length=7)]
    """Ratios of gear 1, 2 and so on, falling from gear to gear."""
    reverse: Ratio
    """Ratio of the reverse gear, without a sign."""
    final: Ratio
    """Ratio of the final drive."""
    synchro_rpm: Annotated[float, Meta(ge=0.0, le=2000.0)]
    """A gear goes in without the clutch if the speeds differ by less than this; else it grates."""
    driven: Literal["front", "rear"]
    """The axle that is driven."""
    lock_nm: Torque
    """Torque that a limited-slip differential always keeps between its wheels; 0 with `lock_share` 0 is an open one."""
    lock_share: Share
    """Share of the driving torque that the differential keeps between its wheels."""
    clutch_nm: Torque
    """Most torque that the closed clutch transmits."""
    clutch_heat_kj: Annotated[float, Meta(ge=1.0, le=10000.0)] = 200.0
    """Heat that takes the clutch from cold to its limit."""
    clutch_cooling_s: Annotated[float, Meta(ge=1.0, le=10000.0)] = 90.0
    """Time constant with which the clutch cools."""
    efficiency: Annotated[float, Meta(ge=0.5, le=1.0)] = 0.92
    """Share of the torque that comes from the clutch to the wheels."""
    bite_closed: Share
    """Share of the clutch pedal below which the clutch transmits everything."""
    bite_open: Share
    """Share of the clutch pedal above which the clutch transmits nothing; at least `bite_closed` + 0.05."""

    def __post_init__(self) -> None:
        """Refuse gears out of order and a clutch without travel.

        Raises:
            ValueError: names the key.
        """
        require(all(a > b for a, b in pairwise(self.forward)), f"forward {self.forward} must fall from gear to gear")
        least = self.bite_closed + 0.05
        require(self.bite_open >= least, f"bite_open {self.bite_open} must be {least} or more: bite_closed + 0.05")


class AutomaticProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The automatic that works clutch and gears of the same car."""

    shift_s: Annotated[float, Meta(ge=0.05, le=2.0)]
    """How long the automatic takes to shift."""
    shift_pause_s: Annotated[float, Meta(ge=0.0, le=5.0)]
    """How long the automatic waits after a shift before it shifts again."""
    up_rpm: Rpm
    """Engine speed at which it shifts up without throttle; above `down_rpm`."""
    up_full_rpm: Rpm
    """Engine speed at which it shifts up at full throttle; above `down_full_rpm`, below `engine.limit_rpm`."""
    down_rpm: Rpm
    """Engine speed at which it shifts down without throttle."""
    down_full_rpm: Rpm
    """Engine speed at which it shifts down at full throttle."""
    creep_nm: Torque = 30.0
    """Torque of the clutch with released pedals, which lets the car creep."""
    launch_from_rpm: Rpm
    """Engine speed that the slipping clutch holds with hardly any throttle; above `engine.idle_rpm`."""
    launch_to_rpm: Rpm
    """Engine speed that the slipping clutch holds at full throttle."""
    lock_from_rpm: Rpm
    """Gearbox speed at which the clutch may begin to close; above `engine.idle_rpm`."""
    lock_to_rpm: Rpm
    """Gearbox speed at which the clutch may be closed fully."""
    clutch_opening_s: Seconds
    """How long the clutch takes to open fully."""
    clutch_closing_s: Seconds
    """How long the clutch takes to close fully."""

    def __post_init__(self) -> None:
        """Refuse thresholds out of order.

        Raises:
            ValueError: names the key.
        """
        for low, high in (
            ("down_rpm", "up_rpm"),
            ("down_full_rpm", "up_full_rpm"),
            ("launch_from_rpm", "launch_to_rpm"),
            ("lock_from_rpm", "lock_to_rpm"),
        ):
            below, above = getattr(self, low), getattr(self, high)
            require(below < above, f"{high} {above} must be above {low} {below}")
