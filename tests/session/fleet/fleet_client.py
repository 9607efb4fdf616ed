"""A controller of three robots over one WebSocket: each drives as its list of speeds says, one after each odometry."""

import math
from collections import Counter
from collections.abc import Sequence
from typing import Any

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.values.errors import BridgeError
from tests.patience import PATIENCE_S

NAMES = ("tb3_0", "tb3_1", "tb3_2")


class FleetClient:
    """What it heard, by topic, and how it commanded."""

    def __init__(self, url: str, speeds: Sequence[tuple[float, float]], names: Sequence[str] = NAMES) -> None:
        self.heard: Counter[str] = Counter()
        self.last: dict[str, Any] = {}
        self.scans: list[Any] = []  # of the first robot
        self.frames: set[str] = set()
        self._url, self._names = url, names
        self._speeds = dict(zip(names, speeds, strict=True))

    def run(self) -> None:
        """Drive until the server says good-bye."""
        with BridgeClient(self._url, until_good_bye=True, dead_after_s=math.inf) as client:
            client.subscribe("/tf", "tf2_msgs/TFMessage", queue_length=100)
            client.subscribe("/tf_static", "tf2_msgs/TFMessage", queue_length=100)
            client.subscribe("/clock", "rosgraph_msgs/Clock", queue_length=100)
            for name in self._names:
                client.advertise(f"/{name}/cmd_vel", "geometry_msgs/Twist")
                client.advertise(f"/{name}/console/request", "std_msgs/String")
                client.subscribe(f"/{name}/console/mode", "std_msgs/String")
                client.subscribe(f"/{name}/scan", "sensor_msgs/LaserScan", queue_length=5)
                client.subscribe(f"/{name}/odom", "nav_msgs/Odometry", queue_length=5)
            client.connect(PATIENCE_S)
            try:
                while True:
                    received = client.receive(0.25)
                    if received is not None:
                        self._take(client, *received)
            except BridgeError:
                return

    def _take(self, client: BridgeClient, topic: str, message: Any) -> None:
        self.heard[topic] += 1
        self.last[topic] = message
        if topic in ("/tf", "/tf_static"):
            self.frames.update(one.child_frame_id for one in message.transforms)
        name = topic.split("/")[1]
        if topic == f"/{self._names[0]}/scan":
            self.scans.append(message)
        if not topic.endswith("/odom"):
            return
        if self.heard[topic] % 10 == 0 and self.last[f"/{name}/console/mode"].data != "AUTONOMOUS":
            client.publish(f"/{name}/console/request", {"data": "autonomous"})
        speed, turn = self._speeds[name]
        linear, angular = {"x": speed, "y": 0.0, "z": 0.0}, {"x": 0.0, "y": 0.0, "z": turn}
        client.publish(f"/{name}/cmd_vel", {"linear": linear, "angular": angular})
