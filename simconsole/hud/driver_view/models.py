"""The scene for a renderer of another program: two glTF models, and the frames that move in them."""

import math
from typing import Any, Final, NamedTuple

from simconsole.hud.driver_view.gltf import Node, Place, glb
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.scene import Part, world_parts
from simconsole.hud.driver_view.vehicle_body import WHEEL_RADIUS_M, Size, VehicleMeshes, vehicle_meshes
from simconsole.world.drawing import Drawing

MAP: Final = "map"
BASE: Final = "base_link"
HAND_WHEEL: Final = "hand_wheel"
WHEELS: Final = ("front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel")


class Frame(NamedTuple):
    """Where something is that moves, in the frame of its parent."""

    parent: str
    name: str
    place_m: Place
    turn_rad: Place  # roll, pitch, yaw: about z by yaw, then about the new y by pitch, then about the new x by roll


def world_model(drawing: Drawing | None, limit_kmh: float) -> bytes:
    """Return all that stands still, a node for each kind of thing; flat ones say in which layer they lie."""
    nodes = [Node(part.name, part.mesh, extras=_extras(part)) for part in world_parts(drawing, limit_kmh)]
    return glb(MAP, nodes)


def _extras(part: Part) -> dict[str, Any]:
    """Return what a renderer must know of a part beside its shape: its layer, or the link of a signal that it shows."""
    if part.signal is not None:
        return {"signal": part.signal[0], "link": part.signal[1]}
    return {} if part.layer is None else {"layer": part.layer}


def vehicle_model(size: Size) -> bytes:
    """Return the driven vehicle; what moves in it has its origin where its frame has it, and that frame's name."""
    meshes = vehicle_meshes(size)
    nodes = [Node("body", meshes.body), Node("driver_eye", meshes.body[:0], size.eye_m)]
    if not size.is_ball:
        wheel = meshes.wheel.copy()
        wheel["position"][:, 2] -= WHEEL_RADIUS_M
        nodes += [
            Node(name, wheel, (x_m, y_m, WHEEL_RADIUS_M))
            for name, (x_m, y_m) in zip(WHEELS, meshes.wheel_places, strict=True)
        ]
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
    if not meshes.wheel_places:
        return frames
    roll_rad = math.remainder(shown.distance_m / WHEEL_RADIUS_M, math.tau)
    for index, (name, (x_m, y_m)) in enumerate(zip(WHEELS, meshes.wheel_places, strict=True)):
        steer_rad = shown.road_wheel_rad if index < 2 else 0.0
        frames.append(Frame(BASE, name, (x_m, y_m, WHEEL_RADIUS_M), (0.0, roll_rad, steer_rad)))
    turn_rad = (-shown.road_wheel_rad * ratio, meshes.hand_wheel_tilt_rad, 0.0)
    return [*frames, Frame(BASE, HAND_WHEEL, meshes.hand_wheel_place, turn_rad)]
