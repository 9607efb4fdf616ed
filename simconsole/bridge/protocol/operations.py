"""The operations of the rosbridge v2 protocol that this bridge supports: their fields, read and written.

Source: ROSBRIDGE_PROTOCOL.md of rosbridge_suite. Fields a peer adds to an operation are ignored unless named here.
"""

from functools import lru_cache
from typing import Annotated, Any, Final, Literal

import msgspec
import orjson
from msgspec import Meta, Struct

from simconsole.values.errors import RemoteProtocolError
from simconsole.values.units import NS_PER_S

MAX_ID: Final = 1024
Id = Annotated[str, Meta(max_length=MAX_ID)] | int | None
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


_Seconds = Annotated[int, Meta(ge=0, le=1_000_000_000)]
_Nanoseconds = Annotated[int, Meta(ge=0, le=999_999_999)]


class Span(Struct, forbid_unknown_fields=True):
    """A duration, in ROS 1's names of its parts, which rosbridge_suite takes, or in ROS 2's."""

    secs: _Seconds = 0
    nsecs: _Nanoseconds = 0
    sec: _Seconds = 0
    nanosec: _Nanoseconds = 0


Duration = Annotated[float, Meta(ge=0.0, le=1e9)] | Span | Literal["infinite", "best_available"]
"""In s."""


class Qos(Struct):
    """ROS 2's quality of service in the form of rosbridge_suite, upper or lower case; absent fields get our defaults.

    Applied here: `depth` and `history` as the queue's length, `durability` as the latch, `lifespan` as the latch's
    end. Every queue here is reliable until it is full; `reliability` and `deadline` are applied in a ROS 2 graph.
    """

    depth: Annotated[int, Meta(ge=0, le=1_000_000)] | None = None
    reliability: Literal["system_default", "best_available", "reliable", "best_effort"] | None = None
    durability: Literal["system_default", "best_available", "volatile", "transient_local"] | None = None
    history: Literal["system_default", "keep_last", "keep_all"] | None = None
    lifespan: Duration | None = None
    deadline: Duration | None = None

    @property
    def lifespan_ns(self) -> int | None:
        """How long a latched message lasts, None for ever."""
        return _duration_ns(self.lifespan)

    @property
    def deadline_ns(self) -> int | None:
        """The longest time promised between two messages, None without one."""
        return _duration_ns(self.deadline)


def _duration_ns(duration: Duration | None) -> int | None:
    """Return a duration in ns; None where it has no end, which ROS writes as 0 too."""
    if duration is None or isinstance(duration, str):
        return None
    if isinstance(duration, Span):
        return (duration.secs + duration.sec) * NS_PER_S + duration.nsecs + duration.nanosec or None
    return int(duration * NS_PER_S) or None


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
    type: str | None = None


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
    """A goal is cancelled, either way; without id, all of the client's goals for that action."""

    action: str
    id: Id = None


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
    qos = fields.get("qos")
    if name == "publish" and qos is None and "msg" in fields and type(fields.get("topic")) is str:
        # The one that comes a hundred times a second is spared the conversion of its untyped payload.
        kind = fields.get("type")
        if kind is None or type(kind) is str:
            return Publish(
                topic=fields["topic"],
                msg=fields["msg"],
                id=id_of(fields),
                latch=fields.get("latch") is True,
                type=kind,
            )
    if isinstance(qos, dict):
        lower = {key: value.lower() if isinstance(value, str) else value for key, value in qos.items()}
        fields = {**fields, "qos": lower}
    operation = OPERATIONS.get(name)
    if operation is None:
        raise RemoteProtocolError(f"op {name[:40]!r} is not supported here, only {', '.join(OPERATIONS)}")
    try:
        return msgspec.convert(fields, operation)
    except msgspec.ValidationError as error:
        raise RemoteProtocolError(f"{name}: {error}") from None


def id_of(fields: dict[str, Any]) -> Id:
    """Return the id of a message if it has a usable one: a refusal carries it back as it came."""
    value = fields.get("id")
    if isinstance(value, str):
        return value if len(value) <= MAX_ID else None
    return value if type(value) is int else None


def write_status(level: str, text: str, identifier: Id = None) -> bytes:
    """Return a status operation as text."""
    fields: dict[str, Any] = {"op": "status", "level": level, "msg": text[:1000]}
    if identifier is not None:
        fields["id"] = identifier
    return orjson.dumps(fields)


@lru_cache(maxsize=256)
def publish_head(topic: str) -> bytes:
    """Return a publish operation up to its message: message and a closing brace follow."""
    return b'{"op":"publish","topic":' + orjson.dumps(topic) + b',"msg":'


_HEAD, _, _NECK = publish_head("\0").partition(orjson.dumps("\0")[1:-1])


def read_published(text: bytes) -> tuple[bytes, bytes] | None:
    """Return topic and message, not decoded, of a text as `write_publish` writes it; None of any other."""
    end = text.find(b'"', len(_HEAD))
    if not text.startswith(_HEAD) or not text.startswith(_NECK, end) or not text.endswith(b"}"):
        return None
    return text[len(_HEAD) : end], text[end + len(_NECK) : -1]


def write_publish(topic: str, message: Any) -> bytes:
    """Return a publish operation. NaN and infinities become null, so that the result is always JSON."""
    return publish_head(topic) + msgspec.json.encode(message) + b"}"
