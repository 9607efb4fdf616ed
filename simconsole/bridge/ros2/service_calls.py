"""Services and actions of the graph that clients of the bridge use.

All here runs on rclpy's thread. Every call and goal ends: with its answer, or with the reason why there is none. A
service reads from a queue of ten requests and loses what comes beyond them, so no more than it holds are unanswered.
"""

from collections import deque
from collections.abc import Callable
from typing import Any, Final

from simconsole.bridge.console.graph_view import GraphOperation
from simconsole.bridge.protocol.operations import ABORTED, CANCELED
from simconsole.bridge.ros2.endpoints import POLL_S
from simconsole.bridge.ros2.message_types import load

WINDOW: Final = 8
"""Requests to one service, or goals not yet accepted of one action, that are on their way at a time."""
READY_POLLS: Final = 10
"""How long a service or action that is known may take to be there, and to come back: a second."""
IDLE_POLLS: Final = 50
"""How long the end of ours of a service stays when nobody calls it."""
QUEUE: Final = 1000
"""Answers of a burst that wait to be read."""
ASK_POLLS: Final = 10
"""After how long an accepted goal's result is asked for again: a second, then twice as long each time."""
ASK_POLLS_MOST: Final = 600


class _Pursued:
    """An accepted goal.

    Its result is asked for again and again: a question may be lost, and a server that has taken the place of the one
    that accepted the goal answers that it does not know it, which is its end.

    Where an action has two servers both may know the goal, but one whose acceptance was not delivered never pursues it
    and never answers. ROS does not say which of them has accepted. So the goal ends when one leaves that was there.
    """

    def __init__(self, handle: Any, ended: Callable[[Any], None], servers: frozenset[bytes]) -> None:
        self.handle = handle
        self.orphan_polls = 0
        """For how long one of its servers has been gone."""
        self._ended = ended
        self._servers = servers
        self._age_polls = 0
        self._wait_polls = ASK_POLLS
        self._left_polls = ASK_POLLS

    def poll(self, servers: frozenset[bytes]) -> None:
        """Count; ask when it is time; `servers` are those that the action has now."""
        self._age_polls += 1
        if self._age_polls <= READY_POLLS:
            self._servers |= servers  # heard of late
        self.orphan_polls = self.orphan_polls + 1 if self._servers - servers else 0
        self._left_polls -= 1
        if self._left_polls <= 0:
            self._wait_polls = self._left_polls = min(2 * self._wait_polls, ASK_POLLS_MOST)
            self.ask()

    def ask(self) -> None:
        """Ask for the result."""
        self.handle.get_result_async().add_done_callback(self._ended)


class _Called:
    """One service or action of the graph, and what is asked of it."""

    def __init__(self, name: str, type_name: str, is_call: bool) -> None:
        self.name = name
        self.type_name = type_name
        self.types = load(type_name)
        self.is_call = is_call
        self.client: Any = None
        self.waiting: deque[GraphOperation] = deque()
        self.unanswered: dict[str, int] = {}
        """Requests on their way by key, and the poll at which their time is over."""
        self.goals: dict[str, _Pursued] = {}
        self.unwanted: set[str] = set()
        """Goals that were cancelled before they were accepted."""
        self.unready_polls = 0
        self.idle_polls = 0

    @property
    def is_ready(self) -> bool:
        return bool(self.client.service_is_ready() if self.is_call else self.client.server_is_ready())

    @property
    def keys(self) -> list[str]:
        return [*(operation.key for operation in self.waiting), *self.unanswered, *self.goals]


class GraphCalls:
    """All open calls and goals of clients in one graph."""

    def __init__(self, node: Any, group: Any, put: Callable[..., None], call_s: float) -> None:
        """Begin without any.

        Args:
            node: rclpy's.
            group: a reentrant callback group, so that no call waits for another.
            put: takes the name of one of the relay's methods and its arguments.
            call_s: how long an answer may take where the caller does not say.
        """
        self._node = node
        self._group = group
        self._put = put
        self._call_s = call_s
        self._called: dict[tuple[bool, str], _Called] = {}
        self._polls = 0

    @property
    def open(self) -> int:
        """How many calls and goals wait for their end."""
        return sum(len(called.keys) for called in self._called.values())

    def __len__(self) -> int:
        """Return how many services and actions have an end of ours."""
        return len(self._called)

    def request(self, operation: GraphOperation) -> None:
        """Call a service or pursue a goal, once it is there."""
        is_call = operation.kind == "call"
        if operation.data is None:
            self._fail(is_call, operation.name, operation.key, operation.text)
            return
        try:
            called = self._find(operation.name, operation.type, is_call)
        except Exception as error:  # noqa: BLE001  rclpy says of no call what it raises
            self._fail(is_call, operation.name, operation.key, str(error))
            return
        called.waiting.append(operation)
        try:
            self._advance(called)
        except Exception as error:  # noqa: BLE001  rclpy says of no call what it raises
            self._fail_all(called, str(error))

    def cancel(self, operation: GraphOperation) -> None:
        """Cancel a goal, also one that is not yet accepted or sent."""
        called = self._called.get((False, operation.name))
        if called is None:
            return
        key = operation.key
        if key in called.goals:
            called.goals[key].handle.cancel_goal_async()
        elif key in called.unanswered:
            called.unwanted.add(key)
        elif key in called.keys:
            called.waiting = deque(waiting for waiting in called.waiting if waiting.key != key)
            self._put("goal_ended", key, called.name, None, CANCELED, "cancelled before it was sent")

    def poll(self) -> None:
        """Send what could not be sent; end what has waited too long; forget who is not called any more."""
        self._polls += 1
        for key, called in list(self._called.items()):
            try:
                self._tend(called)
            except Exception as error:  # noqa: BLE001  rclpy says of no call what it raises
                self._fail_all(called, str(error))
                called.idle_polls = IDLE_POLLS + 1
            if called.idle_polls > IDLE_POLLS:
                del self._called[key]
                self._destroy(called)

    def _tend(self, called: _Called) -> None:
        called.unready_polls = 0 if called.is_ready else called.unready_polls + 1
        if called.unready_polls > READY_POLLS:
            self._fail_all(called, "it was not there within a second, or has left the graph")
        for late in [late for late, end in called.unanswered.items() if self._polls > end]:
            self._take(called, late)
            self._fail(called.is_call, called.name, late, "no answer within the time limit")
        self._pursue(called)
        self._advance(called)
        called.idle_polls = 0 if called.keys else called.idle_polls + 1

    def _pursue(self, called: _Called) -> None:
        servers = self._servers(called) if called.goals else frozenset()
        for key, pursued in list(called.goals.items()):
            pursued.poll(servers)
            if pursued.orphan_polls > READY_POLLS:
                del called.goals[key]
                pursued.handle.cancel_goal_async()  # another server may be at it
                self._fail(False, called.name, key, "a server that may have accepted it has left the graph")

    def _servers(self, called: _Called) -> frozenset[bytes]:
        """Return the servers of an action: each publishes the status of its goals."""
        found = self._node.get_publishers_info_by_topic(f"{called.name}/_action/status")
        return frozenset(bytes(each.endpoint_gid) for each in found)

    def _find(self, name: str, type_name: str, is_call: bool) -> _Called:
        from rclpy.action import ActionClient
        from rclpy.qos import QoSProfile

        called = self._called.get((is_call, name))
        if called is not None and called.type_name != type_name:
            del self._called[is_call, name]
            self._fail_all(called, "it has another type now")
            self._destroy(called)
            called = None
        if called is None:
            called = _Called(name, type_name, is_call)
            qos = QoSProfile(depth=QUEUE)
            if is_call:
                called.client = self._node.create_client(
                    called.types, name, qos_profile=qos, callback_group=self._group
                )
            else:
                called.client = ActionClient(
                    self._node, called.types, name, callback_group=self._group, goal_service_qos_profile=qos,
                    result_service_qos_profile=qos, cancel_service_qos_profile=qos,
                    feedback_sub_qos_profile=QoSProfile(depth=QUEUE),
                )  # fmt: skip
            self._called[is_call, name] = called
        return called

    def _advance(self, called: _Called) -> None:
        """Send what waits, as far as it is there and the window allows: a request sent before both know is lost."""
        while called.waiting and len(called.unanswered) < WINDOW and called.is_ready:
            operation = called.waiting.popleft()
            limit_s = self._call_s if operation.timeout_s is None else operation.timeout_s
            called.unanswered[operation.key] = self._polls + int(limit_s / POLL_S) + 1
            try:
                if called.is_call:
                    self._send_call(called, operation)
                else:
                    self._send_goal(called, operation)
            except Exception as error:  # noqa: BLE001  rclpy says of no call what it raises
                self._take(called, operation.key)
                self._fail(called.is_call, called.name, operation.key, str(error))

    def _send_call(self, called: _Called, operation: GraphOperation) -> None:
        from rclpy.serialization import deserialize_message, serialize_message

        key, name = operation.key, called.name

        def done(future: Any) -> None:
            """Put the answer of the graph, or why there is none, into the bridge's inbox."""
            if not self._take(called, key):
                return  # it came too late
            try:
                self._put("service_responded", key, name, serialize_message(future.result()), "")
            except Exception as error:  # noqa: BLE001  rclpy says of no call what it raises
                self._put("service_responded", key, name, None, str(error))
            self._advance(called)

        request = deserialize_message(operation.data, called.types.Request)
        called.client.call_async(request).add_done_callback(done)

    def _send_goal(self, called: _Called, operation: GraphOperation) -> None:
        from rclpy.serialization import deserialize_message, serialize_message

        key, name = operation.key, called.name

        def accepted(future: Any) -> None:
            """Follow an accepted goal to its end; answer a refused one."""
            handle = future.result()
            if not self._take(called, key):
                if handle.accepted:
                    handle.cancel_goal_async()  # nobody waits for it any more
                return
            if not handle.accepted:
                self._fail(False, name, key, "the goal was not accepted")
            else:
                called.goals[key] = _Pursued(handle, ended, servers)
                called.goals[key].ask()
                if key in called.unwanted:
                    handle.cancel_goal_async()
            called.unwanted.discard(key)
            self._advance(called)

        def ended(future: Any) -> None:
            """Put the result of the goal, or why there is none, into the bridge's inbox."""
            pursued = called.goals.pop(key, None)
            if pursued is None:
                return
            try:
                found = future.result()
                if not found.status:
                    pursued.handle.cancel_goal_async()  # another server may be at it
                    self._fail(False, name, key, "the server that is there now does not know the goal")
                    return
                self._put("goal_ended", key, name, serialize_message(found.result), found.status, "")
            except Exception as error:  # noqa: BLE001  rclpy says of no call what it raises
                self._fail(False, name, key, str(error))

        def progressed(message: Any) -> None:
            """Put the goal's feedback into the bridge's inbox."""
            if key in called.goals or key in called.unanswered:
                self._put("feedback_received", key, name, serialize_message(message.feedback))

        servers = self._servers(called)
        goal = deserialize_message(operation.data, called.types.Goal)
        called.client.send_goal_async(goal, feedback_callback=progressed).add_done_callback(accepted)

    def _take(self, called: _Called, key: str) -> bool:
        """Return whether a request is still waited for, and wait no longer."""
        return called.unanswered.pop(key, None) is not None

    def _fail_all(self, called: _Called, why: str) -> None:
        for key in called.keys:
            self._fail(called.is_call, called.name, key, why)
        called.waiting.clear()
        called.unanswered.clear()
        called.goals.clear()
        called.unwanted.clear()

    def _fail(self, is_call: bool, name: str, key: str, why: str) -> None:
        if is_call:
            self._put("service_responded", key, name, None, why)
        else:
            self._put("goal_ended", key, name, None, ABORTED, why)

    def _destroy(self, called: _Called) -> None:
        if called.is_call:
            self._node.destroy_client(called.client)
        else:
            called.client.destroy()
