"""Topics for a renderer of another program: what there is, what moves, what the driver reads (docs/engine.md)."""

from collections.abc import Callable, Sequence
from typing import Any, Final, NamedTuple

from simconsole.bridge.console.published_tick import MAP_FRAME, ONCE, OutputTopic, PublishedTick, quaternion
from simconsole.bridge.messages import Registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.state_vector import Snapshot

SCENE: Final = "/view/scene"
POSES: Final = "/view/poses"
HUD: Final = "/view/hud"
VIEW_TOPICS: Final = (SCENE, POSES, HUD)
POSES_HZ: Final = 50.0
HUD_HZ: Final = 20.0

MovingFrame = tuple[str, str, tuple[float, float, float], tuple[float, float, float]]
"""Parent, name, place x, y, z in m, and roll, pitch, yaw in rad (about z, then the new y, then the new x)."""


class Model(NamedTuple):
    """A binary glTF file whose axes, below its root, are those of a frame."""

    frame: str
    filename: str
    content: bytes


class ExternalView(NamedTuple):
    """What such a renderer is told."""

    models: tuple[Model, ...] = ()
    frames: Callable[[Snapshot], Sequence[MovingFrame]] = lambda snapshot: ()
    reading: Callable[[Snapshot], dict[str, Any]] = lambda snapshot: {}
    """The fields of simconsole_msgs/Hud, without its header."""


NO_VIEW: Final = ExternalView()


def view_topics(registry: Registry, profile: BridgeProfile, view: ExternalView = NO_VIEW) -> tuple[OutputTopic, ...]:
    """Return the rows of these topics, none unless the profile has `external_view`."""
    if not profile.external_view:
        return ()
    builder = _Builder(registry, view)
    return (
        OutputTopic(SCENE, "visualization_msgs/MarkerArray", ONCE, builder.scene),
        OutputTopic(POSES, "tf2_msgs/TFMessage", POSES_HZ, builder.poses),
        OutputTopic(HUD, "simconsole_msgs/Hud", HUD_HZ, builder.hud),
    )


class _Builder:
    """Builds the messages of one view."""

    def __init__(self, registry: Registry, view: ExternalView) -> None:
        self._view = view
        self._marker_array = registry.struct("visualization_msgs/MarkerArray")
        self._marker = registry.struct("visualization_msgs/Marker")
        self._mesh_file = registry.struct("visualization_msgs/MeshFile")
        self._tf = registry.struct("tf2_msgs/TFMessage")
        self._transform_stamped = registry.struct("geometry_msgs/TransformStamped")
        self._transform = registry.struct("geometry_msgs/Transform")
        self._vector = registry.struct("geometry_msgs/Vector3")
        self._quaternion = registry.struct("geometry_msgs/Quaternion")
        self._colour = registry.struct("std_msgs/ColorRGBA")
        self._hud = registry.struct("simconsole_msgs/Hud")

    def scene(self, tick: PublishedTick) -> Any:
        return self._marker_array(
            [self._model_marker(tick, number, model) for number, model in enumerate(self._view.models)]
        )

    def _model_marker(self, tick: PublishedTick, number: int, model: Model) -> Any:
        return self._marker(
            header=tick.header(model.frame),
            ns="view",
            id=number,
            type=self._marker.MESH_RESOURCE,
            scale=self._vector(1.0, 1.0, 1.0),
            color=self._colour(1.0, 1.0, 1.0, 1.0),
            frame_locked=model.frame != MAP_FRAME,
            mesh_resource=f"embedded://{model.filename}",
            mesh_file=self._mesh_file(model.filename, model.content),
            mesh_use_embedded_materials=True,
        )

    def poses(self, tick: PublishedTick) -> Any:
        return self._tf(
            [
                self._transform_stamped(
                    tick.header(parent),
                    name,
                    self._transform(self._vector(*place_m), self._quaternion(*quaternion(*turn_rad))),
                )
                for parent, name, place_m, turn_rad in self._view.frames(tick.snapshot)
            ]
        )

    def hud(self, tick: PublishedTick) -> Any:
        return self._hud(header=tick.header(""), **self._view.reading(tick.snapshot))
