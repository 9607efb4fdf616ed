"""What the driver's view needs before its first frame, as one .npz file in the run folder."""

from pathlib import Path
from typing import Any, Final, NamedTuple
from zipfile import BadZipFile

import numpy as np

from simconsole.hud.driver_view.gltf_reading import read_glb
from simconsole.hud.driver_view.mesh import Vertices, joined, placed
from simconsole.hud.driver_view.scene import NO_MESH, NO_MODELS, Models, ViewScene, view_scene
from simconsole.hud.driver_view.surroundings import Limits
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.profiles.files.loader import read_bytes
from simconsole.profiles.view import ModelFile
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.errors import ProfileError, WorkerError
from simconsole.values.host.jit import plain
from simconsole.values.units import KMH_PER_MPS, RAD_PER_DEG
from simconsole.world.drawing import Drawing
from simconsole.world.drawing_arrays import from_arrays, to_arrays
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import Route

SIGN_STEP_KMH: Final = 5.0
SHORTEST_LIMIT_M: Final = 40.0
MODEL_BYTES: Final = 64 * 1024 * 1024


class ViewJob(NamedTuple):
    """A drive to look at."""

    drawing: Drawing | None  # None: a session without a world
    limits: Limits  # along the drawing's path
    size: Size
    steering_ratio: float  # hand-wheel angle per road-wheel angle
    models: Models = NO_MODELS

    def scene(self) -> ViewScene:
        """Return the scene."""
        return view_scene(self.drawing, self.limits, self.size, self.models)


def view_job(resolved: ResolvedSession, models: Models | None = None) -> ViewJob:
    """Return what there is to see of a session.

    Args:
        resolved: The session.
        models: In place of those that its profile names.

    Raises:
        ProfileError: a model that its profile names cannot be read.
    """
    platform = assemble(resolved, plain)[0].platform
    world = None if resolved.world is None else open_world(resolved.world)
    return ViewJob(
        drawing=None if world is None else world.drawing,
        limits=() if world is None else limits_of(world.route),
        size=Size(
            length_m=platform.length_m,
            width_m=platform.width_m,
            height_m=platform.height_m,
            rear_overhang_m=platform.rear_overhang_m,
            wheelbase_m=platform.wheelbase_m,
        ),
        steering_ratio=platform.steering_ratio,
        models=brought_models(resolved) if models is None else models,
    )


def brought_models(resolved: ResolvedSession) -> Models:
    """Return the models that a session's profile names.

    Raises:
        ProfileError: one of them cannot be read.
    """
    hud = resolved.session.outputs.hud
    if hud is None or hud.view is None:
        return NO_MODELS
    body = NO_MESH if hud.view.vehicle_model is None else _read(hud.view.vehicle_model)
    return Models(joined([_read(model) for model in hud.view.models]), body)


def _read(model: ModelFile) -> Vertices:
    try:
        mesh = read_glb(read_bytes(Path(model.file), MODEL_BYTES))
    except ValueError as problem:
        raise ProfileError(f"{model.file}: file: {problem}: binary glTF 2.0 (.glb)") from None
    return placed(mesh, (model.x_m, model.y_m, model.z_m), model.yaw_deg * RAD_PER_DEG, model.scale)


def limit_kmh(route: Route) -> float:
    """Return the limit that holds all along a route, 0 where it changes on the way."""
    return route.speed_limit_mps * KMH_PER_MPS if bool((route.limit == route.limit[0]).all()) else 0.0


def limits_of(route: Route) -> Limits:
    """Return where along a route which limit begins. What holds for a few metres only is no limit that a sign tells.

    A map's lanes inside junctions have limits of their own: how fast a car gets round the bend.
    """
    kmh = SIGN_STEP_KMH * np.maximum(1.0, np.round(route.limit * KMH_PER_MPS / SIGN_STEP_KMH))
    starts = np.flatnonzero(np.diff(kmh, prepend=-1.0))
    ends = np.append(route.s[starts[1:]], route.length_m)
    told: list[tuple[float, float]] = []
    for index, end in zip(starts.tolist(), ends.tolist(), strict=True):
        lasts = end - route.s[index] >= SHORTEST_LIMIT_M
        if lasts and not (told and told[-1][1] == kmh[index]):
            told.append((float(route.s[index]), float(kmh[index])))
    return tuple(told)


def save_view_job(path: Path, job: ViewJob) -> None:
    """Write a job.

    Raises:
        WorkerError: the file cannot be written.
    """
    content: dict[str, Any] = {} if job.drawing is None else to_arrays(job.drawing)
    content |= {"size": np.array(job.size)}
    content |= {"limits": np.array(job.limits).reshape(-1, 2), "ratio": np.array(job.steering_ratio)}
    content |= {"models": job.models.world, "body": job.models.body}
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
            return ViewJob(
                drawing=from_arrays(content),
                limits=tuple((start, kmh) for start, kmh in content["limits"].tolist()),
                size=Size(*content["size"].tolist()),
                steering_ratio=float(content["ratio"]),
                models=Models(content["models"], content["body"]),
            )
    except OSError as problem:
        raise WorkerError(f"{path}: cannot be read: {problem.strerror or problem}") from None
    except (BadZipFile, ValueError, KeyError, TypeError, EOFError) as problem:
        raise WorkerError(f"{path}: is not a view job: {problem}") from None
