"""An rclpy node that does what it is told: a JSON object a line on standard input, what it sees on standard output.

Topics are of std_msgs/String, services of std_srvs/SetBool, actions of test_msgs/Fibonacci. It ends when its standard
input does.
"""

import itertools
import json
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import rclpy
from nav_msgs.msg import Path
from rclpy.action import ActionClient, ActionServer
from rclpy.action.server import CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from sensor_msgs.msg import Image, PointCloud2, PointField
from std_msgs.msg import Float64, Int32, String
from std_srvs.srv import SetBool
from test_msgs.action import Fibonacci

QUEUE = QoSProfile(depth=1000)
"""Of a calling node's own: with rclpy's 10 two busy nodes lose answers without any relay between them."""
TYPES = {"String": String, "Int32": Int32, "Float64": Float64, "Path": Path, "Image": Image, "PointCloud2": PointCloud2}
CLOUD_POINTS = 62_500  # of 16 bytes: 1 MB


class Puppet(Node):  # type: ignore[misc]  # rclpy has no types here
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._group = ReentrantCallbackGroup()
        self._had: dict[tuple[str, str], Any] = {}

    def do(self, order: dict[str, Any]) -> None:
        """Carry out one order: `do` names the method. What cannot be done is told: somebody may wait for it."""
        what = order.pop("do")
        try:
            getattr(self, "_do_" + what)(**order)
        except Exception as error:
            say(failed=what, why=f"{type(error).__name__}: {error}")
            raise

    def _keep(self, kind: str, name: str, make: Callable[[], Any]) -> Any:
        if (kind, name) not in self._had:
            self._had[kind, name] = make()
        return self._had[kind, name]

    def _do_publish(self, name: str, data: Any, latched: bool = False, kind: str = "String") -> None:
        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        qos = QoSProfile(depth=1 if latched else 10, durability=durability)
        publisher = self._keep("publisher", name, lambda: self.create_publisher(TYPES[kind], name, qos))
        publisher.publish(TYPES[kind](data=data))

    def _do_burst(self, name: str, count: int) -> None:
        publisher = self._keep("publisher", name, lambda: self.create_publisher(String, name, QUEUE))
        for number in range(count):
            publisher.publish(String(data=str(number)))

    def _do_stream(self, name: str, kind: str, hz: float) -> None:
        """Publish numbered pictures or clouds until the stream is destroyed; each byte of data is the number's last."""
        publisher = self._keep("publisher", name, lambda: self.create_publisher(TYPES[kind], name, QUEUE))
        numbers = itertools.count()

        def send() -> None:
            publisher.publish(large(kind, next(numbers)))

        self._keep("stream", name, lambda: self.create_timer(1.0 / hz, send, callback_group=self._group))

    def _do_log(self, text: str) -> None:
        self.get_logger().info(text)

    def _do_offers(self, name: str) -> None:
        found = [info.qos_profile for info in self.get_publishers_info_by_topic(name)]
        say(
            offers=name,
            qos=[
                {
                    "reliability": qos.reliability.name,
                    "deadline_ns": qos.deadline.nanoseconds,
                    "lifespan_ns": qos.lifespan.nanoseconds,
                }
                for qos in found
            ],
        )

    def _do_subscribe(self, name: str, kind: str = "String", latched: bool = False) -> None:
        def hear(message: Any) -> None:
            say(heard=name, data=message.header.frame_id if kind == "Path" else message.data)

        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        qos = QoSProfile(depth=100, durability=durability)
        self._keep("subscription", name, lambda: self.create_subscription(TYPES[kind], name, hear, qos))

    def _do_serve(self, name: str) -> None:
        def flip(request: Any, response: Any) -> Any:
            response.success, response.message = not request.data, name
            return response

        self._keep("service", name, lambda: self.create_service(SetBool, name, flip, callback_group=self._group))
        say(served=name)

    def _do_serve_mute(self, name: str) -> None:
        async def ignore(request: Any, response: Any) -> Any:
            say(asked=name)
            return await Future()

        self._keep("service", name, lambda: self.create_service(SetBool, name, ignore, callback_group=self._group))

    def _do_call(self, name: str, count: int = 1, hz: float = 1000.0, patience_s: float = 30.0) -> None:
        client = self._keep(
            "client", name, lambda: self.create_client(SetBool, name, qos_profile=QUEUE, callback_group=self._group)
        )

        def send() -> None:
            self._when_ready(client.service_is_ready, patience_s)
            for number in range(count):
                future = client.call_async(SetBool.Request(data=bool(number % 2)))
                future.add_done_callback(
                    lambda done, number=number: say(
                        answered=name, number=number, success=done.result().success, message=done.result().message
                    )
                )
                time.sleep(1.0 / hz)

        threading.Thread(target=send, daemon=True).start()

    def _do_act(self, name: str, step_s: float = 0.0, tells: bool = False) -> None:
        async def pursue(goal: Any) -> Any:
            sequence = [0, 1]
            if tells:
                say(pursues=goal.request.order)
            while len(sequence) <= goal.request.order:
                if goal.is_cancel_requested:
                    goal.canceled()
                    return Fibonacci.Result(sequence=sequence)
                sequence.append((sequence[-1] + sequence[-2]) % 1_000_000)
                goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
                if step_s:
                    future: Any = Future()
                    timer = self.create_timer(step_s, lambda waits=future: waits.set_result(None))
                    await future
                    self.destroy_timer(timer)
            goal.succeed()
            return Fibonacci.Result(sequence=sequence)

        self._keep(
            "action server",
            name,
            lambda: ActionServer(
                self, Fibonacci, name, pursue, callback_group=self._group,
                cancel_callback=lambda goal: CancelResponse.ACCEPT,
            ),
        )  # fmt: skip

    def _do_pursue(self, name: str, count: int = 1, order: int = 3) -> None:
        client = self._keep(
            "action client",
            name,
            lambda: ActionClient(
                self,
                Fibonacci,
                name,
                callback_group=self._group,
                goal_service_qos_profile=QUEUE,
                result_service_qos_profile=QUEUE,
                feedback_sub_qos_profile=QUEUE,
            ),
        )

        def accepted(done: Any, number: int) -> None:
            if not done.result().accepted:
                say(ended=name, number=number, status=-1)
                return
            done.result().get_result_async().add_done_callback(
                lambda end: say(
                    ended=name, number=number, status=end.result().status, sequence=list(end.result().result.sequence)
                )
            )

        left = iter(range(count))

        def send() -> None:
            # In the executor's thread: rclpy loses the answer to a goal that is sent in another one now and then.
            if client.server_is_ready():
                number = next(left, None)
                if number is None:
                    self.destroy_timer(timer)
                    return
                future = client.send_goal_async(Fibonacci.Goal(order=order))
                future.add_done_callback(lambda done: accepted(done, number))

        timer = self.create_timer(0.001, send, callback_group=self._group)

    def _do_destroy(self, kind: str, name: str) -> None:
        entity = self._had.pop((kind, name), None)
        if entity is None:
            return
        ends = {
            "publisher": self.destroy_publisher,
            "subscription": self.destroy_subscription,
            "service": self.destroy_service,
            "client": self.destroy_client,
            "stream": self.destroy_timer,
        }
        ends.get(kind, lambda entity: entity.destroy())(entity)

    def _do_destroy_all(self) -> None:
        for kind, name in list(self._had):
            self._do_destroy(kind, name)

    def _do_declare(self, name: str, value: Any) -> None:
        self.declare_parameter(name, value)

    def _do_parameter(self, name: str) -> None:
        say(parameter=name, value=self.get_parameter(name).value)

    def _do_count(self, name: str) -> None:
        say(
            count=name,
            publishers=self.count_publishers(name),
            subscribers=self.count_subscribers(name),
            services=self.count_services(name),
        )

    def _do_list(self, node: str = "simconsole") -> None:
        services = [name for name, _ in self.get_service_names_and_types_by_node(node, "/")]
        clients = [name for name, _ in self.get_client_names_and_types_by_node(node, "/")]
        subscriptions = [name for name, _ in self.get_subscriber_names_and_types_by_node(node, "/")]
        publishers = [name for name, _ in self.get_publisher_names_and_types_by_node(node, "/")]
        say(services=services, clients=clients, subscriptions=subscriptions, publishers=publishers)

    def _when_ready(self, is_ready: Callable[[], bool], patience_s: float) -> None:
        end_s = time.monotonic() + patience_s
        while not is_ready() and time.monotonic() < end_s:
            time.sleep(0.005)


def large(kind: str, number: int) -> Any:
    """A picture of 640x480 in colour, or a cloud of 1 MB, with its number as the frame."""
    if kind == "Image":
        message = Image(height=480, width=640, encoding="rgb8", step=640 * 3)
        message.data = bytes([number % 256]) * (640 * 480 * 3)
    else:
        fields = [
            PointField(name=name, offset=4 * place, datatype=PointField.FLOAT32, count=1)
            for place, name in enumerate(("x", "y", "z", "intensity"))
        ]
        message = PointCloud2(height=1, width=CLOUD_POINTS, fields=fields, point_step=16, row_step=16 * CLOUD_POINTS)
        message.data = bytes([number % 256]) * (16 * CLOUD_POINTS)
    message.header.frame_id = str(number)
    return message


def say(**seen: Any) -> None:
    print(json.dumps(seen), flush=True)


def main() -> None:
    rclpy.init()
    puppet = Puppet(sys.argv[1])
    executor = SingleThreadedExecutor()
    executor.add_node(puppet)

    def spin() -> None:
        while rclpy.ok():
            try:
                executor.spin_once()
            except Exception as error:  # noqa: BLE001  an entity that was destroyed with something on its way
                print(type(error).__name__, error, file=sys.stderr)

    threading.Thread(target=spin, daemon=True).start()
    say(ready=True)
    for line in sys.stdin:
        executor.create_task(puppet.do, json.loads(line))


if __name__ == "__main__":
    main()
