"""What the driver's view needs before its first frame, as one .npz file in the run folder."""

from pathlib import Path
from typing import Any, NamedTuple
from zipfile import BadZipFile

import numpy as np

from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.errors import WorkerError
from simconsole.values.host.jit import plain
from simconsole.values.units import KMH_PER_MPS
from simconsole.world.drawing import Drawing
from simconsole.world.drawing_arrays import from_arrays, to_arrays
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import Route


class ViewJob(NamedTuple):
    """A drive to look at."""

    drawing: Drawing | None  # None: a session without a world
    limit_kmh: float  # 0: none that holds everywhere
    size: Size
    steering_ratio: float  # hand-wheel angle per road-wheel angle


def view_job(resolved: ResolvedSession) -> ViewJob:
    """Return what there is to see of a session."""
    platform = assemble(resolved, plain)[0].platform
    world = None if resolved.world is None else open_world(resolved.world)
    return ViewJob(
        drawing=None if world is None else world.drawing,
        limit_kmh=0.0 if world is None else limit_kmh(world.route),
        size=Size(
            length_m=platform.length_m,
            width_m=platform.width_m,
            height_m=platform.height_m,
            rear_overhang_m=platform.rear_overhang_m,
            wheelbase_m=platform.wheelbase_m,
        ),
        steering_ratio=platform.steering_ratio,
    )


def limit_kmh(route: Route) -> float:
    """Return the limit that holds all along a route, 0 where it changes on the way."""
    return route.speed_limit_mps * KMH_PER_MPS if bool((route.limit == route.limit[0]).all()) else 0.0


def save_view_job(path: Path, job: ViewJob) -> None:
    """Write a job.

    Raises:
        WorkerError: the file cannot be written.
    """
    content: dict[str, Any] = {} if job.drawing is None else to_arrays(job.drawing)
    content |= {"size": np.array(job.size), "numbers": np.array((job.limit_kmh, job.steering_ratio))}
    try:
        with path.open("wb") as file:
            np.savez(file, **content)
    except OSError as problem:
        raise WorkerError(f"{path}: cannot be written: {problem.strerror}") from None


def load_view_job(path: Path) -> ViewJob:
    """Read a job.

    Raises:
        WorkerError: missing, or not such a job.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as content:
            limit_kmh, ratio = content["numbers"].tolist()
            return ViewJob(from_arrays(content), limit_kmh, Size(*content["size"].tolist()), ratio)
    except OSError as problem:
        raise WorkerError(f"{path}: cannot be read: {problem.strerror or problem}") from None
    except (BadZipFile, ValueError, KeyError, TypeError, EOFError) as problem:
        raise WorkerError(f"{path}: is not a view job: {problem}") from None
