"""A drawing as named arrays, for processes that draw: what goes into one .npz file and comes out of it."""

from collections.abc import Mapping
from typing import Any, Final

import msgspec
import numpy as np

from simconsole.values.height_field import Grid, HeightField
from simconsole.world.drawing import Drawing
from simconsole.world.drawing_layers import Light, LightProgram

_LINES: Final = ("surfaces", "islands", "edges", "centre_lines", "zebras", "stop_lines")


def to_arrays(drawing: Drawing) -> dict[str, Any]:
    """Return the arrays of a drawing: of each kind of lines all points, and where each line ends."""
    content: dict[str, Any] = {
        "path": drawing.path,
        "lights": np.array([light[:3] for light in drawing.lights]).reshape(-1, 3),
        "light_programs": np.frombuffer(msgspec.json.encode([light.program for light in drawing.lights]), np.uint8),
    }
    for name in _LINES:
        lines = getattr(drawing, name)
        content[name] = np.vstack(lines) if lines else np.empty((0, 2))
        content[f"{name}_ends"] = np.cumsum([len(line) for line in lines], dtype=np.int64)
    if drawing.ground is not None:
        content["ground_grid"], content["ground_nodes"] = np.array(drawing.ground.grid), drawing.ground.nodes
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
    programs = msgspec.json.decode(content["light_programs"].tobytes(), type=list[LightProgram | None])
    places = zip(content["lights"].tolist(), programs, strict=True)
    lights = tuple(Light(x, y, yaw, program) for (x, y, yaw), program in places)
    ground = None
    if "ground_nodes" in content:
        ground = HeightField(Grid(*content["ground_grid"].tolist()), content["ground_nodes"])
    return Drawing(**lines, lights=lights, path=content["path"], ground=ground)
