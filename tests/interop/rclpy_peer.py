"""An ordinary rclpy node with a topic, a service and an action of each kind, in both directions.

What it sees of rosbridge clients it says on /ros/says. It ends when its standard input does.
"""

import sys
import threading
from typing import Any

import rclpy
from nav_msgs.msg import Odometry
from rclpy.action import ActionClient, ActionServer
from rclpy.action.server import CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String
from std_srvs.srv import SetBool
from test_msgs.action import Fibonacci

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEST_EFFORT = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


class Peer(Node):  # type: ignore[misc]  # rclpy has no types here
    def __init__(self) -> None:
        super().__init__("peer")
        group = ReentrantCallbackGroup()
        self._says = self.create_publisher(String, "/ros/says", QoSProfile(depth=50))
        self._latched = self.create_publisher(String, "/ros/latched", LATCHED)
        self._latched.publish(String(data="once"))
        self._scans = self.create_publisher(LaserScan, "/ros/scan", BEST_EFFORT)
        self._said: set[str] = set()
        self._asked = False
        self.create_subscription(String, "/web/talk", lambda message: self.say(f"heard {message.data}"), 10)
        self.create_subscription(Clock, "/clock", lambda message: self.once("clock"), qos_profile_sensor_data)
        self.create_subscription(Odometry, "/odom", lambda message: self.once("odometry"), 10)
        self.create_service(SetBool, "/ros/flip", self._flip)
        self._flips = self.create_client(SetBool, "/web/flip", callback_group=group)
        self._server = ActionServer(
            self, Fibonacci, "/ros/fibonacci", self._pursue, callback_group=group,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )  # fmt: skip
        self._goals = ActionClient(self, Fibonacci, "/web/fibonacci", callback_group=group)
        self.create_timer(0.1, self._tick, callback_group=group)

    def say(self, text: str) -> None:
        self._says.publish(String(data=text))

    def once(self, text: str) -> None:
        if text not in self._said:
            self._said.add(text)
            self.create_timer(0.1, lambda: self.say(f"saw {text}"))

    def _tick(self) -> None:
        self._scans.publish(LaserScan(ranges=[1.0, float("inf"), 2.0]))
        if not self._asked and self._flips.service_is_ready() and self._goals.server_is_ready():
            self._asked = True
            future = self._flips.call_async(SetBool.Request(data=True))
            future.add_done_callback(lambda done: self.say(f"flip {done.result().success} {done.result().message}"))
            goal = self._goals.send_goal_async(Fibonacci.Goal(order=3), feedback_callback=self._progressed)
            goal.add_done_callback(lambda done: done.result().get_result_async().add_done_callback(self._ended))

    def _progressed(self, message: Any) -> None:
        self.say(f"feedback {list(message.feedback.sequence)}")

    def _ended(self, done: Any) -> None:
        self.say(f"result {done.result().status} {list(done.result().result.sequence)}")

    def _flip(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success = not request.data
        response.message = "flipped"
        return response

    def _pursue(self, goal: Any) -> Fibonacci.Result:
        sequence = [0, 1]
        pause = threading.Event()
        while len(sequence) <= goal.request.order:
            if goal.is_cancel_requested:
                goal.canceled()
                return Fibonacci.Result(sequence=sequence)
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
            pause.wait(0.05)
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)


def main() -> None:
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(Peer())
    threading.Thread(target=executor.spin, daemon=True).start()
    sys.stdin.read()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
