"""What a scene needs before the first state vector: the world, the vehicle and the columns."""

from typing import NamedTuple

from msgspec import Struct

from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.view import SceneProfile
from simconsole.profiles.world import WorldProfile
from simconsole.scene.entities import Dimensions
from simconsole.scene.timeline import NO_VEHICLE, ShownVehicle
from simconsole.values.host.jit import compiled
from simconsole.world.arena.arena_world import arena_of
from simconsole.world.arena.laser_scan import LaserScanner
from simconsole.world.arena.raycast import ray_grid
from simconsole.world.drawing import Drawing
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import Route


class SceneSource(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What a session says of its scene, as it travels to the process that makes it."""

    columns: tuple[str, ...]
    """Of the state vectors to come."""
    tick_hz: int
    dimensions: Dimensions
    vehicle: ShownVehicle
    world: WorldProfile | None
    robot: TurtlebotProfile | None
    """With a lidar; None: the vehicle is none."""
    seed: int
    """Of the lidar's errors."""
    has_camera: bool
    """Whose pictures are shown."""
    profile: SceneProfile


class Job(NamedTuple):
    """A drive to show; its state vectors come block by block."""

    columns: tuple[str, ...]  # of the state vectors
    tick_hz: int
    dimensions: Dimensions
    drawing: Drawing | None
    profile: SceneProfile
    vehicle: ShownVehicle = NO_VEHICLE
    route: Route | None = None
    scanner: LaserScanner | None = None
    has_camera: bool = False


def job_of(source: SceneSource) -> Job:
    """Open the world and return the job."""
    world = None if source.world is None else open_world(source.world)
    arena, scanner = None if world is None else arena_of(world), None
    if source.robot is not None and arena is not None:
        scanner = LaserScanner(source.robot.lidar, ray_grid(arena.outlines), source.seed, compiled)
    return Job(
        columns=source.columns,
        tick_hz=source.tick_hz,
        dimensions=source.dimensions,
        drawing=None if world is None else world.drawing,
        profile=source.profile,
        vehicle=source.vehicle,
        route=None if world is None else world.route,
        scanner=scanner,
        has_camera=source.has_camera,
    )
