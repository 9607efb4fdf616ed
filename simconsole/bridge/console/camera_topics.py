"""The picture of a camera on the vehicle, and what projects points of the world into it, under ROS's usual names."""

from collections.abc import Callable
from typing import Any, Final, NamedTuple, Protocol

from simconsole.bridge.console.published_tick import OutputTopic, PublishedTick, quaternion
from simconsole.bridge.messages import Registry
from simconsole.profiles.bridge import CameraProfile
from simconsole.values.units import NS_PER_S

IMAGE: Final = "/camera/image_raw/compressed"
CAMERA_INFO: Final = "/camera/camera_info"
CAMERA_TOPICS: Final = (IMAGE, CAMERA_INFO)
OPTICAL_FRAME: Final = "camera_optical"
"""Axes as REP 103 has them for pictures: x to the right, y down, z into the picture."""
LOOKED_HZ: Final = 1000.0
"""Each tick asks for a new picture; how often there is one is the camera's own rate."""


class CameraShot(NamedTuple):
    """A picture of the camera."""

    tick: int  # that it shows
    jpeg: bytes


class Pinhole(Protocol):
    """A camera without distortion, its axis through the middle of its picture."""

    @property
    def width_px(self) -> int:
        """Of the picture."""

    @property
    def height_px(self) -> int:
        """Of the picture."""

    @property
    def focal_px(self) -> float:
        """Distance of the picture from the pinhole, in pixels."""


ReadCamera = Callable[[], CameraShot | None]
"""Returns the newest picture, None before the first."""


class CameraTopics:
    """Builds the two messages of each picture; `None` while there is no new one."""

    def __init__(self, registry: Registry, profile: CameraProfile, read: ReadCamera) -> None:
        """Generate the classes of all messages."""
        self._read, self._profile = read, profile
        self._time, self._header = registry.struct("builtin_interfaces/Time"), registry.struct("std_msgs/Header")
        self._image, self._info = (
            registry.struct("sensor_msgs/CompressedImage"),
            registry.struct("sensor_msgs/CameraInfo"),
        )
        self._told: dict[str, int] = {}

    def topics(self) -> tuple[OutputTopic, ...]:
        """Return the rows of the table of output topics: what explains a picture comes before it."""
        return (
            OutputTopic(CAMERA_INFO, "sensor_msgs/CameraInfo", LOOKED_HZ, self._camera_info),
            OutputTopic(IMAGE, "sensor_msgs/CompressedImage", LOOKED_HZ, self._compressed_image),
        )

    def _camera_info(self, tick: PublishedTick) -> Any | None:
        shot = self._new(CAMERA_INFO)
        if shot is None:
            return None
        return camera_info(self._info, self._stamped(shot, tick), self._profile)

    def _compressed_image(self, tick: PublishedTick) -> Any | None:
        shot = self._new(IMAGE)
        return None if shot is None else self._image(self._stamped(shot, tick), "jpeg", shot.jpeg)

    def _new(self, topic: str) -> CameraShot | None:
        """Return the newest picture once for each topic."""
        shot = self._read()
        if shot is None or self._told.get(topic) == shot.tick:
            return None
        self._told[topic] = shot.tick
        return shot

    def _stamped(self, shot: CameraShot, tick: PublishedTick) -> Any:
        stamp_ns = shot.tick * NS_PER_S // tick.snapshot.tick_hz
        return self._header(self._time(*divmod(stamp_ns, NS_PER_S)), OPTICAL_FRAME)


def optical(yaw_rad: float, pitch_rad: float) -> tuple[float, float, float, float]:
    """Return x, y, z, w of the turn from the vehicle's axes to the optical frame of a camera turned by these."""
    ax, ay, az, aw = quaternion(0.0, pitch_rad, yaw_rad)
    bx, by, bz, bw = -0.5, 0.5, -0.5, 0.5  # z forwards, x to the right, y down
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def camera_info(message: Callable[..., Any], header: Any, camera: Pinhole) -> Any:
    """Return what projects points into a camera's picture; `message` is the class of sensor_msgs/CameraInfo."""
    focal, cx, cy = camera.focal_px, 0.5 * camera.width_px - 0.5, 0.5 * camera.height_px - 0.5
    return message(
        header=header,
        height=camera.height_px,
        width=camera.width_px,
        distortion_model="plumb_bob",
        d=[0.0] * 5,
        k=[focal, 0.0, cx, 0.0, focal, cy, 0.0, 0.0, 1.0],
        r=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p=[focal, 0.0, cx, 0.0, 0.0, focal, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
    )
