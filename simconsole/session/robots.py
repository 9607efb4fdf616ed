"""What a session with a robot has beside that of a car."""

from simconsole.bridge.console.published_tick import RobotTable
from simconsole.bridge.console.robots.robot_topics import robot_table
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.profiles.world import WorldProfile
from simconsole.values.host.jit import compiled
from simconsole.world.arena.arena_world import arena_of
from simconsole.world.kinds.worlds import open_world


def robot_at_work(vehicle: VehicleProfile | None, world: WorldProfile | None) -> RobotTable | None:
    """Return what makes a robot's topics, its rays cast by compiled code; None where no robot is driven."""
    arena = None if world is None else arena_of(open_world(world))
    return robot_table(vehicle, arena, compiled)
