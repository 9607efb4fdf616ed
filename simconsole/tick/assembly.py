"""From resolved profiles to a console that is ready to drive: pure, so that a replay builds exactly the same one."""

import math

from msgspec import Struct, structs

from simconsole.control.requests.control_settings import settings as control_settings
from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.force_feedback.force_settings import force_settings
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.session import Aids, Environment, SessionProfile, Start
from simconsole.profiles.vehicle import CarProfile, VehicleProfile
from simconsole.profiles.view import ENGLISH, LanguageProfile
from simconsole.profiles.world import WorldProfile
from simconsole.tick.advance import Console, ConsoleState, Execution, build_console, initial_state
from simconsole.values.platform import NO_OBSTACLES, Ground, Obstacles, Patch, Platform, Pose
from simconsole.values.signals import Commander
from simconsole.values.units import RAD_PER_DEG
from simconsole.vehicle.platforms import build
from simconsole.vehicle.rim_stiffness import rim_stiffness
from simconsole.world.arena.arena_world import arena_of
from simconsole.world.kinds.worlds import open_world
from simconsole.world.obstacles.sides import body_of
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.road_rules import RoadRules, road_rules


class ResolvedSession(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A session with every profile it names in full: what a bundle stores and a replay reads."""

    session: SessionProfile
    cockpit: CockpitProfile
    vehicle: VehicleProfile
    world: WorldProfile | None = None
    language: LanguageProfile = ENGLISH
    fleet: tuple[VehicleProfile, ...] = ()
    """The vehicles of `session.scenario.platforms`; of what one platform's bundle stores it is empty."""


def assemble(resolved: ResolvedSession, execution: Execution) -> tuple[Console, ConsoleState]:
    """Return the console and its state before the first tick."""
    session = resolved.session
    start = session.scenario.start or Start()
    environment, tick_hz = session.environment, session.mode.tick_hz
    platform = build(
        switched(resolved.vehicle, session.features.aids),
        Pose(start.x_m, start.y_m, start.yaw_deg * RAD_PER_DEG),
        ground_of(environment, resolved.world),
        obstacles_of(resolved.world),
        max(0, len(session.scenario.platforms) - 1),
    )
    console = build_console(
        cockpit_settings(resolved.cockpit, tick_hz),
        control_settings(
            session.features.control,
            platform.steering_ratio,
            platform.max_road_wheel_rad,
            platform.wheelbase_m,
            tick_hz,
            Commander.ECU if session.features.commander == "can" else Commander.ROS,
            platform.turns_in_place,
        ),
        platform,
        tick_hz,
        execution,
        force_settings(
            resolved.cockpit,
            platform.steering_ratio,
            platform.max_road_wheel_rad,
            tick_hz,
            rim_stiffness(resolved.vehicle),
        ),
        rules_of(resolved.world, platform, tick_hz),
    )
    return console, initial_state(console)


def rules_of(world: WorldProfile | None, platform: Platform, tick_hz: int) -> RoadRules | None:
    """Return the rules of a world for a vehicle, None where it has none.

    Raises:
        ProfileError: a file of its map cannot be read.
    """
    roads = None if world is None else roads_of(open_world(world))
    if roads is None:
        return None
    front_m = platform.length_m - platform.rear_overhang_m
    return road_rules(roads.road_map, roads.legs, tick_hz, front_m, body_of(platform))


def obstacles_of(world: WorldProfile | None) -> Obstacles:
    """Return what a robot may run into: the walls and pillars of an arena."""
    arena = None if world is None else arena_of(open_world(world))
    if arena is None:
        return NO_OBSTACLES
    segments, circles = (map(tuple, part.tolist()) for part in arena.outlines)
    return Obstacles(tuple(segments), tuple(circles))


def ground_of(environment: Environment, world: WorldProfile | None = None) -> Ground:
    """Return the ground and the wind of a session in a world.

    Raises:
        ProfileError: a file of its map cannot be read.
    """
    to_rad = environment.wind_to_deg * RAD_PER_DEG
    return Ground(
        friction=environment.friction,
        slope_x=environment.slope_x_percent / 100.0,
        slope_y=environment.slope_y_percent / 100.0,
        right_share=environment.friction_right_share,
        wind_x_mps=environment.wind_mps * math.cos(to_rad),
        wind_y_mps=environment.wind_mps * math.sin(to_rad),
        patches=tuple(Patch(*structs.astuple(patch)) for patch in environment.friction_patches),
        field=None if world is None else open_world(world).ground,
    )


def switched(vehicle: VehicleProfile, aids: Aids) -> VehicleProfile:
    """Return the vehicle with its driver aids switched as the session says; a ball has none."""
    if not isinstance(vehicle, CarProfile):
        return vehicle
    asked = {name: on for name, on in structs.asdict(aids).items() if on is not None}
    return structs.replace(vehicle, aids=structs.replace(vehicle.aids, **asked))
