"""The operations of the rosbridge v2 protocol that this bridge supports: their fields, read and written.

Source: ROSBRIDGE_PROTOCOL.md of rosbridge_suite. Fields a peer adds to an operation are ignored unless named here.
"""

from typing import Annotated, Any, Final, Literal

import msgspec
import orjson
from msgspec import Meta, Struct

from simconsole.values.errors import RemoteProtocolError
from simconsole.values.units import NS_PER_S

Id = str | int | None
Level = Literal["none", "error", "warning", "info"]
SEVERITY: Final[dict[str, int]] = {"none": 0, "error": 1, "warning": 2, "info": 3}
DEFAULT_LEVEL: Final = "error"
SUCCEEDED: Final = 4
CANCELED: Final = 5
ABORTED: Final = 6
"""How a goal ended (action_msgs/GoalStatus)."""

Compression = Literal["none", "png", "cbor", "cbor-raw"]
FragmentSize = Annotated[int, Meta(ge=16)] | None
"""The most characters of a message in one piece; smaller ones would cost more in frames than in content."""


class Span(Struct):
    """A builtin_interfaces/Duration."""

    sec: Annotated[int, Meta(ge=0, le=1_000_000_000)] = 0
    nanosec: Annotated[int, Meta(ge=0, le=999_999_999)] = 0


class Qos(Struct):
    """ROS 2's quality of service, as in rosbridge_suite since its pull request 1150; absent fields get our defaults.

    Applied: `depth` and `history` as the queue's length, `durability` as the latch, `lifespan` (s, or a Duration) as
    the latch's end. Every queue here is reliable until it is full: `reliability` means nothing more.
    """

    depth: Annotated[int, Meta(ge=0, le=1_000_000)] | None = None
    reliability: Literal["system_default", "best_available", "reliable", "best_effort"] | None = None
    durability: Literal["system_default", "best_available", "volatile", "transient_local"] | None = None
    history: Literal["system_default", "keep_last", "keep_all"] | None = None
    lifespan: Annotated[float, Meta(ge=0.0, le=1e9)] | Span | None = None

    @property
    def lifespan_ns(self) -> int | None:
        """How long a latched message lasts, None for ever."""
        if isinstance(self.lifespan, Span):
            return self.lifespan.sec * NS_PER_S + self.lifespan.nanosec
        return None if self.lifespan is None else int(self.lifespan * NS_PER_S)


NO_QOS: Final = Qos()


class Advertise(Struct):
    """A client will publish."""

    topic: str
    type: str
    id: Id = None
    latch: bool = False
    qos: Qos | None = None


class Unadvertise(Struct):
    """A client will no longer publish."""

    topic: str
    id: Id = None


class Publish(Struct):
    """One message, either way."""

    topic: str
    msg: Any
    id: Id = None
    latch: bool = False
    qos: Qos | None = None


class Subscribe(Struct):
    """A client subscribes: at most one message per `throttle_rate` ms, `queue_length` kept while it waits."""

    topic: str
    type: str | None = None
    id: Id = None
    throttle_rate: Annotated[float, Meta(ge=0.0, le=3.6e6)] = 0.0
    queue_length: Annotated[int, Meta(ge=0)] = 0
    compression: Compression = "none"
    fragment_size: FragmentSize = None
    qos: Qos | None = None


class Unsubscribe(Struct):
    """A client unsubscribes from a topic; without id, all its subscriptions to it."""

    topic: str
    id: Id = None


class Status(Struct):
    """A remark on something the receiver sent."""

    level: Level
    msg: str
    id: Id = None


class SetLevel(Struct):
    """How severe a status must be to be sent to this client."""

    level: Level
    id: Id = None


class CallService(Struct):
    """A request, either way; `timeout` in s."""

    service: str
    args: Any = None
    id: Id = None
    type: str | None = None
    timeout: Annotated[float, Meta(ge=0.0, le=3600.0)] = 0.0
    fragment_size: FragmentSize = None
    compression: Compression = "none"


class ServiceResponse(Struct):
    """The answer to a request, either way; on failure `values` is why, as text."""

    service: str
    values: Any = None
    result: bool = True
    id: Id = None


class AdvertiseService(Struct):
    """A client will answer requests."""

    service: str
    type: str
    id: Id = None


class UnadvertiseService(Struct):
    """A client will no longer answer requests."""

    service: str
    id: Id = None


class AdvertiseAction(Struct):
    """A client will pursue goals."""

    action: str
    type: str
    id: Id = None


class UnadvertiseAction(Struct):
    """A client will no longer pursue goals."""

    action: str
    id: Id = None


class SendActionGoal(Struct):
    """A goal, either way; `feedback` asks for its progress."""

    action: str
    action_type: str | None = None
    args: Any = None
    feedback: bool = False
    id: Id = None
    fragment_size: FragmentSize = None
    compression: Compression = "none"


class CancelActionGoal(Struct):
    """A goal is cancelled, either way."""

    action: str
    id: Id


class ActionFeedback(Struct):
    """How far a goal is, either way."""

    action: str
    id: Id
    values: Any = None


class ActionResult(Struct):
    """How a goal ended, either way; `status` is one of action_msgs/GoalStatus."""

    action: str
    id: Id
    values: Any = None
    status: int = 0
    result: bool = True


class Fragment(Struct):
    """One of `total` pieces of a text; rosbridge_suite writes the total as a fraction."""

    data: str
    num: Annotated[float, Meta(ge=0.0, le=1e9)]
    total: Annotated[float, Meta(gt=0.0, le=1e9)]
    id: Id = None


class Auth(Struct):
    """Who the client is: a token, or what rosauth's clients make of one (`mac` and what went into it)."""

    mac: str = ""
    client: str = ""
    dest: str = ""
    rand: str = ""
    t: int = 0
    level: str = ""
    end: int = 0
    token: str = ""
    id: Id = None


CallOperation = (
    CallService
    | ServiceResponse
    | AdvertiseService
    | UnadvertiseService
    | AdvertiseAction
    | UnadvertiseAction
    | SendActionGoal
    | CancelActionGoal
    | ActionFeedback
    | ActionResult
)
Operation = (
    Advertise | Unadvertise | Publish | Subscribe | Unsubscribe | Status | SetLevel | Fragment | Auth | CallOperation
)

OPERATIONS: Final[dict[str, type[Operation]]] = {
    "advertise": Advertise,
    "unadvertise": Unadvertise,
    "publish": Publish,
    "subscribe": Subscribe,
    "unsubscribe": Unsubscribe,
    "status": Status,
    "set_level": SetLevel,
    "fragment": Fragment,
    "auth": Auth,
    "call_service": CallService,
    "service_response": ServiceResponse,
    "advertise_service": AdvertiseService,
    "unadvertise_service": UnadvertiseService,
    "advertise_action": AdvertiseAction,
    "unadvertise_action": UnadvertiseAction,
    "send_action_goal": SendActionGoal,
    "cancel_action_goal": CancelActionGoal,
    "action_feedback": ActionFeedback,
    "action_result": ActionResult,
}


def read_operation(fields: dict[str, Any]) -> Operation:
    """Return the typed operation of a decoded message.

    Raises:
        RemoteProtocolError: no `op`, an unknown one, or a field of the wrong type.
    """
    name = fields.get("op")
    if not isinstance(name, str):
        raise RemoteProtocolError("message has no op")
    if name == "publish" and "msg" in fields and "qos" not in fields and type(fields.get("topic")) is str:
        # The one that comes a hundred times a second is spared the conversion of its untyped payload.
        return Publish(fields["topic"], fields["msg"], id_of(fields), fields.get("latch") is True)
    operation = OPERATIONS.get(name)
    if operation is None:
        raise RemoteProtocolError(f"op {name[:40]!r} is not supported here, only {', '.join(OPERATIONS)}")
    try:
        return msgspec.convert(fields, operation)
    except msgspec.ValidationError as error:
        raise RemoteProtocolError(f"{name}: {error}") from None


def id_of(fields: dict[str, Any]) -> Id:
    """Return the id of a message if it has a usable one: a refusal carries it back."""
    value = fields.get("id")
    if isinstance(value, str):
        return value[:256]
    return value if type(value) is int else None


def write_status(level: str, text: str, identifier: Id = None) -> bytes:
    """Return a status operation as text."""
    fields: dict[str, Any] = {"op": "status", "level": level, "msg": text[:1000]}
    if identifier is not None:
        fields["id"] = identifier
    return orjson.dumps(fields)


def publish_head(topic: str) -> bytes:
    """Return a publish operation up to its message: message and a closing brace follow."""
    return b'{"op":"publish","topic":' + orjson.dumps(topic) + b',"msg":'


def write_publish(topic: str, message: Any) -> bytes:
    """Return a publish operation. NaN and infinities become null, so that the result is always JSON."""
    return publish_head(topic) + msgspec.json.encode(message) + b"}"
