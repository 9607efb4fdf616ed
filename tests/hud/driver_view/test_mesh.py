import math

import numpy as np
import pytest

from simconsole.hud.driver_view.mesh import (
    Box,
    Material,
    Vertices,
    box,
    cone,
    facets,
    indexed,
    left_of,
    prism,
    quads,
    ribbon,
    ring,
    wheel,
)
from tests.samples import Sample

GREY = (120, 120, 120)


def volume_m3(mesh: Vertices) -> float:
    """The volume that a closed mesh holds: positive only when its triangles turn anticlockwise seen from outside."""
    a, b, c = mesh["position"].astype(float).reshape(-1, 3, 3).transpose(1, 0, 2)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def normals(mesh: Vertices) -> np.ndarray:
    return (mesh["normal"][:, :3].astype(float) - 128.0) / 127.0


def test_solids_face_outwards() -> None:
    shut = box(Box(3.0, -2.0, 0.0, 2.0, 1.0, 1.5, 0.4), GREY)  # without its underside, which lies at height 0
    assert volume_m3(shut) == pytest.approx(4.0 * 2.0 * 1.5, rel=1e-5)
    side = prism(np.array(((0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0))), 0.5, -0.5, GREY)
    assert volume_m3(side) == pytest.approx(2.0, rel=1e-5)
    post = cone(0.0, 0.0, (0.0, 3.0), (1.0, 1.0), GREY)
    assert volume_m3(post) == pytest.approx(3.0 * 8.0 * 0.5 * math.sin(math.tau / 8.0), rel=1e-5)
    rim = ring(np.zeros(3), np.array((0.0, -1.0, 0.0)), np.array((0.0, 0.0, 1.0)), (0.2, 0.02), GREY)
    assert abs(volume_m3(rim)) == pytest.approx(2.0 * math.pi**2 * 0.2 * 0.02**2, rel=0.12)
    assert volume_m3(wheel(0.0, 0.0, 0.3, 0.2, GREY, GREY)) > 0.0


def test_normals_are_those_of_the_triangles() -> None:
    mesh = facets(np.array([((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))]), GREY, Material.WALL)
    assert normals(mesh) == pytest.approx(np.array([(0.0, 0.0, 1.0)] * 3), abs=0.01)
    assert mesh["colour"].tolist() == [[*GREY, Material.WALL]] * 3


def test_triangles_without_area_are_left_out() -> None:
    assert len(facets(np.zeros((2, 3, 3)), GREY)) == 0


def test_a_ribbon_faces_up_and_is_as_wide_as_asked_in_a_bend() -> None:
    angles = np.linspace(0.0, 1.0, 40)
    bend = 30.0 * np.column_stack((np.sin(angles), 1.0 - np.cos(angles)))
    strip = ribbon(bend, -0.06, 0.06, 0.0, GREY, Material.PLAIN)
    assert (normals(strip)[:, 2] > 0.99).all()
    distance = np.hypot(strip["position"][:, 0], strip["position"][:, 1] - 30.0)
    assert distance.min() == pytest.approx(29.94, abs=0.002)
    assert distance.max() == pytest.approx(30.06, abs=0.002)


def test_a_line_with_a_repeated_point_has_a_direction_everywhere() -> None:
    across = left_of(np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (2.0, 0.0))))
    assert across == pytest.approx(np.array([(0.0, 1.0)] * 4))


def test_quads_are_two_triangles_each() -> None:
    assert len(quads(np.array([((0.0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))]), GREY)) == 6


def test_indexed_mesh_has_each_corner_once_and_draws_the_same(sample: Sample) -> None:
    corners = np.random.default_rng(sample.seed).integers(0, 3, (200, 3, 3)).astype(float)
    mesh = facets(corners, (10, 20, 30))
    kept, indices = indexed(mesh)
    assert (kept[indices] == mesh).all()
    assert len(kept) == len({vertex.tobytes() for vertex in mesh}) < len(mesh)
    assert (np.diff(np.unique(indices, return_index=True)[1]) > 0).all(), "in the order of the mesh"
