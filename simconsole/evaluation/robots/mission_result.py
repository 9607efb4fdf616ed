"""A team's mission against the truth that its bundles hold: errors of SLAM, ways planned and driven, collisions."""

import math
from pathlib import Path
from typing import Any, Final, NamedTuple

import msgspec
import numpy as np

from simconsole.drivers.robots.allocation.methods_table import methods_table
from simconsole.drivers.robots.nodes.team_program import MAP, MISSION, MissionLog, RobotMission
from simconsole.drivers.robots.slam.planar import composed, inverse
from simconsole.evaluation.metrics.map_errors import MapErrors, map_errors
from simconsole.evaluation.metrics.table import Array
from simconsole.evaluation.metrics.trajectory_errors import TrajectoryErrors, trajectory_errors
from simconsole.evaluation.robots.clearances import Clearance, clearances, track_of
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.values.errors import RecordingError
from simconsole.values.platform import Pose
from simconsole.values.units import NS_PER_S
from simconsole.world.arena.arena_world import ArenaWorld
from simconsole.world.arena.occupancy import Grid
from simconsole.world.tools.ros_maps import read_grid

_SECOND: Final = 5  # scans in a second


class RobotResult(NamedTuple):
    """What one robot did."""

    name: str
    planned_m: float
    driven_m: float  # since the open targets were shared out last
    whole_m: float  # from the start on
    collisions: int
    clear: Clearance  # the least of the whole drive
    slam: TrajectoryErrors
    odometry: TrajectoryErrors
    way_m: Array  # [N, 2], driven, ten times a second


class MissionResult(NamedTuple):
    """What all did."""

    log: MissionLog
    robots: tuple[RobotResult, ...]
    grid: Grid
    map: MapErrors

    @property
    def good(self) -> bool:
        """Whether all targets were reached without a collision."""
        visits = [visit for robot in self.log.robots for visit in robot.visits]
        return (
            all(visit.reached for visit in visits)
            and sorted(visit.target for visit in visits) == sorted(self.log.targets)
            and not any(robot.collisions for robot in self.robots)
        )

    def plain(self) -> dict[str, Any]:
        """Return the figures as plain values."""
        return {
            "good": self.good,
            "explored_s": self.log.explored_s,
            "shared_s": self.log.shared_s,
            "objective": self.log.objective,
            "map": self.map._asdict(),
            "robots": [
                {
                    "name": robot.name,
                    "tour": list(done.tour),
                    "planned_m": robot.planned_m,
                    "driven_m": robot.driven_m,
                    "whole_m": robot.whole_m,
                    "collisions": robot.collisions,
                    "failed_s": done.failed_s,
                    "least_to_wall_m": robot.clear.wall_m,
                    "least_to_robot_m": robot.clear.robot_m if math.isfinite(robot.clear.robot_m) else None,
                    "slam_rms_m": robot.slam.absolute_rms_m,
                    "slam_max_m": robot.slam.absolute_max_m,
                    "odometry_rms_m": robot.odometry.absolute_rms_m,
                }
                for robot, done in zip(self.robots, self.log.robots, strict=True)
            ],
            "planned_m": sum(robot.planned_m for robot in self.robots),
            "driven_m": sum(robot.driven_m for robot in self.robots),
            "allocation": [
                {"objective": one.objective, "optimum_m": one.optimum_m, "without_m": list(one.without_m)}
                for one in self.log.methods
            ],
        }

    def text(self) -> str:
        """Return the tables: allocation by all methods, what was driven, how well it was mapped."""
        parts = []
        for one in self.log.methods:
            what = "sum of all ways" if one.objective == "sum" else "longest way"
            parts.append(methods_table(f"Allocation by the {what}", one.rows))
            without = zip(self.log.sharing, one.without_m, strict=False)  # a robot alone has no optimum without it
            failed = ", ".join(f"without {name} {cost:.2f} m" for name, cost in without)
            parts.append(f"optimum where a robot has failed: {failed or '-'}")
        parts.append(self._driven())
        found = self.map
        parts.append(
            f"Map: precision {found.precision:.3f}, recall {found.recall:.3f} within one cell, "
            f"{100.0 * found.wall_m:.1f} cm from the walls on average"
        )
        return "\n\n".join(parts) + "\n"

    def _driven(self) -> str:
        failed = [robot for robot in self.log.robots if robot.failed_s is not None]
        when = ", ".join(f"{robot.name} failed at {robot.failed_s:.1f} s" for robot in failed)
        lines = [
            f"Driven, by the optimum of the {self.log.objective}",
            *([f"{when}; planned and driven since {self.log.shared_s or 0.0:.1f} s"] if failed else []),
            f"{'robot':<10}{'tasks':<12}{'planned':>10}{'driven':>10}{'SLAM, rms':>12}{'odometry':>12}"
            f"{'collisions':>12}{'to walls':>11}{'to robots':>11}",
        ]
        for robot, done in zip(self.robots, self.log.robots, strict=True):
            tasks = " ".join(done.tour) or "-"
            slam, raw = 100.0 * robot.slam.absolute_rms_m, 100.0 * robot.odometry.absolute_rms_m
            lines.append(
                f"{robot.name:<10}{tasks:<12}{robot.planned_m:>8.2f} m{robot.driven_m:>8.2f} m"
                f"{slam:>9.1f} cm{raw:>9.1f} cm{robot.collisions:>12}"
                f"{100.0 * robot.clear.wall_m:>8.1f} cm{100.0 * robot.clear.robot_m:>8.1f} cm"
            )
        return "\n".join(lines)


def mission_result(folder: Path, bundle: Path, arena: ArenaWorld) -> MissionResult:
    """Return what a team did.

    Args:
        folder: with mission.json and the map.
        bundle: of the drive; the other robots' lie below it.
        arena: that was driven in.

    Raises:
        RecordingError: the program has left no mission, or the bundle cannot be read.
    """
    try:
        log = msgspec.json.decode((folder / MISSION).read_bytes(), type=MissionLog)
        grid = read_grid(folder / f"{MAP}.yaml")
    except (OSError, msgspec.MsgspecError) as error:
        raise RecordingError(f"{folder / MISSION}: cannot be read: {error}") from None
    folders = [bundle, *(bundle / name for name in open_bundle(bundle).manifest.platforms)]
    driven = [_driven(own) for own in folders]
    clear = clearances([track_of(one.true, one.robot) for one in driven], arena.outlines)
    robots = tuple(_robot(*each, log.shared_s) for each in zip(log.robots, driven, clear, strict=True))
    return MissionResult(log, robots, grid, map_errors(grid, arena.outlines))


class _Driven(NamedTuple):
    """What a robot's bundle holds."""

    robot: TurtlebotProfile
    tick_hz: int
    true: Array  # [ticks, 3]: x and y in m of map, yaw in rad
    told: Array  # likewise by odometry, in odom
    way_m: Array  # [ticks]: driven since the start
    collisions: int


def _driven(folder: Path) -> _Driven:
    bundle = open_bundle(folder)
    robot, table = recorded_session(bundle).vehicle, bundle.log.table()
    if not isinstance(robot, TurtlebotProfile):
        raise RecordingError(f"{folder}: a drive of a robot, platform turtlebot")
    pose = ("x_m", "y_m", "yaw_rad")
    return _Driven(
        robot=robot,
        tick_hz=bundle.log.header.tick_hz,
        true=np.column_stack([table.column(f"vehicle.{name}") for name in pose]),
        told=np.column_stack([table.column(f"platform.odometry.{name}") for name in pose]),
        way_m=table.column("vehicle.distance_m"),
        collisions=int(table.column("platform.motion.collisions")[-1]),
    )


def _robot(done: RobotMission, driven: _Driven, clear: Clearance, shared_s: float | None) -> RobotResult:
    tick_hz, true, told, way = driven.tick_hz, driven.true, driven.told, driven.way_m
    rows = np.array([min(round(moment[0] * tick_hz / NS_PER_S), len(true)) - 1 for moment in done.moments])
    found = np.array([moment[1:] for moment in done.moments])
    start = Pose(*found[0].tolist())
    begun = composed(start, inverse(Pose(*told[rows[0]].tolist())))
    raw = np.array([composed(begun, Pose(*pose)) for pose in told[rows].tolist()])
    first = 0 if shared_s is None else min(round(shared_s * tick_hz), len(way)) - 1
    return RobotResult(
        name=done.name,
        planned_m=done.planned_m,
        driven_m=float(way[-1] - way[first]),
        whole_m=float(way[-1]),
        collisions=driven.collisions,
        clear=clear,
        slam=trajectory_errors(found, true[rows], _SECOND),
        odometry=trajectory_errors(raw, true[rows], _SECOND),
        way_m=true[:: max(1, tick_hz // 10), :2],
    )
