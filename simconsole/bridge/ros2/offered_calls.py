"""Services and actions of clients that a node offers the graph.

All here runs on rclpy's thread. Each request and goal of the graph is answered, also when the client that provides it
leaves: only then, and after what is still on its way, the endpoint is destroyed.
"""

import itertools
from collections.abc import Callable
from typing import Any, Final

from simconsole.bridge.console.graph_view import GraphOperation
from simconsole.bridge.protocol.operations import ABORTED, CANCELED, SUCCEEDED
from simconsole.bridge.ros2.message_types import load
from simconsole.bridge.ros2.pacer import ACTION_AT_ONCE, ACTION_PERIOD_S, SERVICE_AT_ONCE, SERVICE_PERIOD_S, Pacer

LINGER_POLLS: Final = 3
"""How long the provider's endpoint stays after it has left, in polls: for requests and answers on their way."""
QUEUE: Final = 1000
"""Requests of a burst that wait to be read; rclpy's own 10 lose some."""
_LEFT: Final = "its provider has left"


class Offered:
    """One service or action in the graph, with the requests or goals that wait for their answer."""

    def __init__(self, name: str, types: Any) -> None:
        """Begin; the endpoint itself follows, for its callbacks need this."""
        self.name = name
        self.types = types
        self.endpoint: Any = None
        self.open: dict[str, Any] = {}
        """Futures of the answers by key."""
        self.goals: dict[str, Any] = {}
        self.accepting = 0
        """Goals that wait for their turn to be accepted."""
        self.until_poll: int | None = None
        """The poll from which on it may be destroyed; None while it has its provider."""


class OfferedCalls:
    """All that a node offers the graph."""

    def __init__(self, node: Any, executor: Any, group: Any, put: Callable[..., None]) -> None:
        """Begin without any; `put` takes the name of a method of the relay's and its arguments."""
        self._node = node
        self._executor = executor
        self._group = group
        self._put = put
        self._numbers = itertools.count(1)
        self._open: dict[str, Offered] = {}
        self._polls = 0
        self._services = Pacer(node, group, SERVICE_AT_ONCE, SERVICE_PERIOD_S)
        self._actions = Pacer(node, group, ACTION_AT_ONCE, ACTION_PERIOD_S)

    @property
    def open(self) -> int:
        """How many requests and goals of the graph wait for their answer."""
        return len(self._open)

    def make_service(self, name: str, kind: str) -> Offered:
        """Offer a service. May raise whatever rclpy raises."""
        from rclpy.qos import QoSProfile
        from rclpy.serialization import deserialize_message, serialize_message

        offered = Offered(name, load(kind))

        async def serve(request: Any, response: Any) -> Any:
            """Have the bridge answer a request of the graph; what fails is the empty answer."""
            answer = await self._forward(offered, "call_service", serialize_message(request))
            if answer.data is None:
                # ROS 2 cannot express a failed call: the response keeps its defaults.
                self._put("remarked", name, answer.text)
                return response
            return deserialize_message(answer.data, offered.types.Response)

        offered.endpoint = self._node.create_service(
            offered.types, name, serve, qos_profile=QoSProfile(depth=QUEUE), callback_group=self._group
        )
        return offered

    def make_action(self, name: str, kind: str) -> Offered:
        """Offer an action. May raise whatever rclpy raises."""
        from rclpy.action import ActionServer, CancelResponse, GoalResponse
        from rclpy.qos import QoSProfile
        from rclpy.serialization import serialize_message
        from rclpy.task import Future

        offered = Offered(name, load(kind))
        qos = QoSProfile(depth=QUEUE)

        async def execute(goal: Any) -> Any:
            """Have the bridge pursue a goal of the graph, to its end."""
            operation = await self._forward(offered, "send_goal", serialize_message(goal.request), goal)
            return self._end_goal(offered, goal, operation)

        async def accept(request: Any) -> Any:
            """Accept a goal in its turn, unless the action is about to end."""
            turn: Any = Future(executor=self._executor)
            offered.accepting += 1
            self._actions.do(offered.accepting + len(offered.open), lambda: self._let(turn))
            await turn
            offered.accepting -= 1
            return GoalResponse.ACCEPT if offered.until_poll is None else GoalResponse.REJECT

        def cancel(goal: Any) -> Any:
            """Pass the request to cancel a goal on to the client that executes it."""
            identity = bytes(goal.goal_id.uuid)
            for key, known in offered.goals.items():
                if bytes(known.goal_id.uuid) == identity:
                    self._put("cancel", key, name)
                    return CancelResponse.ACCEPT
            return CancelResponse.REJECT

        offered.endpoint = ActionServer(
            self._node, offered.types, name, execute, callback_group=self._group, goal_callback=accept,
            cancel_callback=cancel, goal_service_qos_profile=qos, result_service_qos_profile=qos,
            cancel_service_qos_profile=qos, feedback_pub_qos_profile=QoSProfile(depth=QUEUE),
        )  # fmt: skip
        return offered

    def end(self, offered: Offered) -> bool:
        """Answer all that is open; destroy the endpoint once that is done. Returns whether it is."""
        if offered.until_poll is None:
            offered.until_poll = self._polls + LINGER_POLLS
            for key in list(offered.open):
                self.finish(GraphOperation("reply", offered.name, key, text=_LEFT, status=ABORTED))
        if offered.open or offered.accepting or self._polls < offered.until_poll:
            return False
        if hasattr(offered.endpoint, "send_response"):
            self._node.destroy_service(offered.endpoint)
        else:
            offered.endpoint.destroy()
        return True

    def poll(self) -> None:
        """Count the time that endpoints linger."""
        self._polls += 1

    def finish(self, operation: GraphOperation) -> None:
        """Answer a request, or end a goal, of the graph."""
        offered = self._open.get(operation.key)
        if offered is not None:
            pacer = self._actions if offered.goals else self._services
            pacer.do(len(offered.open), lambda: self._answer(operation))

    def _answer(self, operation: GraphOperation) -> None:
        offered = self._open.pop(operation.key, None)
        if offered is not None:
            offered.open[operation.key].set_result(operation)
            self._executor.wake()  # what awaits a future is only looked at when the executor turns

    def publish_feedback(self, operation: GraphOperation) -> None:
        """Publish feedback on a goal of the graph."""
        from rclpy.serialization import deserialize_message

        offered = self._open.get(operation.key)
        if offered is not None and operation.key in offered.goals and operation.data is not None:
            feedback = deserialize_message(operation.data, offered.types.Feedback)
            offered.goals[operation.key].publish_feedback(feedback)

    def _let(self, turn: Any) -> None:
        turn.set_result(True)
        self._executor.wake()

    async def _forward(self, offered: Offered, event: str, data: bytes, goal: Any = None) -> GraphOperation:
        from rclpy.task import Future

        key = f"graph:{next(self._numbers)}"
        if offered.until_poll is not None:
            return GraphOperation("reply", offered.name, key, text=_LEFT, status=ABORTED)
        future: Any = Future(executor=self._executor)
        offered.open[key] = future
        self._open[key] = offered
        if goal is not None:
            offered.goals[key] = goal
        self._put(event, key, offered.name, data)
        try:
            operation: GraphOperation = await future
        finally:
            del offered.open[key]
            offered.goals.pop(key, None)
        return operation

    def _end_goal(self, offered: Offered, goal: Any, operation: GraphOperation) -> Any:
        from rclpy.serialization import deserialize_message

        if operation.status == SUCCEEDED and operation.data is not None:
            goal.succeed()
        elif operation.status == CANCELED and goal.is_cancel_requested:
            goal.canceled()
        else:
            self._put("remarked", offered.name, operation.text or "aborted")
            goal.abort()
        if operation.data is None:
            return offered.types.Result()
        return deserialize_message(operation.data, offered.types.Result)
