"""SLAM, navigation and a team of robots as programs: `python -m simconsole.drivers.robots.nodes.program` (shell)."""

import argparse
import json
import math
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from simconsole.bridge.protocol.backoff import DEAD_AFTER_S
from simconsole.drivers.robots.allocation.problem import Objective
from simconsole.drivers.robots.fleet.team import Team
from simconsole.drivers.robots.navigation.mission import Mission, Target
from simconsole.drivers.robots.navigation.navigator import Navigator
from simconsole.drivers.robots.navigation.robot_shape import shape_of
from simconsole.drivers.robots.nodes import navigation_node, slam_node
from simconsole.drivers.robots.nodes.fleet_program import Robot
from simconsole.drivers.robots.nodes.team_program import drive_team
from simconsole.processes.lifetimes import ATTACHED, follow_parent
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.world import ArenaProfile
from simconsole.values.errors import ProfileError, SimConsoleError
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from simconsole.world.tools.ros_maps import write_grid

TOLD_S = 0.5
"""How often a team tells how far it is, a line of JSON each."""


def parser() -> argparse.ArgumentParser:
    """Return the parser of all programs."""
    root = argparse.ArgumentParser(prog="python -m simconsole.drivers.robots.nodes.program", allow_abbrev=False)
    programs = root.add_subparsers(dest="program", required=True, metavar="PROGRAM")
    slam = programs.add_parser("slam", help="map, pose and map -> odom from /scan and /tf")
    slam.add_argument("--start", type=_pose, default=Pose(0.0, 0.0, 0.0), metavar="X,Y,DEG", help="the robot's, in map")
    slam.add_argument("--out", metavar="DIR", help="save the map there at the end, as map.yaml and map.pgm")
    navigate = programs.add_parser("navigate", help="/cmd_vel for goals by /goal_pose and /navigate_to_pose")
    navigate.add_argument("--robot", default="turtlebot3_burger", metavar="VEHICLE", help="its profile")
    navigate.add_argument("--arena", metavar="WORLD", help="explore it, then go to its targets; else wait for goals")
    navigate.add_argument("--lockstep", action="store_true", help="the console waits, and this program waits for SLAM")
    team = programs.add_parser("team", help="several robots: one map, tasks shared out and driven")
    team.add_argument(
        "--robot",
        action="append",
        required=True,
        type=_team_robot,
        metavar="NS=VEHICLE@X,Y,DEG",
        help="namespace, profile and start in map of one, /tb3_0=turtlebot3_burger@0.8,0.8,38.66; may be repeated",
    )
    team.add_argument("--arena", required=True, metavar="WORLD", help="whose targets are the tasks")
    team.add_argument("--objective", choices=[one.value for one in Objective], default=Objective.SUM.value)
    team.add_argument("--lockstep", action="store_true", help="the console waits for each command")
    team.add_argument("--out", default=".", metavar="DIR", help="where map and mission.json go")
    team.add_argument("--url", default="ws://127.0.0.1:9090", metavar="URL")
    team.add_argument("--wait", type=float, default=10.0, metavar="S", help="how long to wait for the server")
    team.add_argument(ATTACHED, action="store_true", help="end with whoever holds standard input")
    for program in (slam, navigate):
        program.add_argument("--url", default="ws://127.0.0.1:9090", metavar="URL")
        program.add_argument("--namespace", default="", metavar="NS", help="of the robot's topics and frames: /tb3_0")
        program.add_argument("--wait", type=float, default=10.0, metavar="S", help="how long to wait for the server")
    return root


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one of the programs; its last line is what it made, as JSON. Exit codes as those of the console."""
    options = parser().parse_args(arguments)
    try:
        found = {"slam": _slam, "navigate": _navigate, "team": _team}[options.program](options)
    except SimConsoleError as error:
        print(f"{options.program}: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        return 130
    print(json.dumps(found))
    return 0


def _slam(options: argparse.Namespace) -> dict[str, Any]:
    mapped = slam_node.run(options.url, options.start, namespace=options.namespace, patience_s=options.wait)
    found: dict[str, Any] = {"scans": len(mapped.moments), "ended": mapped.ended}
    if mapped.grid is not None and options.out is not None:
        found["map"] = str(write_grid(mapped.grid, Path(options.out), "map")[0])
    return found


def _navigate(options: argparse.Namespace) -> dict[str, Any]:
    profile = load_vehicle(options.robot)
    if not isinstance(profile, TurtlebotProfile):
        raise ProfileError(f"--robot: value {options.robot}: a robot, platform turtlebot")
    navigator = Navigator(shape_of(profile), compiled)
    mission = None if options.arena is None else Mission(navigator, targets_of(options.arena))
    told = navigation_node.run(
        options.url,
        navigator,
        mission,
        namespace=options.namespace,
        lockstep=options.lockstep,
        patience_s=options.wait,
        dead_after_s=math.inf if options.lockstep else DEAD_AFTER_S,  # a console that waits is silent
    )
    return {**told._asdict(), "visits": [visit._asdict() for visit in told.visits]}


def _team(options: argparse.Namespace) -> dict[str, Any]:
    if options.attached:
        follow_parent(None)
    last_s = -math.inf

    def told(team: Team) -> None:
        nonlocal last_s
        if time.monotonic() > last_s + TOLD_S:
            last_s = time.monotonic()
            print(json.dumps({"explored": team.explored_s, "done": team.tasks_done}), flush=True)

    log = drive_team(
        options.url,
        options.robot,
        targets_of(options.arena),
        Objective(options.objective),
        Path(options.out),
        options.lockstep,
        options.wait,
        told,
    )
    visits = [visit for robot in log.robots for visit in robot.visits]
    return {"ended": log.ended, "explored_s": log.explored_s, "reached": sum(visit.reached for visit in visits)}


def targets_of(name_or_path: str) -> list[Target]:
    """Return the targets of an arena.

    Raises:
        ProfileError: there is no such arena.
    """
    world = load_world(name_or_path)
    if not isinstance(world, ArenaProfile):
        raise ProfileError(f"--arena: value {name_or_path}: a world of kind arena")
    return [Target(spot.name, spot.x_m, spot.y_m, math.radians(spot.yaw_deg)) for spot in world.targets]


def _team_robot(text: str) -> tuple[str, str, Robot]:
    """Return name, vehicle and robot of `NS=VEHICLE@X,Y,DEG`."""
    namespace, _, rest = text.partition("=")
    vehicle, _, start = rest.rpartition("@")
    if not (namespace.startswith("/") and vehicle):
        raise argparse.ArgumentTypeError(f"{text}: NS=VEHICLE@X,Y,DEG, the namespace with its slash")
    return namespace.removeprefix("/"), vehicle, Robot(namespace, _pose(start))


def _pose(text: str) -> Pose:
    try:
        x_m, y_m, yaw_deg = map(float, text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text}: X,Y,DEG, three numbers") from None
    if not all(map(math.isfinite, (x_m, y_m, yaw_deg))):
        raise argparse.ArgumentTypeError(f"{text}: three finite numbers")
    return Pose(x_m, y_m, math.radians(yaw_deg))


if __name__ == "__main__":
    sys.exit(main())
