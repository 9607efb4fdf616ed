"""The scene in rerun: the only place that calls it, and only ever in a process of its own.

rerun's log() may block for good when a viewer freezes, so nothing here may run beside the tick loop, and nothing here
speaks to a viewer: both kinds of scenes are files.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from simconsole.scene.entities import MODE_COLOURS, PAINT, WorldShapes, on_map, raised
from simconsole.scene.lamp_shapes import LampShapes
from simconsole.scene.lanes import LINK_COLOURS, LINK_LANE, Lane, lanes_of
from simconsole.scene.latency_table import latency_table
from simconsole.scene.lidar_shapes import ECHO, LidarShapes
from simconsole.scene.plan_shapes import PlanShapes
from simconsole.scene.plots import APPLIED, AUTOPILOT, plots_of
from simconsole.scene.predicted_way import Ways
from simconsole.scene.road_user_shapes import RoadUserShapes
from simconsole.scene.timeline import Entry, Piece, Strip, Ticks
from simconsole.scene.viewer.blueprint import CAMERA, LATENCY, LOG, TIMELINE, blueprint
from simconsole.scene.viewer.job import Job
from simconsole.scene.viewer.live_file import LiveFile
from simconsole.scene.viewer.standing import MAP, show_vehicle, show_world
from simconsole.scene.wheel_shapes import CORNERS, FORCE, M_PER_N, TYRE, WIDTH_M, WheelShapes
from simconsole.values.errors import WorkerError
from simconsole.values.units import NS_PER_S

APPLICATION: Final = "simconsole"
PLAN: Final = "world/path/plan"
MAP_PLAN: Final = f"{MAP}/path/plan"
DRIVEN_PX: Final = 2.0
WAY_PX: Final = 1.5
"""As a radius, a negative number means pixels of the screen."""


class RerunView:
    """One recording being written."""

    def __init__(self, path: Path, job: Job, world: WorldShapes | None, live: bool = False) -> None:
        """Open the file and write what stands still.

        Args:
            path: the file to write.
            job: vehicle, rates and waits.
            world: what stands around it, if anything.
            live: append to the file in whole batches, each of which `settle` ends: viewers read it meanwhile.
                Otherwise the file is new and ends with an index of all that was written.

        Raises:
            WorkerError: the file cannot be written.
        """
        import rerun as rr

        self._job, self._flush_s = job, job.profile.flush_s
        self._has_road_users = False
        self._stream = rr.RecordingStream(
            APPLICATION, recording_id=f"{path.parent.name} {path.stem}", send_properties=True
        )
        rr.set_strict_mode(True)
        layout = blueprint(job, None if world is None else world.path, is_live=live)
        if live:
            self._file: LiveFile | None = LiveFile(path)
            self._batches = rr.binary_stream(recording=self._stream)
            self._stream.send_blueprint(layout, make_active=not self._file.length)
        else:
            self._file = None
            try:
                self._stream.save(path, default_blueprint=layout)
            except (OSError, RuntimeError) as problem:
                raise WorkerError(f"{path}: the scene cannot be written: {problem}") from None
        self._show_still(world)
        # After this even a killed process leaves a file with the world in it.
        self.settle()

    def add(self, piece: Piece) -> None:
        """Write what a piece of the drive adds, one call per entity."""
        if len(piece.ticks):
            self._poses(piece)
            for path, values in piece.plots.items():
                self._plot(path, piece.times_ns, values)
            if piece.wheels is not None:
                self._wheels(piece.times_ns, piece.wheels)
        for lane in piece.lanes:
            self.add_lane(lane)
        self._driven(piece.strips)
        self._ways(piece.ways)
        self.add_entries(piece.entries)

    def add_road_users(self, shapes: RoadUserShapes) -> None:
        """Write steps of traffic, boxes in 3D and their middles on the map."""
        import rerun as rr

        if not self._has_road_users:
            self._has_road_users = True
            self._still(f"{MAP}/road_users", rr.Points2D.from_fields(draw_order=2.5))
            self._still("world/road_users", rr.Boxes3D.from_fields(fill_mode="solid"))
        boxes = rr.Boxes3D.columns(
            centers=shapes.centres,
            half_sizes=shapes.half_sizes,
            quaternions=shapes.quaternions,
            colors=shapes.colours,
        )
        self._send("world/road_users", shapes.times_ns, boxes.partition(shapes.counts))
        spots = rr.Points2D.columns(
            positions=on_map(shapes.centres), colors=shapes.colours, radii=[-4.0] * len(shapes.centres)
        )
        self._send(f"{MAP}/road_users", shapes.times_ns, spots.partition(shapes.counts))

    def add_lamps(self, shapes: LampShapes) -> None:
        """Write which lamps of traffic lights shine after some changes."""
        import rerun as rr

        count = len(shapes.centres)
        lamps = rr.Points3D.columns(positions=shapes.centres, colors=shapes.colours, radii=[0.14] * count)
        self._send("world/lights/lit", shapes.times_ns, lamps.partition(shapes.counts))
        spots = rr.Points2D.columns(positions=on_map(shapes.centres), colors=shapes.colours, radii=[-4.5] * count)
        self._send(f"{MAP}/lit", shapes.times_ns, spots.partition(shapes.counts))

    def add_lidar(self, shapes: LidarShapes) -> None:
        """Write turns of the lidar."""
        import rerun as rr

        echoes = rr.Points3D.columns(positions=shapes.points).partition(shapes.counts)
        self._send("world/lidar", shapes.times_ns, echoes)
        spots = rr.Points2D.columns(positions=on_map(shapes.points)).partition(shapes.counts)
        self._send(f"{MAP}/lidar", shapes.times_ns, spots)

    def add_plans(self, shapes: PlanShapes) -> None:
        """Write plans, each a line through its places: the further apart these are, the faster it means to be."""
        import rerun as rr

        if not shapes.times_ns:
            return
        lines = [points for points in shapes.points if len(points)]
        has_line = [int(len(points) > 0) for points in shapes.points]
        flat = [on_map(line) for line in lines]
        self._send(PLAN, shapes.times_ns, rr.LineStrips3D.columns(strips=lines).partition(has_line))
        self._send(MAP_PLAN, shapes.times_ns, rr.LineStrips2D.columns(strips=flat).partition(has_line))
        counts = [len(points) for points in shapes.points]
        places = rr.Points3D.columns(positions=np.concatenate(shapes.points)).partition(counts)
        self._send(f"{PLAN}/places", shapes.times_ns, places)

    def add_picture(self, tick: int, jpeg: bytes) -> None:
        """Write a picture of the camera."""
        import rerun as rr

        picture = rr.EncodedImage.columns(blob=[jpeg], media_type=["image/jpeg"])
        self._send(CAMERA, [tick * NS_PER_S // self._job.tick_hz], picture)

    def add_latencies(self, t_ns: int, hops: Mapping[str, Any]) -> None:
        """Write latency statistics as they are at a time."""
        import rerun as rr

        table = rr.TextDocument.columns(text=[latency_table(hops)], media_type=["text/markdown"])
        self._send(LATENCY, [t_ns], table)

    def add_lane(self, lane: Lane) -> None:
        """Write the changes of a lane."""
        import rerun as rr

        if lane.times_ns:
            self._send(lane.path, lane.times_ns, rr.StateChange.columns(state=lane.states))

    def add_entries(self, entries: Sequence[Entry]) -> None:
        """Write lines of the log."""
        import rerun as rr

        if entries:
            lines = rr.TextLog.columns(text=[entry.text for entry in entries], level=[entry.level for entry in entries])
            self._send(LOG, [entry.t_ns for entry in entries], lines)

    def settle(self) -> None:
        """Wait until all added is in the file: what rerun has queued for a slow disk would grow in memory.

        Raises:
            WorkerError: the disk did not take it, or not within the profile's wait; the file holds what came before.
        """
        try:
            self._stream.flush(timeout_sec=self._flush_s)
        except (RuntimeError, TimeoutError, ValueError) as problem:
            raise WorkerError(f"the scene was not written whole within {self._flush_s:g} s: {problem}") from None
        if self._file is not None:
            self._file.append(self._batches.read(flush=False) or b"")

    def close(self) -> None:
        """Write what is still queued, but never wait longer than the profile says.

        Raises:
            WorkerError: the queue could not be written in time; the file holds what came before.
        """
        self.settle()
        self._stream.disconnect()
        if self._file is not None:
            self._file.close()

    def _still(self, path: str, *shapes: Any) -> None:
        self._stream.log(path, *shapes, static=True)

    def _show_still(self, world: WorldShapes | None) -> None:
        import rerun as rr

        self._still("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        self._still(f"{MAP}/path/driven", rr.LineStrips2D.from_fields(draw_order=2.0))
        self._still(f"{MAP}/ego", rr.Points2D.from_fields(draw_order=3.0))
        show_vehicle(self._still, self._job.dimensions)
        self._still("world/path/ahead", rr.LineStrips3D.from_fields(colors=[APPLIED], radii=[-WAY_PX]))
        self._still(f"{MAP}/path/ahead", rr.LineStrips2D.from_fields(colors=[APPLIED], radii=[-WAY_PX], draw_order=2.2))
        self._still(PLAN, rr.LineStrips3D.from_fields(colors=[AUTOPILOT], radii=[-WAY_PX]))
        self._still(f"{PLAN}/places", rr.Points3D.from_fields(colors=[AUTOPILOT], radii=[0.12]))
        self._still(MAP_PLAN, rr.LineStrips2D.from_fields(colors=[AUTOPILOT], radii=[-WAY_PX], draw_order=2.3))
        if self._job.vehicle.wheels is not None:
            radii = [wheel.radius_m for wheel in self._job.vehicle.wheels]
            count = len(CORNERS)
            self._still(
                "world/ego/wheels",
                rr.Cylinders3D.from_fields(
                    lengths=[WIDTH_M] * count, radii=radii, colors=[TYRE] * count, fill_mode="solid"
                ),
            )
            self._still("world/ego/tyre_forces", rr.Arrows3D.from_fields(colors=[FORCE] * count, radii=[0.03] * count))
        if self._job.scanner is not None:
            self._still("world/lidar", rr.Points3D.from_fields(colors=[ECHO], radii=[-2.0]))
            self._still(f"{MAP}/lidar", rr.Points2D.from_fields(colors=[ECHO], radii=[-WAY_PX]))
        is_robot = self._job.vehicle.is_robot
        for plot in plots_of(is_robot):
            names = [line.name for line in plot.series]
            self._still(plot.path, rr.SeriesLines(names=names, colors=[line.colour for line in plot.series]))
        for path, colours in ((LINK_LANE, LINK_COLOURS), *((kind.path, kind.colours) for kind in lanes_of(is_robot))):
            if colours:
                states = rr.StateConfiguration(values=list(colours), colors=list(colours.values()))
                self._still(path, states)
        if world is not None:
            show_world(self._still, world)

    def _send(self, path: str, times_ns: Ticks | list[int], columns: Any) -> None:
        import rerun as rr

        duration = np.asarray(times_ns, dtype=np.int64).astype("timedelta64[ns]")
        self._stream.send_columns(path, [rr.TimeColumn(TIMELINE, duration=duration)], columns)

    def _poses(self, piece: Piece) -> None:
        import rerun as rr

        pose = rr.Transform3D.columns(translation=piece.positions, quaternion=piece.quaternions)
        self._send("world/ego", piece.times_ns, pose)
        count = len(piece.ticks)
        spot = rr.Points2D.columns(
            positions=on_map(piece.positions), colors=[(255, 176, 32)] * count, radii=[-7.0] * count
        )
        self._send(f"{MAP}/ego", piece.times_ns, spot)

    def _plot(self, path: str, times_ns: Ticks, values: Any) -> None:
        import rerun as rr

        lengths = [values.shape[1]] * values.shape[0]
        self._send(path, times_ns, rr.Scalars.columns(scalars=values.reshape(-1)).partition(lengths))

    def _wheels(self, times_ns: Ticks, wheels: WheelShapes) -> None:
        import rerun as rr

        lengths = [len(CORNERS)] * len(times_ns)
        cylinders = rr.Cylinders3D.columns(
            centers=wheels.centres.reshape(-1, 3), quaternions=wheels.quaternions.reshape(-1, 4)
        )
        self._send("world/ego/wheels", times_ns, cylinders.partition(lengths))
        arrows = rr.Arrows3D.columns(
            origins=wheels.patches.reshape(-1, 3), vectors=M_PER_N * wheels.forces_n.reshape(-1, 3)
        )
        self._send("world/ego/tyre_forces", times_ns, arrows.partition(lengths))

    def _driven(self, strips: tuple[Strip, ...]) -> None:
        import rerun as rr

        if not strips:
            return
        times_ns = [strip.t_ns for strip in strips]
        colours = [MODE_COLOURS.get(strip.mode, PAINT) for strip in strips]
        above = [raised(strip.points, 0.2) for strip in strips]
        radii = [0.09] * len(strips)
        self._send("world/path/driven", times_ns, rr.LineStrips3D.columns(strips=above, colors=colours, radii=radii))
        flat = [on_map(strip.points) for strip in strips]
        radii = [-DRIVEN_PX] * len(strips)  # negative: pixels
        self._send(f"{MAP}/path/driven", times_ns, rr.LineStrips2D.columns(strips=flat, colors=colours, radii=radii))

    def _ways(self, ways: Ways) -> None:
        import rerun as rr

        if not len(ways.times_ns):
            return
        self._send("world/path/ahead", ways.times_ns, rr.LineStrips3D.columns(strips=list(ways.points)))
        flat = [on_map(way) for way in ways.points]
        self._send(f"{MAP}/path/ahead", ways.times_ns, rr.LineStrips2D.columns(strips=flat))
