"""Services and actions of a ROS 2 node, both ways: the graph's for rosbridge clients, and theirs for the graph.

Everything here runs on rclpy's thread. What is for the bridge's thread is `put`: the name of one of the relay's
methods and its arguments.
"""

import itertools
import logging
from collections.abc import Callable
from typing import Any, Final

from simconsole.bridge.console.relay import GraphOperation
from simconsole.bridge.protocol.operations import ABORTED, CANCELED, SUCCEEDED
from simconsole.bridge.ros2.message_types import load

MAX_POLLS: Final = 300
"""How often a service or action that is known but not found is looked for."""

_logger: Final = logging.getLogger("simconsole.bridge.ros2.node")


class GraphCalls:
    """All open calls and goals of one node."""

    def __init__(self, node: Any, executor: Any, group: Any, put: Callable[..., None]) -> None:
        """Begin without any; `group` is a reentrant callback group, so that no call waits for another."""
        self._node = node
        self._executor = executor
        self._group = group
        self._put = put
        self._numbers = itertools.count(1)
        self._clients: dict[str, Any] = {}
        self._waiting: dict[str, Any] = {}
        """Futures by key, of the graph's calls to rosbridge clients."""
        self._served: dict[str, tuple[Any, Any]] = {}
        """The graph's goals by key: handle and types."""
        self._goals: dict[str, Any] = {}
        """Handles of the clients' goals by key; None before acceptance, a string if cancelled before."""
        self._unready: list[tuple[GraphOperation, int]] = []
        """What is for a service or action not yet found by our end of it, and how many polls are left."""

    def execute(self, operation: GraphOperation) -> None:
        """Do one thing that the relay ordered."""
        match operation.kind:
            case "call" | "goal":
                self._request(operation, MAX_POLLS)
            case "cancel":
                self._cancel(operation)
            case "reply" | "end":
                self._finish(operation)
            case "feedback":
                self._publish_feedback(operation)

    def poll(self) -> None:
        """Ask again for what was not yet there: a request sent before both ends know each other is lost."""
        waiting, self._unready = self._unready, []
        for operation, polls in waiting:
            if polls:
                self._request(operation, polls - 1)

    def make_service(self, name: str, kind: str) -> Any:
        """Return a service of the graph that a client of the bridge answers."""
        from rclpy.serialization import deserialize_message, serialize_message

        types = load(kind)

        async def serve(request: Any, response: Any) -> Any:
            """Have the bridge answer a request of the graph; what fails is the empty answer."""
            _, answer = self._forward("call_service", name, serialize_message(request))
            operation = await answer
            if operation.data is None:
                # ROS 2 cannot express a failed call: the response keeps its defaults.
                _logger.warning("%s: %s", name, operation.text)
                return response
            return deserialize_message(operation.data, types.Response)

        return self._node.create_service(types, name, serve, callback_group=self._group)

    def make_action(self, name: str, kind: str) -> Any:
        """Return an action of the graph whose goals a client of the bridge pursues."""
        from rclpy.action import ActionServer, CancelResponse
        from rclpy.serialization import deserialize_message, serialize_message

        types = load(kind)

        async def execute(goal: Any) -> Any:
            """Have the bridge pursue a goal of the graph, to its end."""
            key, end = self._forward("send_goal", name, serialize_message(goal.request))
            self._served[key] = (goal, types)
            operation = await end
            del self._served[key]
            if operation.status == SUCCEEDED:
                goal.succeed()
            elif operation.status == CANCELED and goal.is_cancel_requested:
                goal.canceled()
            else:
                _logger.warning("%s: %s", name, operation.text or "aborted")
                goal.abort()
            return types.Result() if operation.data is None else deserialize_message(operation.data, types.Result)

        def cancel(goal: Any) -> Any:
            """Pass the request to cancel a goal on to the client that executes it."""
            identity = bytes(goal.goal_id.uuid)
            for key, (known, _) in self._served.items():
                if bytes(known.goal_id.uuid) == identity:
                    self._put("cancel", key, name)
                    return CancelResponse.ACCEPT
            return CancelResponse.REJECT

        return ActionServer(
            self._node, types, name, execute, callback_group=self._group, cancel_callback=cancel
        )  # fmt: skip

    def _forward(self, event: str, name: str, data: bytes) -> tuple[str, Any]:
        from rclpy.task import Future

        key = f"graph:{next(self._numbers)}"
        future: Any = Future(executor=self._executor)
        self._waiting[key] = future
        self._put(event, key, name, data)
        return key, future

    def _finish(self, operation: GraphOperation) -> None:
        future = self._waiting.pop(operation.key, None)
        if future is not None:
            future.set_result(operation)

    def _publish_feedback(self, operation: GraphOperation) -> None:
        from rclpy.serialization import deserialize_message

        if operation.key in self._served and operation.data is not None:
            goal, types = self._served[operation.key]
            goal.publish_feedback(deserialize_message(operation.data, types.Feedback))

    def _request(self, operation: GraphOperation, polls: int) -> None:
        from rclpy.action import ActionClient
        from rclpy.serialization import deserialize_message

        is_call = operation.kind == "call"
        if operation.data is None:
            if is_call:
                self._put("service_responded", operation.key, operation.name, None, operation.text)
            else:
                self._put("goal_ended", operation.key, operation.name, None, ABORTED, operation.text)
            return
        types = load(operation.type)
        client = self._clients.get(operation.name)
        if client is None and is_call:
            client = self._node.create_client(types, operation.name, callback_group=self._group)
        elif client is None:
            client = ActionClient(self._node, types, operation.name, callback_group=self._group)
        self._clients[operation.name] = client
        if not is_call:
            self._goals.setdefault(operation.key, None)
        if not (client.service_is_ready() if is_call else client.server_is_ready()):
            self._unready.append((operation, polls))
        elif is_call:
            self._call(operation, client, deserialize_message(operation.data, types.Request))
        else:
            self._send_goal(operation, client, deserialize_message(operation.data, types.Goal))

    def _call(self, operation: GraphOperation, client: Any, request: Any) -> None:
        from rclpy.serialization import serialize_message

        def done(future: Any) -> None:
            """Put the answer of the graph, or why there is none, into the bridge's inbox."""
            error = future.exception()
            data = None if error is not None else serialize_message(future.result())
            self._put("service_responded", operation.key, operation.name, data, str(error))

        client.call_async(request).add_done_callback(done)

    def _send_goal(self, operation: GraphOperation, client: Any, goal: Any) -> None:
        from rclpy.serialization import serialize_message

        key, name = operation.key, operation.name

        def accepted(future: Any) -> None:
            handle = future.result()
            if not handle.accepted:
                self._goals.pop(key, None)
                self._put("goal_ended", key, name, None, ABORTED, "the goal was not accepted")
                return
            is_unwanted = isinstance(self._goals.get(key), str)
            self._goals[key] = handle
            handle.get_result_async().add_done_callback(ended)
            if is_unwanted:
                handle.cancel_goal_async()

        def ended(future: Any) -> None:
            self._goals.pop(key, None)
            found = future.result()
            self._put("goal_ended", key, name, serialize_message(found.result), found.status, "")

        def progressed(message: Any) -> None:
            self._put("feedback_received", key, name, serialize_message(message.feedback))

        client.send_goal_async(goal, feedback_callback=progressed).add_done_callback(accepted)

    def _cancel(self, operation: GraphOperation) -> None:
        if operation.key not in self._goals:
            return
        goal = self._goals[operation.key]
        if goal is None:
            self._goals[operation.key] = "cancel"
        elif not isinstance(goal, str):
            goal.cancel_goal_async()
