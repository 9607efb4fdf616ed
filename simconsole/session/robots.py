"""What a session with a robot has beside that of a car."""

from simconsole.bridge.console.robots.robot_topics import RobotOutputs, robot_outputs
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.profiles.world import WorldProfile
from simconsole.values.host.jit import compiled
from simconsole.world.arena.arena_world import arena_of
from simconsole.world.kinds.worlds import open_world


def robot_at_work(
    vehicle: VehicleProfile | None, world: WorldProfile | None, bridge: BridgeProfile
) -> RobotOutputs | None:
    """Return what a robot's topics are made from, its rays cast by compiled code; None where no robot is driven."""
    arena = None if world is None else arena_of(open_world(world))
    return robot_outputs(vehicle, arena, bridge.link.seed, compiled)
