"""What stands still in a scene, in rerun: the world, and the vehicle's own body."""

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from simconsole.scene.entities import (
    ASPHALT,
    BODY,
    GREEN,
    GROUND,
    HEAD_M,
    LAMPS,
    MAP_EDGE,
    PAINT,
    POST_M,
    THEORETICAL,
    WALL,
    Array,
    Dimensions,
    Mesh,
    WorldShapes,
    car_solids,
    on_map,
    raised,
)

MAP: Final = "map"
"""Root of the flat copies: a picture's y axis points down, the map's up, so they have coordinates of their own."""

Still = Callable[..., None]
"""Takes an entity path and what stands there all the time."""


def show_vehicle(still: Still, dimensions: Dimensions) -> None:
    """Show the vehicle's body in its own frame."""
    import rerun as rr

    if dimensions.is_ball:
        half = 0.5 * dimensions.height_m
        ball = rr.Ellipsoids3D(centers=[(0.0, 0.0, half)], half_sizes=[(half,) * 3], colors=[BODY], fill_mode="solid")
        still("world/ego/body", ball)
        return
    solids = car_solids(dimensions)
    still(
        "world/ego/body",
        rr.Boxes3D(
            centers=[solid.centre for solid in solids],
            half_sizes=[solid.half_size for solid in solids],
            colors=[solid.colour for solid in solids],
            fill_mode="solid",
        ),
    )


def show_world(still: Still, world: WorldShapes) -> None:
    """Show the world, in 3D and on the map."""
    for name, mesh, colour in (
        ("ground", world.ground, GROUND),
        ("surface", world.surfaces, ASPHALT),
        ("island", world.islands, GREEN),
        ("paint", world.paint, PAINT),
        ("walls", world.walls, WALL),
    ):
        _mesh(still, f"world/road/{name}", mesh, colour)
    still("world/road/edges", _strips3d(world.edges, PAINT, 0.07))
    still("world/road/centre", _strips3d(world.centre_dashes, PAINT, 0.07))
    still("world/path/theoretical", _strips3d((world.path,), THEORETICAL, 0.12))
    _flat(still, "road/edges", (*world.edges, *world.wall_lines), MAP_EDGE, 0.5, 0.0)
    _flat(still, "path/theoretical", (world.path,), THEORETICAL, 3.0, 1.0)
    _lights(still, world)


def _mesh(still: Still, path: str, mesh: Mesh, colour: tuple[int, int, int]) -> None:
    import rerun as rr

    if len(mesh.triangles):
        up = np.tile((0.0, 0.0, 1.0), (len(mesh.vertices), 1))
        shape = rr.Mesh3D(
            vertex_positions=mesh.vertices,
            triangle_indices=mesh.triangles,
            vertex_normals=up,
            albedo_factor=colour,
            face_rendering="DoubleSided",
        )
        still(path, shape)


def _flat(
    still: Still, name: str, lines: tuple[Array, ...], colour: tuple[int, int, int], radius_px: float, order: float
) -> None:
    import rerun as rr

    strips = rr.LineStrips2D(
        [on_map(line) for line in lines],
        colors=[colour],
        radii=rr.Radius.ui_points(radius_px),
        draw_order=order,
    )
    still(f"{MAP}/{name}", strips)


def _lights(still: Still, world: WorldShapes) -> None:
    import rerun as rr

    if not len(world.light_posts):
        return
    posts = raised(world.light_posts, 0.5 * POST_M)
    heads = raised(world.light_posts, POST_M)
    count = len(posts)
    still(
        "world/lights/posts",
        rr.Boxes3D(
            centers=np.vstack((posts, heads)),
            half_sizes=[(0.06, 0.06, 0.5 * POST_M)] * count + [(0.17, 0.17, 0.5 * HEAD_M + 0.05)] * count,
            colors=[(70, 76, 84)],
            fill_mode="solid",
        ),
    )
    lamps = world.light_lamps.reshape(-1, 3)
    still("world/lights/lamps", rr.Points3D(lamps, colors=list(LAMPS) * count, radii=[0.11]))
    spots = on_map(world.light_posts)
    still(f"{MAP}/lights", rr.Points2D(spots, colors=[(255, 176, 32)], radii=rr.Radius.ui_points(3.5)))


def _strips3d(lines: tuple[Array, ...], colour: tuple[int, int, int], radius_m: float) -> Any:
    import rerun as rr

    return rr.LineStrips3D(lines, colors=[colour], radii=[radius_m])
