"""Draws a scene: sky, flat layers from the ground up, what has height, the vehicle; into any framebuffer."""

import math
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.hud.driver_view.camera import Camera, rotation
from simconsole.hud.driver_view.light import Light, reach_m, shadow_matrix
from simconsole.hud.driver_view.mesh import Vertices, indexed
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.other_people import person, person_model
from simconsole.hud.driver_view.other_vehicles import bodies, is_robot, meshes, model, paint_of, robot
from simconsole.hud.driver_view.scene import Pieces, ViewScene, in_sight, lit_lamps
from simconsole.hud.driver_view.views import Look
from simconsole.hud.gl.programs import (
    SHADOW_FRAGMENT,
    SHADOW_VERTEX,
    SKY_FRAGMENT,
    SKY_VERTEX,
    SURFACE_FRAGMENT,
    SURFACE_VERTEX,
    variant,
)
from simconsole.world.rules.lamps import Lamps
from simconsole.world.traffic.road_users import RoadUser, RoadUserKind

if TYPE_CHECKING:
    import moderngl

Array = NDArray[np.float64]

SHADOW_PX: Final = 2048
SHADOW_HALF_M: Final = 70.0
SHADOW_AHEAD_M: Final = 45.0
LAYER_SLOPE: Final = 1.0
LAYER_STEPS: Final = 8.0
FRAME: Final = 0.004  # of the window's width
FRAME_COLOUR: Final = (0.07, 0.07, 0.08)
NIGHT_FRAME_COLOUR: Final = (0.26, 0.26, 0.28)
"""A dark rim would not be told from the night around it."""
WHEELS_M: Final = 80.0
"""Nobody sees the wheels of other vehicles that are further away."""
LAMPS_M: Final = 400.0
"""A lamp of a traffic light further away than this is less than a third of a pixel."""
BLINK_S: Final = 0.67
"""Period of the indicators (UN R48: 60 to 120 a minute)."""


class Quality(NamedTuple):
    """What a picture costs."""

    shadows: bool = False
    detail: bool = False


class _Drawn(NamedTuple):
    """A mesh on the card."""

    surface: "moderngl.VertexArray"
    shadow: "moderngl.VertexArray | None"
    length: int


class Renderer:
    """One scene on one context. Light and quality are fixed when it is made."""

    def __init__(
        self, context: "moderngl.Context", scene: ViewScene, light: Light, quality: Quality, ratio: float
    ) -> None:
        """Put the scene on the card.

        Args:
            context: OpenGL 3.3 or later.
            scene: What there is.
            light: Day or night.
            quality: What a picture may cost.
            ratio: Hand-wheel angle per road-wheel angle.
        """
        import moderngl

        self._context, self._scene, self._light, self._quality, self._ratio = context, scene, light, quality, ratio
        self._surface = context.program(
            vertex_shader=variant(SURFACE_VERTEX, shadows=quality.shadows, detail=quality.detail),
            fragment_shader=variant(SURFACE_FRAGMENT, shadows=quality.shadows, detail=quality.detail),
        )
        self._sky = context.program(vertex_shader=SKY_VERTEX, fragment_shader=SKY_FRAGMENT)
        self._shadow = context.program(vertex_shader=SHADOW_VERTEX, fragment_shader=SHADOW_FRAGMENT)
        for name in ("sun", "sun_light", "sky_light", "fog", "fog_per_m", "night"):
            _set(self._surface, name, getattr(light, name))
        for name in ("sun", "horizon", "zenith", "night"):
            _set(self._sky, name, getattr(light, name))
        corners = np.array(((-1.0, -1.0), (3.0, -1.0), (-1.0, 3.0)), dtype="<f4")
        self._backdrop = context.vertex_array(self._sky, [(context.buffer(corners.tobytes()), "2f4", "in_place")])
        self._layers = [self._put(layer.vertices) for layer in scene.layers]
        self._solids = self._put(scene.solids.vertices)
        vehicle = scene.vehicle
        self._body, self._wheel = self._put(vehicle.body), self._put(vehicle.wheel)
        self._bonnet, self._hand_wheel = self._put(vehicle.bonnet), self._put(vehicle.hand_wheel)
        self._brake_lamps = self._put(vehicle.brake_lamps)
        self._indicators = (self._put(vehicle.left_indicators), self._put(vehicle.right_indicators))
        self._lamps = Lamps(scene.lights)
        self._lights = np.array([light[:3] for light in scene.lights]).reshape(-1, 3)
        self._lit_lamps = tuple(self._put(lamp) for lamp in lit_lamps())
        other = meshes()
        self._other_bodies, self._other_wheel, self._other_wheels = (
            [self._put(body) for body in bodies()],
            self._put(other.wheel),
            other.wheel_places,
        )
        self._other_indicators = (self._put(other.left_indicators), self._put(other.right_indicators))
        self._person, self._robot = self._put(person()), self._put(robot())
        self._map: moderngl.Framebuffer | None = None
        if quality.shadows:
            depth = context.depth_texture((SHADOW_PX, SHADOW_PX))
            depth.compare_func, depth.repeat_x, depth.repeat_y = "<=", False, False
            depth.filter = (moderngl.LINEAR, moderngl.LINEAR)
            self._depth = depth
            self._map = context.framebuffer(depth_attachment=depth)

    def draw(self, target: "moderngl.Framebuffer", looks: list[Look], shown: ShownVehicle) -> None:
        """Draw all pictures of one frame."""
        import moderngl

        context = self._context
        pose = _pose(shown)
        context.enable_only(moderngl.DEPTH_TEST)
        if self._map is not None:
            self._draw_shadows(shown, pose)
        target.use()
        width, height = target.size
        for look in looks:
            place = look.viewport.pixels(width, height)
            if look.is_mirror:
                _frame(target, place, NIGHT_FRAME_COLOUR if self._light.night else FRAME_COLOUR)
            target.viewport = target.scissor = place
            target.clear(depth=1.0)
            self._draw_look(look, shown, pose)
        target.viewport = target.scissor = (0, 0, width, height)

    def _draw_look(self, look: Look, shown: ShownVehicle, pose: Array) -> None:
        context, camera, light = self._context, look.camera, self._light
        projection = look.lens.projection()
        view_projection = projection @ camera.view(np.zeros(3))
        self._set_light(camera, pose)
        _set(self._surface, "view_projection", _bytes(view_projection))
        self._set_model(np.eye(4))
        reach = reach_m(light)
        for height, (layer, part) in enumerate(zip(self._layers, self._scene.layers, strict=True)):
            # Layers lie in one plane: each counts as a little nearer than the one below it, at any slope and distance.
            context.polygon_offset = (-LAYER_SLOPE * height, -LAYER_STEPS * height)
            self._draw_runs(layer, part, view_projection, reach, camera)
        context.polygon_offset = (0.0, 0.0)
        self._draw_runs(self._solids, self._scene.solids, view_projection, reach, camera)
        self._draw_lamps(shown, camera)
        self._draw_others(shown, camera, reach)
        if look.from_seat:
            if look.shows_vehicle and not look.is_mirror:
                self._draw_inside(shown, pose)
        else:
            self._draw_outside(shown, pose)
        self._draw_sky(camera, projection)

    def _draw_runs(self, mesh: _Drawn, part: Pieces, view_projection: Array, reach: float, camera: Camera) -> None:
        for first, count in in_sight(part, view_projection, reach, camera.eye):
            mesh.surface.render(vertices=count, first=first)

    def _draw_inside(self, shown: ShownVehicle, pose: Array) -> None:
        vehicle = self._scene.vehicle
        self._draw_mesh(self._bonnet, pose)
        turn, tilt = shown.road_wheel_rad * self._ratio, vehicle.hand_wheel_tilt_rad
        placed = _transform(rotation(0.0, tilt) @ rotation(0.0, 0.0, -turn), np.array(vehicle.hand_wheel_place))
        self._draw_mesh(self._hand_wheel, pose @ placed)

    def _draw_outside(self, shown: ShownVehicle, pose: Array) -> None:
        self._draw_mesh(self._body, pose)
        vehicle = self._scene.vehicle
        up = np.array((0.0, 0.0, vehicle.wheel_radius_m))
        roll = shown.distance_m / vehicle.wheel_radius_m
        for index, (x, y) in enumerate(vehicle.wheel_places):
            steer = shown.road_wheel_rad if vehicle.steers(index) else 0.0
            hub = _transform(rotation(steer, math.remainder(roll, math.tau)), np.array((x, y, 0.0)) + up)
            self._draw_mesh(self._wheel, pose @ hub @ _transform(np.eye(3), -up))
        if shown.brake > 0.0:
            self._draw_mesh(self._brake_lamps, pose)
        for side in (1.0, -1.0) if shown.hazard_lights > 0.0 else (shown.turn_indicators,):
            self._draw_indicators(self._indicators, shown, side, pose)

    def _draw_indicators(self, lamps: tuple[_Drawn, _Drawn], shown: ShownVehicle, side: float, pose: Array) -> None:
        """Draw the indicators of one side, 1 left or -1 right, of a vehicle while they are lit."""
        if side and shown.t_s % BLINK_S < 0.5 * BLINK_S:
            self._draw_mesh(lamps[0 if side > 0.0 else 1], pose)

    def _draw_lamps(self, shown: ShownVehicle, camera: Camera) -> None:
        """Draw the lamps that shine and face the camera over those that are there unlit."""
        away = self._lights[:, :2] - camera.eye[:2]
        yaw = self._lights[:, 2]
        seen = (away @ camera.axes[:2, 0] > 0.0) & (np.hypot(*away.T) < LAMPS_M)
        seen &= away[:, 0] * np.cos(yaw) + away[:, 1] * np.sin(yaw) > 0.0
        if not seen.any():
            return
        for place, lamp in self._lamps.lit(shown.tick, shown.tick_hz, shown.signals):
            if seen[place]:
                light = self._scene.lights[place]
                at = np.array((light.x_m, light.y_m, self._scene.height_m(light.x_m, light.y_m)))
                self._draw_mesh(self._lit_lamps[lamp], _transform(rotation(light.yaw_rad), at))

    def _draw_others(self, shown: ShownVehicle, camera: Camera, reach: float) -> None:
        for user in shown.others:
            away = math.hypot(user.x_m - camera.eye[0], user.y_m - camera.eye[1])
            if away > reach:
                continue
            body, place = self._other(user)
            self._draw_mesh(body, place)
            if body is self._person or body is self._robot:
                continue
            self._draw_indicators(self._other_indicators, shown, user.turn_indicators, place)
            for x, y in self._other_wheels if away < WHEELS_M else ():
                self._draw_mesh(self._other_wheel, place @ _transform(np.eye(3), np.array((x, y, 0.0))))

    def _other(self, user: RoadUser) -> tuple[_Drawn, Array]:
        """Return the mesh that stands for a road user, and where it stands."""
        on_foot = user.kind == RoadUserKind.PEDESTRIAN
        place = person_model(user) if on_foot else model(user)
        place[2, 3] += self._scene.height_m(user.x_m, user.y_m)
        if on_foot:
            return self._person, place
        return self._robot if is_robot(user) else self._other_bodies[paint_of(user)], place

    def _draw_mesh(self, mesh: _Drawn, model: Array) -> None:
        if mesh.length:
            self._set_model(model)
            mesh.surface.render(vertices=mesh.length)

    def _draw_sky(self, camera: Camera, projection: Array) -> None:
        rotated = np.eye(4)
        rotated[:3, :3] = camera.view(np.zeros(3))[:3, :3]
        _set(self._sky, "from_clip", _bytes(np.linalg.inv(projection @ rotated)))
        self._backdrop.render()

    def _draw_shadows(self, shown: ShownVehicle, pose: Array) -> None:
        assert self._map is not None
        scale = self._scene.size.scale  # a robot's map covers less, so that the robot is more than a spot in it
        half_m = scale * SHADOW_HALF_M
        centre = pose @ np.array((scale * SHADOW_AHEAD_M, 0.0, 0.0, 1.0))
        matrix = shadow_matrix(self._light, centre[:3], half_m)
        self._map.use()
        self._map.clear(depth=1.0)
        _set(self._shadow, "to_shadow", _bytes(matrix))
        _set(self._shadow, "model", _bytes(np.eye(4)))
        part = self._scene.solids
        near = np.linalg.norm(part.centre - centre[:3], axis=1) - part.radius < 2.0 * half_m
        if self._solids.shadow is not None:
            for index in np.flatnonzero(near).tolist():
                self._solids.shadow.render(vertices=int(part.length[index]), first=int(part.first[index]))
        near_users = [u for u in shown.others if math.hypot(u.x_m - centre[0], u.y_m - centre[1]) < 2.0 * half_m]
        for mesh, place in ((self._body, pose), *(self._other(user) for user in near_users)):
            if mesh.shadow is not None:
                _set(self._shadow, "model", _bytes(place))
                mesh.shadow.render(vertices=mesh.length)
        _set(self._surface, "to_shadow", _bytes(matrix))
        self._depth.use(0)

    def _set_light(self, camera: Camera, pose: Array) -> None:
        _set(self._surface, "eye", tuple(camera.eye.tolist()))
        if self._light.night > 0.0:
            place = (pose @ np.array((self._scene.size.front_m, 0.0, 0.62, 1.0)))[:3]
            _set(self._surface, "lamp_place", tuple(place.tolist()))
            _set(self._surface, "lamp_axes", _bytes(pose[:3, :3]))

    def _set_model(self, model: Array) -> None:
        _set(self._surface, "model", _bytes(model))

    def _put(self, mesh: Vertices) -> _Drawn:
        """Put a mesh on the card."""
        if len(mesh) == 0:
            return _Drawn(None, None, 0)  # type: ignore[arg-type]
        corners, indices = (self._context.buffer(part.tobytes()) for part in indexed(mesh))
        content = [(corners, "3f4 4f1 4f1", "in_position", "in_normal", "in_colour")]
        surface = self._context.vertex_array(self._surface, content, indices)
        shadow = None
        if self._quality.shadows:
            shadow = self._context.vertex_array(self._shadow, [(corners, "3f4 8x1", "in_position")], indices)
        return _Drawn(surface, shadow, len(mesh))


def _frame(
    target: "moderngl.Framebuffer", place: tuple[int, int, int, int], colour: tuple[float, float, float]
) -> None:
    """Paint what a mirror stands in: a rim around its place."""
    left, bottom, width, height = place
    rim = max(2, round(FRAME * target.width))
    right, top = min(target.width, left + width + rim), min(target.height, bottom + height + rim)
    left, bottom = max(0, left - rim), max(0, bottom - rim)
    target.scissor = (left, bottom, right - left, top - bottom)
    target.clear(*colour)


def _pose(shown: ShownVehicle) -> Array:
    axes = rotation(shown.yaw_rad, shown.pitch_rad, shown.roll_rad)
    return _transform(axes, np.array((shown.x_m, shown.y_m, shown.z_m)))


def _transform(axes: Array, place: Array) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = axes, place
    return matrix


def _set(program: "moderngl.Program", name: str, value: bytes | float | tuple[float, ...]) -> None:
    """Give a program's uniform a value; a matrix comes as bytes."""
    import moderngl

    uniform = program[name]
    assert isinstance(uniform, moderngl.Uniform)
    if isinstance(value, bytes):
        uniform.write(value)
    else:
        uniform.value = value


def _bytes(matrix: NDArray[np.floating[Any]]) -> bytes:
    """Return a matrix as OpenGL wants it: columns first, single precision."""
    return matrix.T.astype("<f4").tobytes()
