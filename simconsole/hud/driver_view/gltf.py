"""Meshes as binary glTF 2.0, which every engine reads (Khronos, glTF 2.0 specification)."""

import math
from collections.abc import Iterable, Mapping
from typing import Any, Final, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from simconsole.hud.driver_view.mesh import Material, Vertices

Place = tuple[float, float, float]

UP: Final = (-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
"""Quaternion x, y, z, w from the axes of a frame (z up) to those of a glTF file (y up)."""
_MAGIC: Final = 0x46546C67
_JSON: Final = 0x4E4F534A
_BINARY: Final = 0x004E4942
_UINT16, _UINT32, _FLOAT = 5123, 5125, 5126
_ARRAY, _ELEMENTS = 34962, 34963


class Node(NamedTuple):
    """A thing with a name, in the frame of its parent."""

    name: str
    mesh: Vertices
    place_m: Place = (0.0, 0.0, 0.0)
    extras: Mapping[str, Any] = {}


def glb(frame: str, nodes: Iterable[Node], extras: Mapping[str, Any] | None = None) -> bytes:
    """Return a file with one root node named `frame`, whose rotation alone makes y point up, and its children.

    Triangles share corners and have no normals, so that facets stay flat (glTF 2.0, 3.7.2.1). Each colour is a
    material; one that is equal to another node's mesh is in the file once.
    """
    writer = _Writer()
    children = [writer.node(node) for node in nodes]
    root = {"name": frame, "rotation": UP, "children": children, "extras": dict(extras or {})}
    return writer.file(root)


class _Writer:
    """Collects what a file consists of."""

    def __init__(self) -> None:
        self._binary = bytearray()
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._materials: dict[tuple[int, ...], int] = {}
        self._meshes: dict[bytes, int] = {}
        self._primitives: list[list[dict[str, Any]]] = []
        self._nodes: list[dict[str, Any]] = []

    def node(self, node: Node) -> int:
        """Add a node; return its index."""
        made: dict[str, Any] = {"name": node.name}
        if len(node.mesh):
            made["mesh"] = self._mesh(node.mesh)
        if any(node.place_m):
            made["translation"] = node.place_m
        if node.extras:
            made["extras"] = dict(node.extras)
        self._nodes.append(made)
        return len(self._nodes) - 1

    def file(self, root: Mapping[str, Any]) -> bytes:
        """Return the file."""
        content = {
            "asset": {"version": "2.0", "generator": "simconsole"},
            "scene": 0,
            "scenes": [{"nodes": [len(self._nodes)]}],
            "nodes": [*self._nodes, root],
            "meshes": [{"primitives": primitives} for primitives in self._primitives],
            "materials": [_material(colour) for colour in self._materials],
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._binary)}],
        }
        filled = {key: value for key, value in content.items() if value != []}  # glTF has no empty arrays
        if not self._binary:
            del filled["buffers"]
        text = msgspec.json.encode(filled)
        chunks = _chunk(_JSON, text + b" " * (-len(text) % 4))
        if self._binary:
            chunks += _chunk(_BINARY, bytes(self._binary))
        return np.array((_MAGIC, 2, 12 + len(chunks)), "<u4").tobytes() + chunks

    def _mesh(self, mesh: Vertices) -> int:
        key = mesh.tobytes()
        known = self._meshes.get(key)
        if known is None:
            colours, which = np.unique(mesh["colour"][::3], axis=0, return_inverse=True)
            corners = mesh["position"].reshape(-1, 3, 3)
            self._primitives.append(
                [
                    self._primitive(corners[which.reshape(-1) == index], tuple(colour))
                    for index, colour in enumerate(colours.tolist())
                ]
            )
            known = self._meshes[key] = len(self._primitives) - 1
        return known

    def _primitive(self, corners: NDArray[np.float32], colour: tuple[int, ...]) -> dict[str, Any]:
        points, indices = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
        wide = len(points) > 0xFFFF
        position = self._accessor(points.astype("<f4"), _FLOAT, "VEC3", _ARRAY)
        self._accessors[position] |= {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
        flat = indices.reshape(-1).astype("<u4" if wide else "<u2")
        return {
            "attributes": {"POSITION": position},
            "indices": self._accessor(flat, _UINT32 if wide else _UINT16, "SCALAR", _ELEMENTS),
            "material": self._materials.setdefault(colour, len(self._materials)),
        }

    def _accessor(self, values: NDArray[Any], component: int, shape: str, target: int) -> int:
        content = values.tobytes()
        view = {"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(content), "target": target}
        self._views.append(view)
        self._binary += content + b"\0" * (-len(content) % 4)
        self._accessors.append(
            {"bufferView": len(self._views) - 1, "componentType": component, "count": len(values), "type": shape}
        )
        return len(self._accessors) - 1


def _material(colour: tuple[int, ...]) -> dict[str, Any]:
    """Return the material of a vertex's four bytes; glTF wants linear light, bytes are sRGB (IEC 61966-2-1)."""
    shares = [channel / 255.0 for channel in colour[:3]]
    linear = [share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4 for share in shares]
    kind = Material(colour[3])
    made: dict[str, Any] = {
        "name": kind.name.lower(),
        "pbrMetallicRoughness": {"baseColorFactor": [*linear, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0},
    }
    if kind is Material.GLOWING:
        made["emissiveFactor"] = linear
    return made


def _chunk(kind: int, content: bytes) -> bytes:
    return np.array((len(content), kind), "<u4").tobytes() + content
