"""Who waits for the end of a call or goal, and what waits for a provider that may just be appearing."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Final, NamedTuple

import cbor2
import msgspec
import orjson

from simconsole.bridge.messages import Registry
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.protocol.message_encoding import Dialect, png, to_plain
from simconsole.bridge.protocol.operations import CallService, Compression, Id, SendActionGoal
from simconsole.profiles.bridge import BridgeLimits
from simconsole.values.errors import BridgeError, RemoteProtocolError

NOBODY: Final = "nobody provides it"


class Caller(NamedTuple):
    """The calling client, and the form of the answer."""

    session: ClientSession
    id: Id
    called: str  # the service or action in the caller's spelling
    fragment_size: int | None
    compression: Compression

    @property
    def is_typed(self) -> bool:
        """Whether numeric arrays are CBOR's own in its answers."""
        return self.compression in ("cbor", "cbor-raw")

    def send(self, **fields: Any) -> None:
        """Send an operation to the caller in the form it asked for."""
        self.session.answer(encode(self.compression, id=self.id, **fields), self.fragment_size)

    def respond(self, values: Any, result: bool) -> None:
        """Answer a request."""
        self.send(op="service_response", service=self.called, values=values, result=result)

    def end(self, values: Any, status: int, result: bool) -> None:
        """End a goal."""
        self.send(op="action_result", action=self.called, values=values, status=status, result=result)


class NodeRequest(NamedTuple):
    """A call of a service of a node in the graph."""

    service: str
    type: str
    args: dict[str, Any]


class Forward(NamedTuple):
    """What a service of the console asks a node before it answers; `read` makes its answer of the node's.

    `read` raises RemoteProtocolError where the call has failed.
    """

    request: NodeRequest
    read: Callable[[dict[str, Any]], dict[str, Any]]


class Survey(NamedTuple):
    """What a service of the console asks several nodes before it answers.

    `read` makes its answer of their good answers, by service, that come within the time; the others are left out.
    """

    requests: list[NodeRequest]
    read: Callable[[dict[str, Any]], dict[str, Any]]
    timeout_s: float


Handler = Callable[[dict[str, Any], Dialect], dict[str, Any] | Forward | Survey]
"""A service of the console: takes arguments and the caller's dialect, returns values; raises BridgeError to fail."""


class Builtin(NamedTuple):
    """A service of the console, for clients of at least a role."""

    type: str
    handler: Handler
    role: Role


class Provider(NamedTuple):
    """The client that provides a service or action."""

    session: ClientSession
    type: str


class OpenCall(NamedTuple):
    """A request or goal that is with its provider."""

    caller: Caller
    provider: ClientSession
    name: str
    type: str
    deadline_ns: int | None
    feedback: bool
    is_goal: bool
    on_end: Callable[[Any, bool], None] | None = None
    """Gets values and result in the caller's place, where a service of the console has asked."""


def answer_forwarded(
    forward: Forward, caller: Caller, respond: Callable[[dict[str, Any]], None], values: Any, result: bool
) -> None:
    """Answer with what the node says, or with why it cannot be answered."""
    try:
        if not result:
            raise RemoteProtocolError(str(values))
        respond(forward.read(values))
    except BridgeError as error:
        caller.respond(str(error), False)


class SurveyAnswers:
    """The answers to one survey; the last one to come, or to fail, ends it."""

    def __init__(self, services: Iterable[str], finish: Callable[[dict[str, Any]], None]) -> None:
        """Wait for `services`; `finish` gets the good answers, at once if there is nobody to ask."""
        self._missing = set(services)
        self._good: dict[str, Any] = {}
        self._finish = finish
        if not self._missing:
            finish({})

    def take(self, service: str, values: Any, result: bool) -> None:
        """Take what one of the services says."""
        self._missing.discard(service)
        if result:
            self._good[service] = values
        if not self._missing:
            self._finish(self._good)


class HeldCall(NamedTuple):
    """A call or goal without a provider."""

    session: ClientSession
    name: str
    operation: CallService | SendActionGoal
    deadline_ns: int


class HeldCalls:
    """Calls and goals that wait a moment for their provider: what a graph has is heard of with some delay."""

    def __init__(self, limits: BridgeLimits) -> None:
        """Begin without patience: whatever nobody provides fails at once."""
        self.patience_ns = 0
        self._limits = limits
        self._held: list[HeldCall] = []

    def __len__(self) -> int:
        """Return how many wait."""
        return len(self._held)

    def hold(self, session: ClientSession, name: str, operation: CallService | SendActionGoal, now_ns: int) -> int:
        """Keep a call or goal; return until when. Raises RemoteProtocolError where it is not to wait."""
        most = session.max_calls or self._limits.calls
        if not self.patience_ns or sum(held.session is session for held in self._held) >= most:
            raise RemoteProtocolError(NOBODY)
        deadline_ns = now_ns + self.patience_ns
        self._held.append(HeldCall(session, name, operation, deadline_ns))
        return deadline_ns

    def release(self, name: str, now_ns: int) -> list[HeldCall]:
        """Return, and hold no longer, what waits for a name that is now provided; a service or an action."""
        if not self._held:
            return []
        released = [held for held in self._held if held.name == name and now_ns < held.deadline_ns]
        self._held = [held for held in self._held if held not in released]
        return released

    def expire(self, now_ns: int) -> list[HeldCall]:
        """Return, and hold no longer, what has waited long enough."""
        expired = [held for held in self._held if now_ns >= held.deadline_ns]
        self._held = [held for held in self._held if now_ns < held.deadline_ns]
        return expired

    def deadlines_ns(self) -> Iterator[int]:
        """Return until when each waits."""
        return (held.deadline_ns for held in self._held)

    def disconnect(self, session: ClientSession) -> None:
        """Forget what a client has asked for."""
        self._held = [held for held in self._held if held.session is not session]


def encode(compression: Compression, **fields: Any) -> bytes:
    """Return an operation in the receiver's compression; cbor-raw is for topics, its answers come in plain CBOR."""
    if fields.get("id") is None:
        fields.pop("id", None)
    if compression in ("cbor", "cbor-raw"):
        return Binary(cbor2.dumps(fields))
    text = msgspec.json.encode(fields)
    return orjson.dumps({"op": "png", "data": png(text)}) if compression == "png" else text


def send(session: ClientSession, **fields: Any) -> None:
    """Send an operation to a provider."""
    session.answer(encode("none", **fields))


def arguments_by_name(registry: Registry, type_name: str, part: str, args: Any) -> Any:
    """Return arguments by name: a list is in the order of the definition.

    Raises:
        RemoteProtocolError: they are no arguments, or too many.
    """
    full = registry.part(type_name, part)
    if args is None:
        args = {}
    if full is not None and isinstance(args, list):
        fields = registry.definition(full).fields
        if len(args) > len(fields):
            raise RemoteProtocolError(f"{len(args)} arguments, expected at most {len(fields)}")
        args = {field.name: value for field, value in zip(fields, args, strict=False)}
    if not isinstance(args, dict | list):
        raise RemoteProtocolError("args must be an object or an array")
    return args


def checked_values(
    registry: Registry, dialect: Dialect, type_name: str, part: str, values: Any, typed: bool = False
) -> Any:
    """Return values checked against their type, if it is known here, in the receiver's dialect.

    Raises:
        RemoteProtocolError: they do not fit.
    """
    full = registry.part(type_name, part)
    if full is None:
        return values
    return to_plain(registry, full, registry.from_plain(full, values), dialect, typed)
