"""The scene for a renderer of another program: two glTF models, and the frames that move in them."""

import math
from typing import Any, Final, NamedTuple

from simconsole.hud.driver_view.gltf import Node, Place, glb
from simconsole.hud.driver_view.mesh import Vertices
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.scene import NO_MESH, Part, world_parts
from simconsole.hud.driver_view.surroundings import Limits
from simconsole.hud.driver_view.vehicle_body import Size, VehicleMeshes, vehicle_meshes
from simconsole.world.drawing import Drawing

MAP: Final = "map"
BASE: Final = "base_link"
HAND_WHEEL: Final = "hand_wheel"
WHEELS: Final = ("front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel")
ROBOT_WHEELS: Final = ("left_wheel", "right_wheel")


class Frame(NamedTuple):
    """Where something is that moves, in the frame of its parent."""

    parent: str
    name: str
    place_m: Place
    turn_rad: Place  # roll, pitch, yaw: about z by yaw, then about the new y by pitch, then about the new x by roll


def world_model(drawing: Drawing | None, limits: Limits, models: Vertices = NO_MESH) -> bytes:
    """Return all that stands still, a node for each kind of thing; flat ones say in which layer they lie."""
    nodes = [Node(part.name, part.mesh, extras=_extras(part)) for part in world_parts(drawing, limits, models)]
    return glb(MAP, nodes)


def _extras(part: Part) -> dict[str, Any]:
    """Return what a renderer must know of a part beside its shape: its layer, or the link of a signal that it shows."""
    if part.signal is not None:
        return {"signal": part.signal[0], "link": part.signal[1]}
    return {} if part.layer is None else {"layer": part.layer}


def vehicle_model(size: Size, body: Vertices = NO_MESH) -> bytes:
    """Return the driven vehicle; what moves in it has its origin where its frame has it, and that frame's name.

    Args:
        size: Its outer size.
        body: Its body where a lab has brought one.
    """
    meshes = vehicle_meshes(size)
    nodes = [Node("body", body if len(body) else meshes.body), Node("driver_eye", meshes.body[:0], size.eye_m)]
    wheel, radius_m = meshes.wheel.copy(), meshes.wheel_radius_m
    wheel["position"][:, 2] -= radius_m
    nodes += [Node(name, wheel, (x_m, y_m, radius_m)) for name, (x_m, y_m) in _wheels(meshes)]
    if size.has_seat:
        nodes += [
            Node(HAND_WHEEL, meshes.hand_wheel, meshes.hand_wheel_place),
            Node("bonnet", meshes.bonnet),
            Node("brake_lamps", meshes.brake_lamps),
            Node("left_indicators", meshes.left_indicators),
            Node("right_indicators", meshes.right_indicators),
        ]
    return glb(BASE, nodes, size._asdict())


def moving_frames(meshes: VehicleMeshes, ratio: float, shown: ShownVehicle) -> list[Frame]:
    """Return the vehicle and what turns on it.

    Args:
        meshes: Where its wheels are.
        ratio: Hand-wheel angle per road-wheel angle.
        shown: Where it is.
    """
    place_m = (shown.x_m, shown.y_m, shown.z_m)
    frames = [Frame(MAP, BASE, place_m, (shown.roll_rad, shown.pitch_rad, shown.yaw_rad))]
    radius_m = meshes.wheel_radius_m
    roll_rad = math.remainder(shown.distance_m / radius_m, math.tau)
    for index, (name, (x_m, y_m)) in enumerate(_wheels(meshes)):
        steer_rad = shown.road_wheel_rad if meshes.steers(index) else 0.0
        frames.append(Frame(BASE, name, (x_m, y_m, radius_m), (0.0, roll_rad, steer_rad)))
    if len(meshes.hand_wheel) == 0:
        return frames
    turn_rad = (-shown.road_wheel_rad * ratio, meshes.hand_wheel_tilt_rad, 0.0)
    return [*frames, Frame(BASE, HAND_WHEEL, meshes.hand_wheel_place, turn_rad)]


def _wheels(meshes: VehicleMeshes) -> list[tuple[str, tuple[float, float]]]:
    """Return each wheel's name and place."""
    names = WHEELS if len(meshes.wheel_places) > len(ROBOT_WHEELS) else ROBOT_WHEELS
    return list(zip(names, meshes.wheel_places, strict=False))
