"""The input of a scene process: the job of a live scene and of an exported one."""

from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from simconsole.profiles.view import SceneProfile
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.host.jit import plain
from simconsole.values.kernels import Row
from simconsole.world.course import Course

if TYPE_CHECKING:
    from simconsole.scene.viewer.job import Job

Ticks = NDArray[np.int64]

LIVE_SCENE: Final = "scene.live.rrd"
"""What a paced drive's scene worker records; the whole scene, made from the log, takes its place."""


def scene_job(resolved: ResolvedSession, vectors: Row, ticks: Ticks, columns: tuple[str, ...], tick_hz: int) -> "Job":
    """Return the input of a scene process: state vectors (none for a live one), course and car."""
    from simconsole.scene.entities import Dimensions
    from simconsole.scene.viewer.job import Job
    from simconsole.world.drawing import draw

    platform, course = assemble(resolved, plain)[0].platform, None if resolved.world is None else Course(resolved.world)
    dimensions = Dimensions(platform.length_m, platform.width_m, platform.height_m, platform.rear_overhang_m)
    drawing = None if course is None else draw(course)
    return Job(
        vectors=vectors,
        ticks=ticks,
        columns=columns,
        tick_hz=tick_hz,
        dimensions=dimensions,
        drawing=drawing,
        profile=resolved.session.outputs.scene or SceneProfile(),
    )
