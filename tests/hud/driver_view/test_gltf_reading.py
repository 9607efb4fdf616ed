import math
from random import Random

import msgspec
import numpy as np
import pytest

from simconsole.hud.driver_view.gltf import Node, glb
from simconsole.hud.driver_view.gltf_reading import read_glb
from simconsole.hud.driver_view.mesh import Box, Material, Vertices, box, cone, joined, placed
from tests.samples import Sample

HOUSE = box(Box(3.0, -2.0, 0.5, half_length_m=4.0, half_width_m=2.0, height_m=3.0, yaw_rad=0.4), (200, 120, 40))
TREE = cone(-5.0, 1.0, (0.0, 4.0), (1.0, 0.0), (20, 140, 60))


def triangles(mesh: Vertices) -> list[tuple[float, ...]]:
    """Corners and colour of each triangle, in an order that does not hang on that of the file."""
    corners = np.round(mesh["position"].reshape(-1, 9).astype(float), 3) + 0.0
    return sorted(tuple(row) for row in np.hstack((corners, mesh["colour"][::3].astype(float))).tolist())


def file_of(**changes: object) -> bytes:
    """A whole file with keys of its JSON replaced."""
    content = glb("map", [Node("house", HOUSE)])
    length = int(np.frombuffer(content[12:16], "<u4")[0])
    told = {**msgspec.json.decode(content[20 : 20 + length]), **changes}
    text = msgspec.json.encode(told)
    text += b" " * (-len(text) % 4)
    return content[:12] + np.array((len(text), 0x4E4F534A), "<u4").tobytes() + text + content[20 + length :]


def test_what_is_written_is_read_back() -> None:
    content = glb("map", [Node("house", HOUSE), Node("tree", TREE, (10.0, 20.0, 30.0))])
    moved = placed(TREE, (10.0, 20.0, 30.0), 0.0, 1.0)
    assert triangles(read_glb(content)) == triangles(joined([HOUSE, moved]))


def test_what_shines_by_itself_still_does() -> None:
    lamp = HOUSE.copy()
    lamp["colour"][:, 3] = Material.GLOWING
    assert (read_glb(glb("map", [Node("lamp", lamp)]))["colour"][:, 3] == Material.GLOWING).all()


def test_places_of_nodes_follow_each_other() -> None:
    half = math.sqrt(0.5)
    nodes = [
        {"children": [1], "translation": [1.0, 2.0, 3.0]},
        {"mesh": 0, "rotation": [0.0, half, 0.0, half], "scale": [2.0, 2.0, 2.0]},
    ]
    plain = read_glb(file_of(nodes=[{"mesh": 0}], scenes=[{"nodes": [0]}]))
    found = read_glb(file_of(nodes=nodes, scenes=[{"nodes": [0]}]))
    # A quarter about the file's y, which points up here; then moved by the file's (1, 2, 3), which is (1, -3, 2) here.
    assert triangles(found) == triangles(placed(plain, (1.0, -3.0, 2.0), 0.5 * math.pi, 2.0))


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "no binary glTF 2.0"),
        (b"solid cube", "no binary glTF 2.0"),
        (file_of()[:400], "ends too early"),
        (file_of(extensionsRequired=["KHR_draco_mesh_compression"]), "KHR_draco_mesh_compression"),
        (file_of(nodes=[{"children": [0]}], scenes=[{"nodes": [0]}]), "in a circle"),
        (file_of(nodes=[{"children": [0] * 30_000}], scenes=[{"nodes": [0]}]), "in a circle"),
        (file_of(nodes=[{"mesh": 7}], scenes=[{"nodes": [0]}]), "what it does not have"),
        (file_of(bufferViews=[{"buffer": 1, "byteLength": 10**9}] * 20), "outside the file"),
        (file_of(bufferViews=[{"buffer": 0, "byteLength": 4}] * 20), "beyond its buffer"),
        (file_of(nodes=[{"mesh": -1}]), "JSON"),
        (file_of(nodes=[{"translation": [1e300, 0, 0]}]), "JSON"),
    ],
)
def test_what_cannot_be_read_is_refused_by_name(content: bytes, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        read_glb(content)


def test_damaged_files_are_read_or_refused(sample: Sample) -> None:
    chance, whole = Random(sample.seed), file_of()
    refused = 0
    for _ in range(sample.of(1_000, 50_000)):
        damaged = bytearray(whole)
        for _ in range(chance.randint(1, 4)):
            damaged[chance.randrange(len(damaged))] = chance.randrange(256)
        try:
            read_glb(bytes(damaged))
        except ValueError:
            refused += 1
    assert refused > 0
