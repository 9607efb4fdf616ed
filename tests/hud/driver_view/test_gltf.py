import json
import math
import struct
from typing import Any

import numpy as np
import pytest

from simconsole.hud.driver_view.camera import rotation
from simconsole.hud.driver_view.gltf import Node, glb
from simconsole.hud.driver_view.mesh import Box, Material, box, joined, quads

SQUARE = np.array([((0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.0, 1.0, 0.0), (0.0, 1.0, 0.0))])
BOX = box(Box(1.0, 2.0, 3.0, 0.5, 0.4, 0.3), (200, 0, 0), roof=(0, 0, 200))


def read(data: bytes) -> tuple[dict[str, Any], bytes]:
    """JSON and binary chunk of a file, as the specification lays it out (glTF 2.0, 4)."""
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert (kind, size % 4) == (b"JSON", 0)
    content = json.loads(data[20 : 20 + size])
    if 20 + size == length:
        return content, b""
    rest, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert (kind, rest % 4, 28 + size + rest) == (b"BIN\0", 0, length)
    return content, data[28 + size :]


def triangles(content: dict[str, Any], binary: bytes, mesh: int) -> np.ndarray[Any, Any]:
    """Corners [N, 3, 3] of a mesh, as a reader finds them."""

    def values(accessor: int) -> np.ndarray[Any, Any]:
        found = content["accessors"][accessor]
        view = content["bufferViews"][found["bufferView"]]
        kind = {5123: "<u2", 5125: "<u4", 5126: "<f4"}[found["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3}[found["type"]]
        assert view["byteOffset"] % 4 == 0
        return np.frombuffer(binary, kind, found["count"] * width, view["byteOffset"]).reshape(-1, width)

    parts = content["meshes"][mesh]["primitives"]
    return np.concatenate(
        [
            values(part["attributes"]["POSITION"])[values(part["indices"]).reshape(-1)].reshape(-1, 3, 3)
            for part in parts
        ]
    )


def test_a_reader_finds_every_triangle_with_its_turn() -> None:
    content, binary = read(glb("map", [Node("box", BOX)]))
    found = triangles(content, binary, 0)
    there = BOX["position"].reshape(-1, 3, 3)

    def turned(corners: np.ndarray[Any, Any]) -> set[bytes]:
        return {np.roll(one, -int(np.lexsort(one.T)[0]), axis=0).tobytes() for one in corners}

    assert turned(found) == turned(there)
    assert len(found) == len(there)
    bounds = [content["accessors"][part["attributes"]["POSITION"]] for part in content["meshes"][0]["primitives"]]
    assert np.min([one["min"] for one in bounds], axis=0) == pytest.approx(there.reshape(-1, 3).min(axis=0))
    assert np.max([one["max"] for one in bounds], axis=0) == pytest.approx(there.reshape(-1, 3).max(axis=0))
    assert content["buffers"] == [{"byteLength": len(binary)}]


def test_the_root_makes_y_point_up_and_nodes_keep_name_place_and_extras() -> None:
    content, _ = read(
        glb("map", [Node("flat", quads(SQUARE, (9, 9, 9)), (1.0, 2.0, 3.0), {"layer": 2})], {"length_m": 4})
    )
    (root,) = content["scenes"][0]["nodes"]
    assert content["nodes"][root]["name"] == "map"
    assert content["nodes"][root]["extras"] == {"length_m": 4}
    x, _, _, w = content["nodes"][root]["rotation"]
    up = rotation(0.0, 0.0, 2.0 * math.atan2(x, w)) @ np.array((0.0, 0.0, 1.0))
    assert up == pytest.approx((0.0, 1.0, 0.0))
    (child,) = content["nodes"][root]["children"]
    assert content["nodes"][child] == {"name": "flat", "mesh": 0, "translation": [1, 2, 3], "extras": {"layer": 2}}


def test_each_colour_is_a_material_in_linear_light_and_lamps_shine() -> None:
    lamp = quads(SQUARE, (255, 0, 128), Material.GLOWING)
    content, _ = read(glb("map", [Node("a", joined([BOX, lamp])), Node("b", BOX)]))
    names = {
        (one["name"], *np.round(one["pbrMetallicRoughness"]["baseColorFactor"], 3)) for one in content["materials"]
    }
    assert names == {("plain", 0.578, 0, 0, 1), ("plain", 0, 0, 0.578, 1), ("glowing", 1, 0, 0.216, 1)}
    glowing = [one for one in content["materials"] if "emissiveFactor" in one]
    assert [one["name"] for one in glowing] == ["glowing"]


def test_equal_meshes_are_in_the_file_once_and_empty_nodes_have_none() -> None:
    content, _ = read(glb("base_link", [Node("one", BOX), Node("two", BOX, (1.0, 0.0, 0.0)), Node("eye", BOX[:0])]))
    assert [node.get("mesh") for node in content["nodes"]] == [0, 0, None, None]
    assert len(content["meshes"]) == 1
    nothing, binary = read(glb("map", []))
    assert binary == b""
    assert {"meshes", "buffers", "accessors"}.isdisjoint(nothing)


def test_many_corners_get_wide_indices() -> None:
    steps = np.arange(25_000)[:, None, None] * np.array((3.0, 0.0, 0.0))
    content, binary = read(glb("map", [Node("long", quads(SQUARE + steps, (9, 9, 9)))]))
    found = triangles(content, binary, 0)
    assert len(found) == 50_000
    assert found[:, :, 0].max() == 74_999.0
