"""The client's side of rosbridge without a socket: operations out as text, messages in from text.

It keeps what the program advertised, subscribed to and provides, so that a new connection can repeat these
registrations. Types are named in two parts, which servers of ROS 1 and ROS 2 both know.
"""

from collections import deque
from collections.abc import Callable
from typing import Any, Final, NamedTuple

import msgspec
import orjson

from simconsole.bridge.messages import Registry, standard_registry
from simconsole.bridge.messages.definition_text import two_parts
from simconsole.bridge.protocol.fragments import FragmentAssembler
from simconsole.bridge.protocol.message_decoding import Binary, decode
from simconsole.bridge.protocol.message_encoding import Dialect, to_plain
from simconsole.bridge.protocol.operations import (
    ABORTED,
    CANCELED,
    SUCCEEDED,
    ActionFeedback,
    ActionResult,
    CallService,
    CancelActionGoal,
    Fragment,
    Operation,
    Publish,
    SendActionGoal,
    ServiceResponse,
    Status,
    read_operation,
    read_published,
    write_publish,
)
from simconsole.values.errors import BridgeError, LocalProtocolError, RemoteProtocolError

MAX_STATUS: Final = 100
MAX_WHOLE: Final = 16_777_216
MAX_PIECES: Final = 65_536

Callback = Callable[[str, Any], None]
Answer = Callable[[Any, bool], None]
"""Takes the values and whether it went well; if not, the values are why, as text."""
Feedback = Callable[[Any], None]
Handler = Callable[[Any], Any]
"""A service: takes arguments, returns values; a BridgeError it raises is the answer that it failed."""


class Received(NamedTuple):
    """One message of a subscribed topic."""

    topic: str
    message: Any


class _Subscription(NamedTuple):
    type_name: str
    callback: Callback | None


class _Call(NamedTuple):
    """A request or goal of ours."""

    on_answer: Answer
    on_feedback: Feedback | None


class Goal:
    """A goal that this client pursues for another."""

    def __init__(self, protocol: "ClientProtocol", action: str, identifier: Any, args: Any) -> None:
        """Take a goal; its arguments are plain values."""
        self.args = args
        self.cancelled = False
        """Whether its sender has cancelled it."""
        self.action = action
        self.id = identifier
        self._protocol = protocol

    def tell(self, values: Any) -> None:
        """Send feedback: how far it is."""
        self._protocol.reply(op="action_feedback", action=self.action, id=self.id, values=values)

    def succeed(self, values: Any) -> None:
        """Report success with the result."""
        self._end(values, SUCCEEDED, True)

    def fail(self, reason: str) -> None:
        """Report failure, as cancelled if the sender cancelled it."""
        self._end(reason, CANCELED if self.cancelled else ABORTED, False)

    def _end(self, values: Any, status: int, result: bool) -> None:
        self._protocol.goals.pop(self.id, None)
        self._protocol.reply(
            op="action_result", action=self.action, id=self.id, values=values, status=status, result=result
        )


class ClientProtocol:
    """A client's side of the protocol. It opens no socket and reads no clock; the caller passes the time in."""

    def __init__(self, registry: Registry | None = None, dialect: Dialect | None = None) -> None:
        """Use `registry` for message types, the standard one without; None finds the server's dialect out."""
        self.registry = registry if registry is not None else standard_registry()
        self.dialect = dialect
        """How the server spells times: as given, or as in the first stamp the server sent."""
        self.statuses: list[Status] = []
        """Status messages of the server, newest last, at most MAX_STATUS."""
        self.refused = 0
        """Messages of the server that could not be used."""
        self.replies: deque[bytes] = deque()
        """Answers to the server's requests and goals; the owner of the connection sends them."""
        self.goals: dict[Any, Goal] = {}
        """What this client pursues for others, by id."""
        self._registrations: dict[tuple[str, str], bytes] = {}
        self._advertised: dict[str, str] = {}
        self._subscriptions: dict[str, _Subscription] = {}
        self._readers: dict[bytes, tuple[str, msgspec.json.Decoder[Any]]] = {}
        self._services: dict[str, Handler] = {}
        self._actions: dict[str, Callable[[Goal], None]] = {}
        self._calls: dict[str, _Call] = {}
        self._numbers = 0
        self._assembler = FragmentAssembler(MAX_WHOLE, MAX_PIECES)

    def advertise(self, topic: str, type_name: str, latch: bool = False) -> bytes:
        """Return the text that announces a publisher; with `latch` who comes later gets the newest message.

        Raises:
            BridgeError: the type is not known.
            LocalProtocolError: the topic was advertised with another type.
        """
        full = self.registry.resolve(type_name)
        known = self._advertised.get(topic, full)
        if known != full:
            raise LocalProtocolError(f"{topic}: advertised as {known}, cannot be {full} too")
        self._advertised[topic] = full
        more = {"latch": True} if latch else {}
        return self._register("advertise", topic=topic, type=two_parts(full), **more)

    def unadvertise(self, topic: str) -> bytes:
        """Return the text that withdraws a publisher."""
        self._advertised.pop(topic, None)
        return self._withdraw("advertise", topic=topic)

    def publish(self, topic: str, message: Any) -> bytes:
        """Return the text of one message: a dict, or an instance of the topic's type (`registry.struct`).

        Raises:
            LocalProtocolError: the topic is not advertised, or the message does not fit its type.
        """
        full = self._advertised.get(topic)
        if full is None:
            raise LocalProtocolError(f"{topic}: advertise it before publishing")
        try:
            typed = self.registry.from_plain(full, message)
        except RemoteProtocolError as error:
            raise LocalProtocolError(f"{topic}: {error}") from None
        if self.dialect == "ros1":
            message = to_plain(self.registry, full, typed, "ros1")
        # Otherwise as given, not with defaults filled in: a server refuses a command in which a field was forgotten.
        return write_publish(topic, message)

    def subscribe(
        self,
        topic: str,
        type_name: str,
        callback: Callback | None = None,
        throttle_rate: int = 0,
        queue_length: int = 0,
        reads: type[msgspec.Struct] | None = None,
    ) -> bytes:
        """Return the text that asks for a topic.

        Args:
            topic: its name on the server.
            type_name: its type, in two or three parts.
            callback: called with (topic, message) by `receive`; without one the message is returned.
            throttle_rate: at most one message per so many milliseconds.
            queue_length: messages the server keeps for a slow client; 0 is the topic's own default.
            reads: a type with those of the message's fields that are wanted; others may be left out of it.

        Raises:
            BridgeError: the type is not known.
        """
        full = self.registry.resolve(type_name)
        self._subscriptions[topic] = _Subscription(full, callback)
        self._readers[topic.encode()] = (topic, msgspec.json.Decoder(reads or self.registry.struct(full)))
        asked = {"throttle_rate": throttle_rate, "queue_length": queue_length}
        more = {name: value for name, value in asked.items() if value}
        return self._register("subscribe", topic=topic, type=two_parts(full), **more)

    def unsubscribe(self, topic: str) -> bytes:
        """Return the text that ends a subscription."""
        self._subscriptions.pop(topic, None)
        self._readers.pop(topic.encode(), None)
        return self._withdraw("subscribe", topic=topic)

    def advertise_service(self, service: str, type_name: str, handler: Handler) -> bytes:
        """Return the text that offers a service, answered by `handler` within `receive`."""
        self._services[service] = handler
        return self._register("advertise_service", service=service, type=type_name)

    def unadvertise_service(self, service: str) -> bytes:
        """Return the text that offers it no more."""
        self._services.pop(service, None)
        return self._withdraw("advertise_service", service=service)

    def call_service(self, service: str, args: Any, on_answer: Answer) -> bytes:
        """Return the text of a request; `on_answer` is called by `receive`, or by `end_calls`."""
        identifier = self._call(on_answer, None)
        return orjson.dumps({"op": "call_service", "service": service, "args": args, "id": identifier})

    def advertise_action(self, action: str, type_name: str, pursue: Callable[[Goal], None]) -> bytes:
        """Return the text that offers an action, whose goals `pursue` gets within `receive`."""
        self._actions[action] = pursue
        return self._register("advertise_action", action=action, type=type_name)

    def unadvertise_action(self, action: str) -> bytes:
        """Return the text that offers it no more."""
        self._actions.pop(action, None)
        return self._withdraw("advertise_action", action=action)

    def send_goal(
        self, action: str, type_name: str, args: Any, on_result: Answer, on_feedback: Feedback | None = None
    ) -> bytes:
        """Return the text of a goal; the callbacks are called by `receive`, or by `end_calls`."""
        identifier = self._call(on_result, on_feedback)
        fields = {"op": "send_action_goal", "action": action, "action_type": type_name, "args": args}
        return orjson.dumps({**fields, "feedback": on_feedback is not None, "id": identifier})

    def registrations(self) -> list[bytes]:
        """Return the texts that repeat on a new connection everything this client registered."""
        return list(self._registrations.values())

    def end_calls(self) -> None:
        """End everything that cannot outlive its connection: calls fail, goals of others are cancelled."""
        calls, self._calls = self._calls, {}
        goals, self.goals = self.goals, {}
        self._assembler = FragmentAssembler(MAX_WHOLE, MAX_PIECES)
        self.replies.clear()
        for call in calls.values():
            call.on_answer("the connection has ended", False)
        for goal in goals.values():
            goal.cancelled = True

    def reply(self, **fields: Any) -> None:
        """Queue an operation for the server."""
        self.replies.append(msgspec.json.encode(fields))

    def receive(self, text: bytes, now_ns: int = 0) -> Received | None:
        """Read one message of the server; return it if it is a subscribed topic's and has no callback.

        What cannot be used is counted in `refused`: a server's mistake must not end a drive. An exception of a
        callback is the program's own and goes through.
        """
        known = self._published(text)
        if known is not None:
            return self._deliver(*known)
        try:
            operation: Operation | None = read_operation(decode(text).fields)
            if isinstance(operation, Fragment):
                whole = self._assembler.add(operation, now_ns)
                operation = None if whole is None else read_operation(decode(whole).fields)
            message = self._typed(operation) if isinstance(operation, Publish) else None
        except BridgeError:
            self.refused += 1
            return None
        if message is not None and isinstance(operation, Publish):
            return self._deliver(operation.topic, message)
        if operation is not None:
            self._react(operation)
        return None

    def _published(self, text: bytes) -> tuple[str, Any] | None:
        """Return topic and message of a text that is what servers nearly always send, None of any other.

        That is a subscribed topic's message in its type: decoded at once, without a table of its fields in between.
        What does not fit goes the long way.
        """
        published = None if self.dialect is None or isinstance(text, Binary) else read_published(text)
        reader = None if published is None else self._readers.get(published[0])
        if published is None or reader is None:
            return None
        try:
            return reader[0], reader[1].decode(published[1])
        except msgspec.DecodeError:
            return None

    def _typed(self, operation: Publish) -> Any:
        """Return a subscribed topic's message in its type, None for another topic's."""
        subscription = self._subscriptions.get(operation.topic)
        if subscription is None:
            return None
        if self.dialect is None:
            self.dialect = _dialect_of(operation.msg)
        return self.registry.from_plain(subscription.type_name, operation.msg)

    def _deliver(self, topic: str, message: Any) -> Received | None:
        callback = self._subscriptions[topic].callback
        if callback is None:
            return Received(topic, message)
        callback(topic, message)
        return None

    def _react(self, operation: Operation) -> None:
        match operation:
            case Status():
                self.statuses = [*self.statuses[-MAX_STATUS + 1 :], operation]
            case ServiceResponse() | ActionResult():
                call = self._calls.pop(str(operation.id), None)
                if call is not None:
                    call.on_answer(operation.values, operation.result)
            case ActionFeedback():
                waiting = self._calls.get(str(operation.id))
                if waiting is not None and waiting.on_feedback is not None:
                    waiting.on_feedback(operation.values)
            case CallService():
                self._serve(operation)
            case SendActionGoal():
                pursue = self._actions.get(operation.action)
                if pursue is not None:
                    goal = self.goals[operation.id] = Goal(self, operation.action, operation.id, operation.args)
                    pursue(goal)
            case CancelActionGoal():
                self._cancel(operation)

    def _cancel(self, operation: CancelActionGoal) -> None:
        unwanted = self.goals.get(operation.id)
        if unwanted is not None:
            unwanted.cancelled = True

    def _serve(self, operation: CallService) -> None:
        handler = self._services.get(operation.service)
        try:
            if handler is None:
                raise BridgeError("not provided here")
            values, result = handler(operation.args), True
        except BridgeError as error:
            values, result = str(error), False
        self.reply(op="service_response", service=operation.service, id=operation.id, values=values, result=result)

    def _call(self, on_answer: Answer, on_feedback: Feedback | None) -> str:
        self._numbers += 1
        identifier = f"c{self._numbers}"
        self._calls[identifier] = _Call(on_answer, on_feedback)
        return identifier

    def _register(self, op: str, **fields: Any) -> bytes:
        name = next(iter(fields.values()))
        text = self._registrations[op, name] = orjson.dumps({"op": op, **fields})
        return text

    def _withdraw(self, op: str, **fields: str) -> bytes:
        self._registrations.pop((op, next(iter(fields.values()))), None)
        return orjson.dumps({"op": f"un{op}", **fields})


def _dialect_of(message: Any) -> Dialect | None:
    """Return how the first stamp of a message is spelled, None where there is none."""
    header = message.get("header") if isinstance(message, dict) else None
    stamp = header.get("stamp") if isinstance(header, dict) else None
    if not isinstance(stamp, dict):
        return None
    return "ros1" if "secs" in stamp else "ros2" if "sec" in stamp else None
