"""Controllers on the ROS side, as raw JSON over a WebSocket that nobody of this project wrote."""

import json
import socket
import threading
from collections.abc import Callable
from typing import Any

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from tests.patience import wait_until

CONTROL = "/control/command/control_cmd"


def command(stamp: dict[str, int], acceleration: object = 1.2, steering: object = 0.0) -> dict[str, Any]:
    """An autoware_control_msgs/Control as rosbridge carries it."""
    return {
        "op": "publish",
        "topic": CONTROL,
        "msg": {
            "stamp": stamp,
            "lateral": {"stamp": stamp, "steering_tire_angle": steering},
            "longitudinal": {"stamp": stamp, "velocity": 10.0, "acceleration": acceleration},
        },
    }


class Controller(threading.Thread):
    """Answers every odometry by `answer(count, stamp)`, texts to send; None: vanish without a good-bye."""

    def __init__(self, port: int, answer: Callable[[int, dict[str, int]], list[str] | None]) -> None:
        super().__init__(name="controller")
        self._url = f"ws://127.0.0.1:{port}"
        self._answer = answer
        self.statuses: list[dict[str, Any]] = []
        self.odometry = 0
        self.failure: BaseException | None = None

    def run(self) -> None:
        try:
            self._follow(self._connected())
        except ConnectionClosed:
            return
        except BaseException as error:
            self.failure = error
            raise

    def _connected(self) -> ClientConnection:
        def connected() -> ClientConnection | None:
            try:
                return connect(self._url, compression=None, ping_interval=None)
            except OSError:
                return None

        link = wait_until(connected, self._url)
        assert link is not None
        return link

    def _follow(self, link: ClientConnection) -> None:
        with link:
            link.send(json.dumps({"op": "advertise", "topic": CONTROL, "type": "autoware_control_msgs/Control"}))
            link.send(json.dumps({"op": "advertise", "topic": "/console/request", "type": "std_msgs/String"}))
            link.send(json.dumps({"op": "subscribe", "topic": "/odom", "type": "nav_msgs/Odometry"}))
            for text in link:
                message = json.loads(text)
                if message["op"] == "status":
                    self.statuses.append(message)
                    continue
                self.odometry += 1
                answers = self._answer(self.odometry, message["msg"]["header"]["stamp"])
                if answers is None:
                    link.socket.shutdown(socket.SHUT_RDWR)
                    return
                for answer in answers:
                    link.send(answer)
