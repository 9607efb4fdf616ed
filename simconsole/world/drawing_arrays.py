"""A drawing as named arrays, for processes that draw: what goes into one .npz file and comes out of it."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from simconsole.world.drawing import Drawing
from simconsole.world.drawing_layers import Light

_LINES: Final = ("surfaces", "islands", "edges", "centre_lines", "zebras", "stop_lines")


def to_arrays(drawing: Drawing) -> dict[str, Any]:
    """Return the arrays of a drawing: of each kind of lines all points, and where each line ends."""
    content: dict[str, Any] = {"path": drawing.path, "lights": np.array(drawing.lights).reshape(-1, 3)}
    for name in _LINES:
        lines = getattr(drawing, name)
        content[name] = np.vstack(lines) if lines else np.empty((0, 2))
        content[f"{name}_ends"] = np.cumsum([len(line) for line in lines], dtype=np.int64)
    content["walls"] = np.vstack(drawing.walls) if drawing.walls else np.empty((0, 3))
    content["walls_ends"] = np.cumsum([len(line) for line in drawing.walls], dtype=np.int64)
    return content


def from_arrays(content: Mapping[str, Any]) -> Drawing | None:
    """Return the drawing of `to_arrays`, None where there is none.

    Raises:
        KeyError: some array is missing.
        ValueError, TypeError: one has not the shape that it must have.
    """
    if "path" not in content:
        return None
    lines = {name: tuple(np.split(content[name], content[f"{name}_ends"])[:-1]) for name in (*_LINES, "walls")}
    lights = tuple(Light(*light) for light in content["lights"].tolist())
    return Drawing(**lines, lights=lights, path=content["path"])
