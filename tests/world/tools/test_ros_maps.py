from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.values.errors import ProfileError
from simconsole.world.tools.ros_maps import arena_text, read_ros_map, write_ros_map
from tests.world.arena.shipped_arena import arena

SHADES = np.array([[205, 205, 205, 205], [0, 254, 254, 0], [0, 254, 254, 0], [0, 0, 0, 0]], dtype=np.uint8)
"""As a picture is stored: the first row is the upper one, the last in y."""


def written(folder: Path, image: str = "m.pgm", **keys: object) -> Path:
    if image.endswith(".png"):
        from matplotlib import image as images

        images.imsave(folder / image, SHADES, cmap="gray", vmin=0, vmax=255)
    else:
        (folder / image).write_bytes(b"P5\n# made by a test\n4 4\n255\n" + SHADES.tobytes())
    known = {"image": image, "resolution": 0.5, "origin": [1.0, -1.0, 0.0], "negate": 0, **keys}
    (folder / "m.yaml").write_text("".join(f"{key}: {value}\n" for key, value in known.items()))
    return folder / "m.yaml"


def test_an_arena_saved_as_a_ros_map_is_read_back(tmp_path: Path) -> None:
    described, image = write_ros_map(arena(), tmp_path, "arena", 0.05)
    assert image.read_bytes().startswith(b"P5\n")
    again = read_ros_map(described, "Again")
    assert again.title == "Again"
    x = [point.x_m for wall in again.walls for point in wall.points]
    y = [point.y_m for wall in again.walls for point in wall.points]
    assert (min(x), max(x), min(y), max(y)) == pytest.approx((0.0, 9.0, 0.0, 6.0), abs=0.051)
    (tmp_path / "again.yaml").write_text(arena_text(again, "map.yaml"))
    assert load_world(str(tmp_path / "again.yaml")) == again
    with pytest.raises(ProfileError, match="taken"):
        write_ros_map(arena(), tmp_path, "arena", 0.05)


@pytest.mark.parametrize("image", ["m.pgm", "m.png"])
def test_walls_lie_where_the_picture_is_dark_and_its_last_row_is_the_lowest(tmp_path: Path, image: str) -> None:
    arena = read_ros_map(written(tmp_path, image), "t")
    sides = {tuple((point.x_m, point.y_m) for point in wall.points) for wall in arena.walls}
    assert ((1.5, -0.5), (2.5, -0.5)) in sides, "the wall below the free cells"
    assert ((1.0, -1.0), (3.0, -1.0)) in sides, "its outer side"
    assert ((1.5, -0.5), (1.5, 0.5)) in sides


def test_a_negated_picture_is_light_where_there_are_walls(tmp_path: Path) -> None:
    arena = read_ros_map(written(tmp_path, negate=1, free_thresh=0.1), "t")
    lowest = min(point.y_m for wall in arena.walls for point in wall.points)
    assert lowest == -0.5, "the dark row is free"


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ({"origin": [0.0, 0.0, 0.5]}, "m.yaml: origin: value 0.5"),
        ({"image": "../m.pgm"}, "image: value"),
        ({"image": "none.pgm"}, "none.pgm"),
        ({"resolution": 0.0}, "resolution: value 0"),
        ({"mode": "raw"}, "mode: value"),
        ({"free_thresh": 0.9}, "free_thresh: value 0.9"),
        ({"negate": 1, "occupied_thresh": 1.0}, "occupied"),
        ({"colour": "red"}, "colour"),
    ],
)
def test_a_map_that_says_something_impossible_is_refused(tmp_path: Path, keys: dict[str, Any], told: str) -> None:
    with pytest.raises(ProfileError, match=told) as refused:
        read_ros_map(written(tmp_path, **keys), "t") if "image" not in keys else read_ros_map(
            renamed(tmp_path, str(keys["image"])), "t"
        )
    assert "\n" not in str(refused.value)


def renamed(folder: Path, image: str) -> Path:
    path = written(folder)
    path.write_text(path.read_text().replace("m.pgm", image))
    return path


@pytest.mark.parametrize("content", [b"", b"P5\n4 4\n255\n", b"P5\nx", b"\x89PNG\r\n\x1a\nrubbish"])
def test_what_is_no_picture_is_refused(tmp_path: Path, content: bytes) -> None:
    path = written(tmp_path)
    (tmp_path / "m.pgm").write_bytes(content)
    with pytest.raises(ProfileError, match=r"m\.pgm: file: value no image"):
        read_ros_map(path, "t")
