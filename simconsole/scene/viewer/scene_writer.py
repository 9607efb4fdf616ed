"""State vectors into a view: the one place where shapes are made, of recorded and of running drives."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from simconsole.scene.entities import Array
from simconsole.scene.lamp_shapes import LampChanges
from simconsole.scene.lidar_shapes import LidarPoints
from simconsole.scene.plan_shapes import Plans
from simconsole.scene.plots import Follower
from simconsole.scene.road_user_shapes import road_user_shapes
from simconsole.scene.timeline import Memory, Ticks, piece
from simconsole.scene.viewer.job import Job
from simconsole.values.planned_path import PlannedPath
from simconsole.values.units import NS_PER_S
from simconsole.world.traffic.road_users import RoadUsersAt

if TYPE_CHECKING:
    from simconsole.scene.viewer.rerun_view import RerunView


class SceneWriter:
    """Remembers what the next block of a drive continues."""

    def __init__(self, job: Job, view: "RerunView") -> None:
        """Write into `view`, which shows the job's world already."""
        self._job, self._view = job, view
        self._memory, self._follower = Memory(), Follower(job.route)
        self._plans = Plans()
        self._lamps = LampChanges(job.drawing, job.tick_hz)
        self._lidar = None if job.scanner is None else LidarPoints(job.scanner, job.columns, job.tick_hz)

    def add(
        self,
        ticks: Ticks,
        vectors: Array,
        road_users: Sequence[RoadUsersAt] = (),
        plans: Sequence[PlannedPath] = (),
    ) -> None:
        """Write a block of a drive.

        Args:
            ticks: int64 [n], ascending, after those of the block before.
            vectors: float64 [n, columns].
            road_users: of the steps of traffic up to the block's last tick that no block before had.
            plans: of controllers, up to the block's last tick, that no block before had.
        """
        if not len(ticks):
            return
        job, view = self._job, self._view
        added, self._memory = piece(
            vectors,
            job.columns,
            ticks,
            job.tick_hz,
            job.profile.rate_hz,
            self._memory,
            vehicle=job.vehicle,
            follower=self._follower,
        )
        view.add(added)
        if (lamps := self._lamps.until(int(ticks[-1]), road_users)) is not None:
            view.add_lamps(lamps)
        if road_users:
            view.add_road_users(road_user_shapes(road_users, job.tick_hz))
        view.add_plans(self._plans.until(int(ticks[-1]) * NS_PER_S // job.tick_hz, plans))
        if self._lidar is not None and (turns := self._lidar.of(vectors, ticks)) is not None:
            view.add_lidar(turns)
