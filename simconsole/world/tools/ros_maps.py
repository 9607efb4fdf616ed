"""ROS maps as files, `map.yaml` and its image, as map_server and map_saver of Nav2 read and write them."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Final, Literal

import numpy as np
from msgspec import Meta, Struct
from numpy.typing import NDArray

from simconsole.profiles.files.loader import MAX_DATA_BYTES, read_bytes, read_text_of
from simconsole.profiles.strict_yaml import parse
from simconsole.profiles.validation import convert, worded
from simconsole.profiles.world import ArenaProfile
from simconsole.values.errors import ProfileError
from simconsole.world.arena.occupancy import FREE, MOST_CELLS, OCCUPIED, UNKNOWN, Grid, arena_of_grid, grid_of

IMAGES: Final = (".pgm", ".png")
MAX_IMAGE_BYTES: Final = 32 * 1024 * 1024
_SHADES: Final = {OCCUPIED: 0, FREE: 254, UNKNOWN: 205}
"""The grey values of map_saver."""
_WHITE: Final = 255.0
Share = Annotated[float, Meta(ge=0.0, le=1.0)]


class RosMap(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The keys of map.yaml."""

    image: Annotated[str, worded(r"^[^/\\]{1,200}\.(pgm|png)$", "a file beside it that ends in .pgm or .png")]
    """A file beside it."""
    resolution: Annotated[float, Meta(ge=0.005, le=10.0)]  # m
    origin: Annotated[tuple[float, ...], Meta(min_length=3, max_length=3)]  # x, y in m, yaw in rad
    negate: Literal[0, 1] = 0
    occupied_thresh: Share = 0.65
    free_thresh: Share = 0.25
    mode: Literal["trinary", "scale"] = "trinary"


def read_ros_map(path: Path, title: str) -> ArenaProfile:
    """Return the arena of a map.

    Raises:
        ProfileError: the files cannot be read as such a map; names file and key.
    """
    grid = read_grid(path)
    try:
        return arena_of_grid(grid, title)
    except (ProfileError, ValueError) as problem:
        raise ProfileError(f"{path}: {problem}") from None


def read_grid(path: Path) -> Grid:
    """Return a map as an occupancy grid.

    Raises:
        ProfileError: the files cannot be read as such a map; names file and key.
    """
    known = convert(parse(read_text_of(path, MAX_DATA_BYTES), str(path)), RosMap, str(path))
    if not all(map(math.isfinite, known.origin)):
        raise ProfileError(f"{path}: origin: value {list(known.origin)}: finite numbers")
    if known.origin[2] != 0.0:
        raise ProfileError(f"{path}: origin: value {known.origin[2]:g}: a map that is not turned (0)")
    if known.free_thresh >= known.occupied_thresh:
        raise ProfileError(f"{path}: free_thresh: value {known.free_thresh:g}: below occupied_thresh")
    shades = _image(path.parent / known.image)
    share = (shades if known.negate else _WHITE - shades) / _WHITE  # how much of a cell is occupied
    cells = np.full(shades.shape, UNKNOWN, dtype=np.int8)
    cells[share > known.occupied_thresh] = OCCUPIED
    cells[share < known.free_thresh] = FREE
    return Grid(cells[::-1], known.resolution, known.origin[0], known.origin[1])


def _image(path: Path) -> NDArray[np.float64]:
    """Return the grey values, 0 to 255, of an image [rows, columns], its first row on top."""
    content = read_bytes(path, MAX_IMAGE_BYTES)
    return _told(path, lambda: _grey(content, path.suffix))


def _grey(content: bytes, suffix: str) -> NDArray[np.float64]:
    import io

    from matplotlib import image

    found: Any = image.imread(io.BytesIO(content), format=suffix.removeprefix("."))
    if found.size > 4 * MOST_CELLS:
        raise ValueError(f"has more than {MOST_CELLS} cells")
    scale = _WHITE if found.dtype.kind == "f" else 1.0  # of PNG, matplotlib gives shares
    values = np.asarray(found, dtype=np.float64) * scale
    if values.ndim == 3:
        values = values[:, :, : 3 if values.shape[2] >= 3 else 1].mean(axis=2)
    return values


def _told(path: Path, read: Callable[[], NDArray[np.float64]]) -> NDArray[np.float64]:
    try:
        return read()
    except (OSError, ValueError, SyntaxError, TypeError, IndexError, EOFError) as problem:  # what image readers raise
        raise ProfileError(f"{path}: file: value no image: {problem}: an image, grey or in colours") from None


def write_ros_map(profile: ArenaProfile, folder: Path, name: str, resolution_m: float) -> tuple[Path, Path]:
    """Write an arena as NAME.yaml and NAME.pgm; return both.

    Raises:
        ProfileError: a file is there already or cannot be written, or there would be too many cells.
    """
    return write_grid(grid_of(profile, resolution_m), folder, name)


def write_grid(grid: Grid, folder: Path, name: str) -> tuple[Path, Path]:
    """Write an occupancy grid as NAME.yaml and NAME.pgm; return both.

    Raises:
        ProfileError: a file is there already or cannot be written.
    """
    described, image = folder / f"{name}.yaml", folder / f"{name}.pgm"
    for path in (described, image):
        if path.exists():
            raise ProfileError(f"{path}: file: value taken: a name that is free")
    shades = np.zeros(grid.cells.shape, dtype=np.uint8)
    for state, shade in _SHADES.items():
        shades[grid.cells == state] = shade
    rows, columns = grid.cells.shape
    text = (
        f"image: {image.name}\nmode: trinary\nresolution: {grid.resolution_m:g}\n"
        f"origin: [{grid.x_m:.6f}, {grid.y_m:.6f}, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"
    )
    try:
        folder.mkdir(parents=True, exist_ok=True)
        image.write_bytes(b"P5\n%d %d\n255\n" % (columns, rows) + shades[::-1].tobytes())
        described.write_text(text, encoding="utf-8")
    except OSError as error:
        raise ProfileError(f"{folder}: file: {error.strerror}: a folder that can be written to") from None
    return described, image


def arena_text(profile: ArenaProfile, source: str) -> str:
    """Return an arena as the text of a profile, a wall on each line."""
    lines = [f"# Made by `simconsole world import` from {source}.", "schema: 1", "kind: arena"]
    lines += [f'title: "{profile.title}"', "walls:"]
    for wall in profile.walls:
        corners = ", ".join(f"{{x_m: {corner.x_m:.10g}, y_m: {corner.y_m:.10g}}}" for corner in wall.points)
        lines.append(f"  - {{points: [{corners}]}}")
    lines.append("starts:")
    for spot in profile.starts:
        lines.append(
            f"  - {{name: {spot.name}, x_m: {spot.x_m:.10g}, y_m: {spot.y_m:.10g}, yaw_deg: {spot.yaw_deg:g}}}"
        )
    return "\n".join(lines) + "\n"
