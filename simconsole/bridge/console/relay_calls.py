"""Services and actions through the relay, both ways: operations of the router to those of the graph and back.

Each call and goal that comes in here ends here: with the other side's answer or with the reason why there is none.
"""

from collections.abc import Callable, Mapping
from typing import Any, Literal

import msgspec

from simconsole.bridge.console.graph_view import GraphOperation, Kind
from simconsole.bridge.messages.cdr import deserialize, serialize
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.operations import ABORTED, SUCCEEDED
from simconsole.bridge.protocol.server_protocol import Router
from simconsole.values.errors import BridgeError


class RelayCalls:
    """The calls and goals of one relay."""

    def __init__(
        self,
        router: Router,
        session: ClientSession,
        advertised: Mapping[Kind, Mapping[str, str]],
        put: Callable[[GraphOperation], None],
    ) -> None:
        """Begin without any.

        Args:
            router: where clients' services and actions are, and their calls.
            session: the relay's own, which calls for the graph and provides what is the graph's.
            advertised: the graph's, by kind and name, with their types.
            put: takes each operation for the graph.
        """
        self._router = router
        self._registry = router.registry
        self._session = session
        self._advertised = advertised
        self._put = put
        self._asked: dict[str, str] = {}
        """Types, by key, of what the graph waits for."""

    def call_service(self, key: str, service: str, data: bytes, now_ns: int) -> None:
        """Take a call by the graph of a client's service; a `reply` operation with this key will follow."""
        self._pass_on(key, service, "Request", data, now_ns, op="call_service", service=service)

    def send_goal(self, key: str, action: str, data: bytes, now_ns: int) -> None:
        """Take a goal of the graph for a client's action; an `end` operation with this key will follow."""
        self._pass_on(key, action, "Goal", data, now_ns, op="send_action_goal", action=action, feedback=True)

    def cancel(self, key: str, action: str, now_ns: int) -> None:
        """Take the graph's request to cancel a goal."""
        self._submit(now_ns, op="cancel_action_goal", action=action, id=key)

    def service_responded(self, key: str, service: str, data: bytes | None, why: str, now_ns: int) -> None:
        """Take the graph's answer to a `call`, None for a failure."""
        values, why = self._values("service", service, "Response", data, why)
        self._submit(
            now_ns, op="service_response", service=service, id=key, result=values is not None,
            values=why if values is None else values,
        )  # fmt: skip

    def feedback_received(self, key: str, action: str, data: bytes, now_ns: int) -> None:
        """Take feedback on a `goal`."""
        values, _ = self._values("action", action, "Feedback", data, "")
        if values is not None:
            self._submit(now_ns, op="action_feedback", action=action, id=key, values=values)

    def goal_ended(self, key: str, action: str, data: bytes | None, status: int, why: str, now_ns: int) -> None:
        """Take the end of a `goal`, None for a failure."""
        values, why = self._values("action", action, "Result", data, why)
        self._submit(
            now_ns, op="action_result", action=action, id=key, status=status,
            result=status == SUCCEEDED and values is not None, values=why if values is None else values,
        )  # fmt: skip

    def translate(self, said: dict[str, Any]) -> None:
        """Turn an operation on calls that the router sends to the relay's session into one of the graph."""
        key = said.get("id", "")
        match said["op"]:
            case "call_service":
                self._put(self._request("call", "service", said, "Request"))
            case "send_action_goal":
                self._put(self._request("goal", "action", said, "Goal"))
            case "cancel_action_goal":
                self._put(GraphOperation("cancel", said["action"], key))
            case "action_feedback":
                data, why = self._cdr(self._asked.get(key, ""), "Feedback", said["values"])
                self._put(GraphOperation("feedback", said["action"], key, data=data, text=why))
            case "service_response":
                data, why = self._ending(key, "Response", said)
                self._finish(key, GraphOperation("reply", said["service"], data=data, text=why))
            case _:  # action_result
                data, why = self._ending(key, "Result", said)
                self._finish(key, GraphOperation("end", said["action"], data=data, text=why, status=said["status"]))

    def _submit(self, now_ns: int, **operation: Any) -> None:
        self._router.receive(self._session, msgspec.json.encode(operation), now_ns)

    def _pass_on(self, key: str, name: str, part: str, data: bytes, now_ns: int, **operation: Any) -> None:
        type_name = (self._router.calls.actions() if part == "Goal" else self._router.calls.services()).get(name, "")
        self._asked[key] = type_name
        try:
            args = deserialize(self._registry, self._registry.part(type_name, part) or "", data)
        except BridgeError as error:
            kind: Literal["end", "reply"] = "end" if part == "Goal" else "reply"
            self._finish(key, GraphOperation(kind, name, text=str(error), status=ABORTED))
            return
        self._submit(now_ns, id=key, args=args, **operation)

    def _values(self, kind: Kind, name: str, part: str, data: bytes | None, why: str) -> tuple[Any, str]:
        """Return what the graph sent, or None and the reason."""
        if data is None:
            return None, why
        full = self._registry.part(self._advertised[kind].get(name, ""), part)
        if full is None:
            return None, "it has left the graph"
        try:
            return deserialize(self._registry, full, data), ""
        except BridgeError as error:
            return None, str(error)

    def _request(
        self, operation: Literal["call", "goal"], kind: Kind, said: dict[str, Any], part: str
    ) -> GraphOperation:
        name = said[kind]
        type_name = self._advertised[kind].get(name, "")
        data, why = self._cdr(type_name, part, said["args"])
        timeout_s = said.get("timeout")
        return GraphOperation(
            operation, name, key=said["id"], type=type_name, data=data, text=why, timeout_s=timeout_s
        )  # fmt: skip

    def _ending(self, key: str, part: str, said: dict[str, Any]) -> tuple[bytes | None, str]:
        if not isinstance(said["values"], dict):
            return None, str(said["values"])
        return self._cdr(self._asked.get(key, ""), part, said["values"])

    def _finish(self, key: str, operation: GraphOperation) -> None:
        self._asked.pop(key, None)
        self._put(operation._replace(key=key))

    def _cdr(self, type_name: str, part: str, values: Any) -> tuple[bytes | None, str]:
        full = self._registry.part(type_name, part)
        if full is None:
            return None, "it has left the graph"
        try:
            return serialize(self._registry, full, self._registry.from_plain(full, values)), ""
        except BridgeError as error:
            return None, str(error)
