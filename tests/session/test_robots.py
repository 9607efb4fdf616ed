import numpy as np

from simconsole.bridge.messages import standard_registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.session.resolution import load_session, resolve
from simconsole.session.robots import robot_at_work
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import plain
from simconsole.vehicle.turtlebot.robot_state import OBSTACLES_AT, RobotParameters


def test_a_robot_in_an_arena_has_a_lidar_and_walls_to_run_into() -> None:
    resolved = resolve(load_session("turtlebot3_waffle"))
    robot = robot_at_work(resolved.vehicle, resolved.world)
    assert robot is not None
    assert "/scan" in [topic.name for topic in robot(standard_registry(), BridgeProfile())]
    console, state = assemble(resolved, plain)
    parameters = RobotParameters(*console.platform.parameters[:OBSTACLES_AT].tolist())
    assert (parameters.segments, parameters.circles) == (22.0, 3.0)
    assert np.isfinite(state.vector).all()
    assert console.platform.initial_vehicle[:2] == (0.8, 0.8), "at the arena's first start"


def test_a_car_is_no_robot() -> None:
    resolved = resolve(load_session("roll_a_ball"))
    assert robot_at_work(resolved.vehicle, resolved.world) is None
