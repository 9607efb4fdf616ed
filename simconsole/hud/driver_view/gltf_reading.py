"""Binary glTF 2.0 of a lab's own as meshes for the view: shapes and plain colours (Khronos, glTF 2.0 specification).

What a picture of a road needs is read: nodes with their places, triangles, base colours, what shines by itself.
Textures, animation and skins are passed over. What a file says that it cannot do without is refused by name.
"""

import math
from collections.abc import Iterator
from typing import Annotated, Any, Final

import msgspec
import numpy as np
from msgspec import Meta, Struct
from numpy.typing import NDArray

from simconsole.hud.driver_view.mesh import Array, Colour, Material, Vertices, facets, joined

MOST_TRIANGLES: Final = 2_000_000
MOST_NODES: Final = 20_000
_MAGIC: Final = 0x46546C67
_JSON: Final = 0x4E4F534A
_BINARY: Final = 0x004E4942
_TRIANGLES: Final = 4
_TYPES: Final = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_SHINES: Final = 0.5
Index = Annotated[int, Meta(ge=0)]
Number = Annotated[float, Meta(ge=-1e9, le=1e9)]


class _Node(Struct, frozen=True):
    mesh: Index | None = None
    children: tuple[Index, ...] = ()
    matrix: Annotated[tuple[Number, ...], Meta(min_length=16, max_length=16)] | None = None
    translation: tuple[Number, Number, Number] = (0.0, 0.0, 0.0)
    rotation: tuple[Number, Number, Number, Number] = (0.0, 0.0, 0.0, 1.0)
    scale: tuple[Number, Number, Number] = (1.0, 1.0, 1.0)


class _Primitive(Struct, frozen=True):
    attributes: dict[str, Index]
    indices: Index | None = None
    material: Index | None = None
    mode: int = _TRIANGLES


class _Mesh(Struct, frozen=True):
    primitives: tuple[_Primitive, ...]


class _Surface(Struct, frozen=True, rename="camel"):
    base_color_factor: tuple[Number, Number, Number, Number] = (1.0, 1.0, 1.0, 1.0)


class _Material(Struct, frozen=True, rename="camel"):
    pbr_metallic_roughness: _Surface = _Surface()
    emissive_factor: tuple[Number, Number, Number] = (0.0, 0.0, 0.0)


class _Accessor(Struct, frozen=True, rename="camel"):
    component_type: int
    count: Index
    type: str
    buffer_view: Index | None = None
    byte_offset: Index = 0
    sparse: Any = None


class _View(Struct, frozen=True, rename="camel"):
    buffer: Index
    byte_length: Index
    byte_offset: Index = 0
    byte_stride: Annotated[int, Meta(ge=4, le=252)] | None = None


class _Scene(Struct, frozen=True):
    nodes: tuple[Index, ...] = ()


class _File(Struct, frozen=True, rename="camel"):
    nodes: tuple[_Node, ...] = ()
    meshes: tuple[_Mesh, ...] = ()
    materials: tuple[_Material, ...] = ()
    accessors: tuple[_Accessor, ...] = ()
    buffer_views: tuple[_View, ...] = ()
    scenes: tuple[_Scene, ...] = ()
    scene: Index = 0
    extensions_required: tuple[str, ...] = ()


def read_glb(content: bytes) -> Vertices:
    """Return the triangles of a file's scene, z up: x as in the file, y is the file's -z, z its y; in m.

    Raises:
        ValueError: it is no binary glTF 2.0, is damaged or too large, or needs what is not read here.
    """
    text, binary = _chunks(content)
    try:
        file = msgspec.json.decode(text, type=_File)
        if file.extensions_required:
            raise ValueError(f"it needs {', '.join(file.extensions_required)}")
        roots = file.scenes[file.scene].nodes if file.scenes else ()
        parts, left = [], MOST_TRIANGLES
        for mesh, place in _placed(file, roots):
            for primitive in file.meshes[mesh].primitives:
                if primitive.mode == _TRIANGLES:
                    corners = _corners(file, binary, primitive)
                    left -= len(corners)
                    if left < 0:
                        raise ValueError(f"more than {MOST_TRIANGLES} triangles")
                    parts.append(_drawn(file, primitive, corners @ place[:3, :3].T + place[:3, 3]))
    except msgspec.DecodeError as problem:
        raise ValueError(f"its JSON: {problem}") from None
    except IndexError:
        raise ValueError("it names what it does not have") from None
    return joined(parts)


def _chunks(content: bytes) -> tuple[bytes, bytes]:
    """Return the JSON and the binary chunk of a file."""
    head = np.frombuffer(content[:12].ljust(12, b"\0"), "<u4").tolist()
    if head[0] != _MAGIC or head[1] != 2:
        raise ValueError("no binary glTF 2.0")
    found: dict[int, bytes] = {}
    at = 12
    while at + 8 <= len(content):
        length, kind = np.frombuffer(content[at : at + 8], "<u4").tolist()
        found.setdefault(kind, content[at + 8 : at + 8 + length])
        if len(found[kind]) < length and at + 8 + length > len(content):
            raise ValueError("it ends too early")
        at += 8 + length
    if _JSON not in found:
        raise ValueError("it has no JSON")
    return found[_JSON], found.get(_BINARY, b"")


def _placed(file: _File, roots: tuple[int, ...]) -> Iterator[tuple[int, Array]]:
    """Yield each mesh with where it stands, as a matrix [4, 4] into z-up axes."""
    to_z_up = np.array(((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, -1.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))
    waiting = [(root, to_z_up) for root in roots]
    for _ in range(MOST_NODES):
        if not waiting:
            return
        index, parent = waiting.pop()
        node = file.nodes[index]
        place = parent @ _matrix(node)
        if node.mesh is not None:
            yield node.mesh, place
        if len(node.children) > MOST_NODES - len(waiting):
            break
        waiting += [(child, place) for child in node.children]
    raise ValueError(f"more than {MOST_NODES} nodes, or nodes in a circle")


def _matrix(node: _Node) -> Array:
    if node.matrix is not None:
        return np.array(node.matrix).reshape(4, 4).T
    x, y, z, w = node.rotation
    length = math.sqrt(x * x + y * y + z * z + w * w) or 1.0
    x, y, z, w = x / length, y / length, z / length, w / length
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
    ) * np.array(node.scale)
    matrix[:3, 3] = node.translation
    return matrix


def _corners(file: _File, binary: bytes, primitive: _Primitive) -> Array:
    """Return the corners of a primitive's triangles [N, 3, 3] in the axes of its node."""
    if "POSITION" not in primitive.attributes:
        return np.zeros((0, 3, 3))
    points = _values(file, binary, primitive.attributes["POSITION"], "VEC3").astype(np.float64)
    if not np.isfinite(points).all():
        raise ValueError("a place that is no number")
    if primitive.indices is not None:
        points = points[_values(file, binary, primitive.indices, "SCALAR").reshape(-1)]
    return points[: len(points) // 3 * 3].reshape(-1, 3, 3)


def _values(file: _File, binary: bytes, index: int, shape: str) -> NDArray[Any]:
    """Return an accessor's values [N, 1 or 3]."""
    accessor = file.accessors[index]
    width = 3 if shape == "VEC3" else 1
    kind = _TYPES.get(accessor.component_type)
    wanted = accessor.type == shape and kind is not None and (kind == "<f4") == (shape == "VEC3")
    if not wanted or accessor.buffer_view is None or accessor.sparse is not None:
        raise ValueError(f"accessor {index}: {accessor.type} of {accessor.component_type}, sparse or empty")
    view = file.buffer_views[accessor.buffer_view]
    if view.buffer != 0:
        raise ValueError("a buffer outside the file")
    size = np.dtype(kind).itemsize * width
    stride = view.byte_stride or size
    first = view.byte_offset + accessor.byte_offset
    last = first + (accessor.count - 1) * stride + size if accessor.count else first
    if last > min(len(binary), view.byte_offset + view.byte_length):
        raise ValueError(f"accessor {index}: reaches beyond its buffer")
    return np.ndarray((accessor.count, width), np.dtype(kind), binary, first, (stride, np.dtype(kind).itemsize))


def _drawn(file: _File, primitive: _Primitive, corners: Array) -> Vertices:
    material = _Material() if primitive.material is None else file.materials[primitive.material]
    shines = max(material.emissive_factor) > _SHINES
    linear = material.emissive_factor if shines else material.pbr_metallic_roughness.base_color_factor[:3]
    return facets(corners, _srgb(linear), Material.GLOWING if shines else Material.PLAIN)


def _srgb(linear: tuple[float, ...]) -> Colour:
    """Return linear light as bytes of sRGB (IEC 61966-2-1)."""
    shares = [min(1.0, max(0.0, value)) for value in linear]
    curved = [12.92 * share if share <= 0.0031308 else 1.055 * share ** (1.0 / 2.4) - 0.055 for share in shares]
    red, green, blue = (round(255.0 * share) for share in curved)
    return red, green, blue
