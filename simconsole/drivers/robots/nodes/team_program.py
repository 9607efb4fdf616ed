"""A team's whole task as a program: it maps, shares the targets out, drives to them, and writes down what it did."""

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

import msgspec

from simconsole.drivers.robots.allocation.auction import auction
from simconsole.drivers.robots.allocation.exact import optimum
from simconsole.drivers.robots.allocation.genetic import genetic
from simconsole.drivers.robots.allocation.methods_table import MethodRow
from simconsole.drivers.robots.allocation.problem import Allocation, Objective, Problem
from simconsole.drivers.robots.fleet.team import Team
from simconsole.drivers.robots.navigation.mission import Target
from simconsole.drivers.robots.navigation.navigator import Navigator
from simconsole.drivers.robots.navigation.robot_shape import shape_of
from simconsole.drivers.robots.nodes.fleet_program import Robot, run
from simconsole.drivers.robots.nodes.slam_node import StampedPose
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import compiled
from simconsole.world.tools.ros_maps import write_grid

MISSION: Final = "mission.json"
MAP: Final = "map"
RUNS: Final = 10
"""Of each method, for its average computing time."""


class MissionVisit(msgspec.Struct, frozen=True, kw_only=True):
    """A target that a robot went to."""

    target: str
    reached: bool
    time_s: float
    recoveries: int


class RobotMission(msgspec.Struct, frozen=True, kw_only=True):
    """What one robot did."""

    name: str
    planned_m: float  # of what the last sharing left to it
    tour: tuple[str, ...]  # what it had gone to before that, and what was left to it
    visits: tuple[MissionVisit, ...]
    failed_s: float | None = None
    moments: tuple[tuple[int, float, float, float], ...]  # where SLAM had it: ns, x and y in m of map, yaw in rad


class Methods(msgspec.Struct, frozen=True, kw_only=True):
    """The methods side by side, by one objective."""

    objective: str
    optimum_m: float
    rows: tuple[MethodRow, ...]
    without_m: tuple[float, ...]  # the optimum where the robot of this number has failed; none for one alone


class MissionLog(msgspec.Struct, frozen=True, kw_only=True):
    """mission.json: what the program did."""

    ended: str  # why
    explored_s: float | None
    shared_s: float | None  # when the open targets were shared out last: again whenever a robot had failed
    objective: str
    targets: tuple[str, ...]
    sharing: tuple[str, ...]  # the robots of the first sharing, which `methods` are about
    robots: tuple[RobotMission, ...]
    methods: tuple[Methods, ...]


def drive_team(
    url: str,
    robots: Sequence[tuple[str, str, Robot]],
    targets: Sequence[Target],
    objective: Objective,
    folder: Path,
    lockstep: bool = True,
    patience_s: float = 10.0,
    told: Callable[[Team], None] = lambda team: None,
) -> MissionLog:
    """Drive the robots until all is done; write mission.json, map.yaml and map.pgm.

    Args:
        url: the rosbridge server.
        robots: name, vehicle profile and start of each.
        targets: the tasks.
        objective: what the allocation that is driven makes as small as possible.
        folder: where to write.
        lockstep: the console waits for each command.
        patience_s: how long to try to connect.
        told: called again and again, with the team.

    Raises:
        BridgeError: no server answers.
        ProfileError: a vehicle is no robot.
    """
    navigators = [Navigator(shape_of(_robot(vehicle)), compiled) for _, vehicle, _ in robots]
    team = Team(navigators, targets, objective)
    driven = run(url, [robot for _, _, robot in robots], team, lockstep=lockstep, patience_s=patience_s, told=told)
    folder.mkdir(parents=True, exist_ok=True)
    if driven.grid is not None:
        write_grid(driven.grid, folder, MAP)
    log = MissionLog(
        ended=driven.ended,
        explored_s=team.explored_s,
        shared_s=team.shares[-1].time_s if team.shares else None,
        objective=objective.value,
        targets=tuple(target.name for target in targets),
        sharing=tuple(robots[number][0] for shared in team.shares[:1] for number in shared.robots),
        robots=tuple(
            _mission(team, number, name, driven.moments[number]) for number, (name, _, _) in enumerate(robots)
        ),
        methods=tuple(methods(team.shares[0].problem, one) for one in Objective if team.shares),
    )
    (folder / MISSION).write_bytes(msgspec.json.encode(log))
    return log


def _mission(team: Team, number: int, name: str, moments: Sequence[StampedPose]) -> RobotMission:
    """Return what a robot did."""
    member, last = team.members[number], team.shares[-1:]
    visits = tuple(
        MissionVisit(target=visit.name, reached=visit.reached, time_s=visit.time_s, recoveries=visit.recoveries)
        for visit in member.visits
    )
    left = [team.targets[task].name for shared in last for task in shared.tour(number)]
    before = [visit.target for visit in visits if visit.target not in left]
    return RobotMission(
        name=name,
        planned_m=sum(shared.planned_m(number) for shared in last),
        tour=(*before, *left),
        visits=visits,
        failed_s=member.failed_s,
        moments=tuple((moment.time_ns, *moment.pose) for moment in moments),
    )


def _robot(name: str) -> TurtlebotProfile:
    vehicle = load_vehicle(name)
    if not isinstance(vehicle, TurtlebotProfile):
        raise ProfileError(f"--robot: value {name}: a robot, platform turtlebot")
    return vehicle


def methods(problem: Problem, objective: Objective) -> Methods:
    """Return what each method makes of a problem, and how long it takes by this machine's clock."""
    by_name: dict[str, Callable[[int], Allocation]] = {
        "exact, proven": lambda run: optimum(problem, objective),
        "auction": lambda run: auction(problem, objective),
        "genetic, annealed": lambda run: genetic(problem, objective, run),
    }
    best = optimum(problem, objective)
    rows = []
    for name, method in by_name.items():
        costs, times = [], []
        for number in range(RUNS):
            began_s = time.perf_counter()
            costs.append(method(number).cost)
            times.append(time.perf_counter() - began_s)
        rows.append(MethodRow(name, min(costs), best.cost, tuple(costs), tuple(times)))
    return Methods(
        objective=objective.value,
        optimum_m=best.cost,
        rows=tuple(rows),
        without_m=tuple(
            optimum(problem.without(robot), objective).cost for robot in range(problem.robots) if problem.robots > 1
        ),
    )
