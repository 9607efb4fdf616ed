"""The scene in rerun: the only place that calls it, and only ever in a process of its own.

rerun's log() may block for good when its viewer freezes, so nothing here may run beside the tick loop.
"""

from pathlib import Path
from typing import Any, Final

import numpy as np

from simconsole.profiles.view import SceneProfile
from simconsole.scene.entities import (
    ASPHALT,
    BODY,
    GREEN,
    GROUND,
    HEAD_M,
    LAMPS,
    MAP_EDGE,
    MODE_COLOURS,
    PAINT,
    POST_M,
    TAKEOVER_COLOURS,
    THEORETICAL,
    WALL,
    Array,
    Dimensions,
    Mesh,
    WorldShapes,
    car_solids,
    on_map,
    raised,
)
from simconsole.scene.lamp_shapes import LampShapes
from simconsole.scene.road_user_shapes import RoadUserShapes
from simconsole.scene.timeline import PLOTS, TAKEOVER_LABELS, Entry, Lane, Piece, Strip, Ticks
from simconsole.scene.viewer.blueprint import MAP, TIMELINE, blueprint
from simconsole.values.errors import WorkerError
from simconsole.values.labels import mode_label

APPLICATION: Final = "simconsole"
DRIVEN_PX: Final = 2.0


class RerunView:
    """One recording being written."""

    def __init__(
        self, path: Path, profile: SceneProfile, dimensions: Dimensions, world: WorldShapes | None, index: bool = True
    ) -> None:
        """Open the file and write what stands still.

        Args:
            path: the file to write.
            profile: rates and waits.
            dimensions: the car's.
            world: what stands around it, if anything.
            index: end the file with an index of all that was written. rerun collects it in memory, about 1.8 kB for
                each call of `add` and entity, so a recording without an end has none; viewers read both.

        Raises:
            WorkerError: the file cannot be written.
        """
        import rerun as rr

        self._flush_s = profile.flush_s
        self._has_road_users = False
        self._stream = rr.RecordingStream(APPLICATION, recording_id=path.stem, send_properties=True)
        rr.set_strict_mode(True)
        try:
            layout = blueprint(profile, dimensions.scale, None if world is None else world.path)
            self._stream.save(path, default_blueprint=layout, write_footer=index)
        except (OSError, RuntimeError) as problem:
            raise WorkerError(f"{path}: the scene cannot be written: {problem}") from None
        self._still("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        self._still(f"{MAP}/path/driven", rr.LineStrips2D.from_fields(draw_order=2.0))
        self._still(f"{MAP}/ego", rr.Points2D.from_fields(draw_order=3.0))
        self._car(dimensions)
        for plot in PLOTS:
            names = [line.name for line in plot.series]
            self._still(plot.path, rr.SeriesLines(names=names, colors=[line.colour for line in plot.series]))
        modes = {mode_label(mode): colour for mode, colour in MODE_COLOURS.items()}
        stages = dict(zip(TAKEOVER_LABELS, TAKEOVER_COLOURS, strict=True))
        for lane, colours in (("lanes/mode", modes), ("lanes/takeover", stages)):
            self._still(lane, rr.StateConfiguration(values=list(colours), colors=list(colours.values())))
        if world is not None:
            self._world(world)
        # rerun batches single log calls. After this flush even a killed process leaves a file with the world in it.
        self._flush()

    def add(self, piece: Piece) -> None:
        """Write what a piece of the drive adds, one call per entity."""
        if len(piece.ticks):
            self._poses(piece)
            self._plots(piece)
        for lane in piece.lanes:
            self._lane(lane)
        self._driven(piece.strips)
        self._entries(piece.entries)

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

        lamps = rr.Points3D.columns(positions=shapes.centres, colors=shapes.colours, radii=[0.14] * len(shapes.centres))
        self._send("world/lights/lit", shapes.times_ns, lamps.partition(shapes.counts))

    def settle(self) -> None:
        """Wait until all added is in the file: what rerun has queued for a slow disk would grow in memory.

        Raises:
            WorkerError: the disk did not take it within the profile's wait; the file holds what came before.
        """
        self._flush()

    def close(self) -> None:
        """Write what is still queued, but never wait longer than the profile says.

        Raises:
            WorkerError: the queue could not be written in time; the file holds what came before.
        """
        self._flush()
        self._stream.disconnect()

    def _flush(self) -> None:
        try:
            self._stream.flush(timeout_sec=self._flush_s)
        except (RuntimeError, TimeoutError, ValueError) as problem:
            raise WorkerError(f"the scene was not written whole within {self._flush_s:g} s: {problem}") from None

    def _still(self, path: str, *shapes: Any) -> None:
        self._stream.log(path, *shapes, static=True)

    def _car(self, dimensions: Dimensions) -> None:
        import rerun as rr

        if dimensions.is_ball:
            half = 0.5 * dimensions.height_m
            ball = rr.Ellipsoids3D(
                centers=[(0.0, 0.0, half)], half_sizes=[(half,) * 3], colors=[BODY], fill_mode="solid"
            )
            self._still("world/ego/body", ball)
            return
        solids = car_solids(dimensions)
        self._still(
            "world/ego/body",
            rr.Boxes3D(
                centers=[solid.centre for solid in solids],
                half_sizes=[solid.half_size for solid in solids],
                colors=[solid.colour for solid in solids],
                fill_mode="solid",
            ),
        )

    def _world(self, world: WorldShapes) -> None:
        for name, mesh, colour in (
            ("ground", world.ground, GROUND),
            ("surface", world.surfaces, ASPHALT),
            ("island", world.islands, GREEN),
            ("paint", world.paint, PAINT),
            ("walls", world.walls, WALL),
        ):
            self._mesh(f"world/road/{name}", mesh, colour)
        self._still("world/road/edges", _strips3d(world.edges, PAINT, 0.07))
        self._still("world/road/centre", _strips3d(world.centre_dashes, PAINT, 0.07))
        self._still("world/path/theoretical", _strips3d((world.path,), THEORETICAL, 0.12))
        self._flat("road/edges", (*world.edges, *world.wall_lines), MAP_EDGE, 0.5, 0.0)
        self._flat("path/theoretical", (world.path,), THEORETICAL, 3.0, 1.0)
        self._lights(world)

    def _mesh(self, path: str, mesh: Mesh, colour: tuple[int, int, int]) -> None:
        import rerun as rr

        if len(mesh.triangles):
            up = np.tile((0.0, 0.0, 1.0), (len(mesh.vertices), 1))
            shape = rr.Mesh3D(
                vertex_positions=mesh.vertices,
                triangle_indices=mesh.triangles,
                vertex_normals=up,
                albedo_factor=colour,
                face_rendering="DoubleSided",
            )
            self._still(path, shape)

    def _flat(
        self, name: str, lines: tuple[Array, ...], colour: tuple[int, int, int], radius_px: float, order: float
    ) -> None:
        import rerun as rr

        strips = rr.LineStrips2D(
            [on_map(line) for line in lines],
            colors=[colour],
            radii=rr.Radius.ui_points(radius_px),
            draw_order=order,
        )
        self._still(f"{MAP}/{name}", strips)

    def _lights(self, world: WorldShapes) -> None:
        import rerun as rr

        if not len(world.light_posts):
            return
        posts = raised(world.light_posts, 0.5 * POST_M)
        heads = raised(world.light_posts, POST_M)
        count = len(posts)
        self._still(
            "world/lights/posts",
            rr.Boxes3D(
                centers=np.vstack((posts, heads)),
                half_sizes=[(0.06, 0.06, 0.5 * POST_M)] * count + [(0.17, 0.17, 0.5 * HEAD_M + 0.05)] * count,
                colors=[(70, 76, 84)],
                fill_mode="solid",
            ),
        )
        lamps = world.light_lamps.reshape(-1, 3)
        self._still("world/lights/lamps", rr.Points3D(lamps, colors=list(LAMPS) * count, radii=[0.11]))
        spots = on_map(world.light_posts)
        self._still(f"{MAP}/lights", rr.Points2D(spots, colors=[(255, 176, 32)], radii=rr.Radius.ui_points(3.5)))

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

    def _plots(self, piece: Piece) -> None:
        import rerun as rr

        for path, values in piece.plots.items():
            lengths = [values.shape[1]] * values.shape[0]
            columns = rr.Scalars.columns(scalars=values.reshape(-1)).partition(lengths)
            self._send(path, piece.times_ns, columns)

    def _lane(self, lane: Lane) -> None:
        import rerun as rr

        if lane.times_ns:
            self._send(lane.path, lane.times_ns, rr.StateChange.columns(state=lane.states))

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

    def _entries(self, entries: tuple[Entry, ...]) -> None:
        import rerun as rr

        if entries:
            lines = rr.TextLog.columns(text=[entry.text for entry in entries], level=[entry.level for entry in entries])
            self._send("log", [entry.t_ns for entry in entries], lines)


def _strips3d(lines: tuple[Array, ...], colour: tuple[int, int, int], radius_m: float) -> Any:
    import rerun as rr

    return rr.LineStrips3D(lines, colors=[colour], radii=[radius_m])
