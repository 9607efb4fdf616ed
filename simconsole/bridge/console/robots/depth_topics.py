"""The topics of a robot's depth camera, under the names that nav2's TurtleBot3 Waffle has in Gazebo (docs/robots.md).

They are off until the session gives them a rate (`outputs.bridge.rates_hz`): a picture is some 100 kB in JSON.
"""

from typing import Any, Final

import numpy as np

from simconsole.bridge.console.camera_topics import camera_info
from simconsole.bridge.console.published_tick import OutputTopic, PublishedTick, prefixed
from simconsole.bridge.messages import Registry
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.layout import read
from simconsole.values.platform import Pose
from simconsole.vehicle.turtlebot.robot_state import ROBOT, others_of
from simconsole.world.arena.depth_camera import DepthCamera, Image

DEPTH_IMAGE: Final = "/intel_realsense_r200_depth/depth/image_raw"
DEPTH_INFO: Final = "/intel_realsense_r200_depth/depth/camera_info"
POINTS: Final = "/intel_realsense_r200_depth/points"
OPTICAL_FRAME: Final = "camera_depth_optical_frame"
"""Axes as REP 103 has them for pictures: x to the right, y down, z into the picture."""
OFF: Final = 0.0
_FLOAT_BYTES: Final = 4
_FLOAT32: Final = 7  # sensor_msgs/PointField


class DepthTopics:
    """Builds the messages of one robot's depth camera."""

    def __init__(self, registry: Registry, bridge: BridgeProfile, camera: DepthCamera) -> None:
        """Generate the classes of all topics."""
        self._camera = camera
        self._frame = prefixed(bridge.namespace, OPTICAL_FRAME)
        self._info, self._image, self._cloud, self._field = (
            registry.struct(f"sensor_msgs/{name}") for name in ("CameraInfo", "Image", "PointCloud2", "PointField")
        )

    def topics(self) -> tuple[OutputTopic, ...]:
        """Return the rows of the table of output topics: what explains a picture comes before it."""
        return (
            OutputTopic(DEPTH_INFO, "sensor_msgs/CameraInfo", OFF, self._told_info, measured=True),
            OutputTopic(DEPTH_IMAGE, "sensor_msgs/Image", OFF, self._told_image, measured=True),
            OutputTopic(POINTS, "sensor_msgs/PointCloud2", OFF, self._told_points, measured=True),
        )

    def _seen(self, tick: PublishedTick) -> Image:
        motion, vector = read(tick.snapshot.vector, ROBOT).motion, tick.snapshot.vector
        return self._camera.image(Pose(motion.x_m, motion.y_m, motion.yaw_rad), others_of(vector))

    def _told_info(self, tick: PublishedTick) -> Any:
        return camera_info(self._info, tick.header(self._frame), self._camera.profile)

    def _told_image(self, tick: PublishedTick) -> Any:
        image = self._seen(tick)
        rows, columns = image.shape
        return self._image(
            header=tick.header(self._frame),
            height=rows,
            width=columns,
            encoding="32FC1",
            is_bigendian=0,
            step=_FLOAT_BYTES * columns,
            data=image.astype("<f4").tobytes(),
        )

    def _told_points(self, tick: PublishedTick) -> Any:
        points = self._camera.points(self._seen(tick))
        rows, columns, axes = points.shape
        step = _FLOAT_BYTES * axes
        return self._cloud(
            header=tick.header(self._frame),
            height=rows,
            width=columns,
            fields=[self._field(name, _FLOAT_BYTES * at, _FLOAT32, 1) for at, name in enumerate("xyz")],
            is_bigendian=False,
            point_step=step,
            row_step=step * columns,
            data=points.astype("<f4").tobytes(),
            is_dense=bool(np.isfinite(points).all()),
        )
