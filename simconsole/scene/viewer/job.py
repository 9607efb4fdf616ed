"""What a scene needs before the first state vector: course, car and columns; as one .npz file for a live drive."""

from pathlib import Path
from typing import Any, NamedTuple
from zipfile import BadZipFile

import msgspec
import numpy as np

from simconsole.profiles.view import SceneProfile
from simconsole.scene.entities import Dimensions
from simconsole.values.errors import WorkerError
from simconsole.world.drawing import Drawing
from simconsole.world.drawing_arrays import from_arrays, to_arrays


class Job(NamedTuple):
    """A drive to show; its state vectors come block by block."""

    columns: tuple[str, ...]  # of the state vectors
    tick_hz: int
    dimensions: Dimensions
    drawing: Drawing | None
    profile: SceneProfile


def save_job(path: Path, job: Job) -> None:
    """Write a job.

    Raises:
        WorkerError: the file cannot be written.
    """
    content: dict[str, Any] = {
        "columns": np.array(job.columns),
        "tick_hz": job.tick_hz,
        "dimensions": np.array(job.dimensions),
        "profile": np.frombuffer(msgspec.json.encode(job.profile), dtype=np.uint8),
    }
    if job.drawing is not None:
        content |= to_arrays(job.drawing)
    try:
        with path.open("wb") as file:
            np.savez(file, **content)
    except OSError as problem:
        raise WorkerError(f"{path}: cannot be written: {problem.strerror}") from None


def load_job(path: Path) -> Job:
    """Read a job.

    Raises:
        WorkerError: missing, or not a scene job.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as content:
            return Job(
                columns=tuple(content["columns"].tolist()),
                tick_hz=int(content["tick_hz"]),
                dimensions=Dimensions(*content["dimensions"].tolist()),
                drawing=from_arrays(content),
                profile=msgspec.json.decode(content["profile"].tobytes(), type=SceneProfile),
            )
    except OSError as problem:
        raise WorkerError(f"{path}: cannot be read: {problem.strerror or problem}") from None
    except (BadZipFile, ValueError, KeyError, TypeError, EOFError) as problem:
        raise WorkerError(f"{path}: is not a scene job: {problem}") from None
