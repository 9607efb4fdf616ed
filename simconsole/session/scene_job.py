"""The input of a scene process: the job of a live scene and of an exported one."""

from typing import TYPE_CHECKING, Final

from simconsole.profiles.view import SceneProfile
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.host.jit import plain
from simconsole.world.kinds.worlds import open_world

if TYPE_CHECKING:
    from simconsole.scene.viewer.job import Job

LIVE_SCENE: Final = "scene.live.rrd"
"""What a paced drive's scene worker records; the whole scene, made from the log, takes its place."""


def scene_job(resolved: ResolvedSession, columns: tuple[str, ...], tick_hz: int) -> "Job":
    """Return what a scene process needs before the first state vector, which will have `columns`."""
    from simconsole.scene.entities import Dimensions
    from simconsole.scene.viewer.job import Job

    platform = assemble(resolved, plain)[0].platform
    dimensions = Dimensions(platform.length_m, platform.width_m, platform.height_m, platform.rear_overhang_m)
    drawing = None if resolved.world is None else open_world(resolved.world).drawing
    return Job(
        columns=columns,
        tick_hz=tick_hz,
        dimensions=dimensions,
        drawing=drawing,
        profile=resolved.session.outputs.scene or SceneProfile(),
    )
