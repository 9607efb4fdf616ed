"""`simconsole bridge check`: how a rosbridge server behaves where implementations differ, check by check.

Each check opens a connection of its own and uses a topic that nobody else uses.
"""

import itertools
import json
import time
from collections.abc import Callable
from typing import Any, Final, NamedTuple

from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection, connect

from simconsole.values.errors import BridgeError

_NUMBERS: Final = itertools.count(1)
_PATIENCE_S: Final = 2.0
_QUIET_S: Final = 0.4
"""How long nothing more may come for something to count as not sent."""
_OPEN_S: Final = 5.0
_ODOMETRY: Final = "nav_msgs/msg/Odometry"
_POINT: Final = "geometry_msgs/msg/PointStamped"


class CheckResult(NamedTuple):
    """The result of one check: whether the server follows the protocol, and what it did if not."""

    name: str
    passed: bool
    found: str


class DeviationError(Exception):
    """A server does not do what a check asks."""


class _Connection:
    """One connection to the server."""

    def __init__(self, peer: ClientConnection) -> None:
        self._peer = peer
        self.new_topic()

    def new_topic(self) -> None:
        """Use another topic from now on."""
        self.topic = f"/conformance/t{time.time_ns() % 10**9}_{next(_NUMBERS)}"

    def send(self, **operation: Any) -> None:
        self._peer.send(json.dumps(operation))

    def send_text(self, text: str) -> None:
        self._peer.send(text)

    def receive(self, timeout_s: float = _PATIENCE_S) -> dict[str, Any] | None:
        """Return the next message, decoded strictly, None when none came."""
        try:
            text = self._peer.recv(timeout=timeout_s)
        except TimeoutError:
            return None
        if isinstance(text, bytes):
            return {"op": "binary", "bytes": text}
        try:
            decoded = json.loads(text, parse_constant=_refuse_literal)
        except ValueError as error:
            raise DeviationError(f"sent invalid JSON: {error}") from None
        return decoded if isinstance(decoded, dict) else {}

    def receive_op(self, op: str) -> dict[str, Any]:
        """Return the next message of an operation; others that come before it are ignored."""
        deadline_s = time.monotonic() + _PATIENCE_S
        while (left_s := deadline_s - time.monotonic()) > 0.0:
            message = self.receive(left_s)
            if message is not None and message.get("op") == op:
                return message
        raise DeviationError(f"no {op} came")

    def advertise_and_subscribe(self, kind: str, **more: Any) -> None:
        """Advertise and subscribe this connection's own topic."""
        self.send(op="advertise", topic=self.topic, type=kind)
        self.send(op="subscribe", topic=self.topic, type=kind, **more)

    def echo(self, kind: str, msg: Any, **more: Any) -> dict[str, Any]:
        """Return how a message of this connection comes back to it."""
        self.advertise_and_subscribe(kind, **more)
        self.send(op="publish", topic=self.topic, msg=msg)
        while (published := self.receive_op("publish")).get("topic") != self.topic:
            pass  # of an earlier topic, which some servers deliver twice
        content = published["msg"]
        return content if isinstance(content, dict) else {}


def _refuse_literal(literal: str) -> None:
    raise ValueError(f"the literal {literal}")


def _expect(holds: bool, found: str) -> None:
    if not holds:
        raise DeviationError(found)


def _null_in(connection: _Connection) -> None:
    data = connection.echo("std_msgs/msg/Float64", {"data": None})["data"]
    _expect(data is None, f"null came back as {data}")


def _literal_in(connection: _Connection) -> None:
    connection.advertise_and_subscribe("std_msgs/msg/Float64")
    connection.send_text(f'{{"op":"publish","topic":"{connection.topic}","msg":{{"data":NaN}}}}')
    data = connection.receive_op("publish")["msg"]["data"]
    _expect(data is None, f"NaN came back as {data}")


def _not_a_number_in_array(connection: _Connection) -> None:
    covariance = [None] + [0.0] * 35
    pose = connection.echo(_ODOMETRY, {"pose": {"covariance": covariance}})["pose"]
    _expect(pose["covariance"][0] is None, f"came back as {pose['covariance'][0]}")


def _integer_for_float(connection: _Connection) -> None:
    data = connection.echo("std_msgs/msg/Float64", {"data": 3})["data"]
    _expect(data == 3.0, f"3 came back as {data}")


def _octets(connection: _Connection) -> None:
    data = connection.echo("std_msgs/msg/UInt8MultiArray", {"data": [1, 2, 255]})["data"]
    _expect(data == "AQL/", f"[1, 2, 255] came back as {data}")


def _out_of_range(connection: _Connection) -> None:
    connection.advertise_and_subscribe("std_msgs/msg/UInt8")
    connection.send(op="publish", topic=connection.topic, msg={"data": 999}, id="range")
    status = connection.receive_op("status")
    _expect(status.get("id") == "range", "status without the id")
    _expect("data" in str(status.get("msg")), "status without the field")


def _both_stamps(connection: _Connection) -> None:
    for stamp in ({"sec": 5, "nanosec": 6}, {"secs": 5, "nsecs": 6}):
        header = connection.echo("geometry_msgs/msg/PointStamped", {"header": {"stamp": stamp}})["header"]
        _expect(list(header["stamp"].values()) == [5, 6], f"{stamp} came back as {header['stamp']}")


def _is_stamped(content: dict[str, Any]) -> bool:
    return any(content["header"]["stamp"].values())


def _now(connection: _Connection) -> None:
    _expect(_is_stamped(connection.echo(_POINT, {"header": {"stamp": "now"}})), 'the stamp "now" came back as 0')


def _header_without_stamp(connection: _Connection) -> None:
    _expect(_is_stamped(connection.echo(_POINT, {"header": {"frame_id": "a"}})), "the stamp is 0")


def _no_header(connection: _Connection) -> None:
    _expect(_is_stamped(connection.echo(_POINT, {"point": {"x": 1.0}})), "the stamp is 0")


def _sequence(connection: _Connection) -> None:
    frame = connection.echo(_POINT, {"header": {"seq": 7, "frame_id": "a"}})["header"]["frame_id"]
    _expect(frame == "a", f"frame_id a came back as {frame}")


def _octets_in_base64(connection: _Connection) -> None:
    data = connection.echo("std_msgs/msg/UInt8MultiArray", {"data": "AQL/"})["data"]
    _expect(data == "AQL/", f"AQL/ came back as {data}")


def _long_integer(connection: _Connection) -> None:
    data = connection.echo("std_msgs/msg/Int64", {"data": 2**53 + 1})["data"]
    _expect(data == 2**53 + 1, f"2^53 + 1 came back as {data!r}")


def _slashes(connection: _Connection) -> None:
    data = connection.echo("std_msgs/msg/String", {"data": "a/b\\c"})["data"]
    _expect(data == "a/b\\c", f"a/b\\c came back as {data!r}")


def _missing_fields(connection: _Connection) -> None:
    point = connection.echo("geometry_msgs/msg/Point", {"x": 1.0})
    _expect(point == {"x": 1.0, "y": 0.0, "z": 0.0}, f"came back as {point}")


def _unknown_field(connection: _Connection) -> None:
    connection.advertise_and_subscribe("geometry_msgs/msg/Point")
    connection.send(op="publish", topic=connection.topic, msg={"x": 1.0, "w": 2.0}, id="field")
    status = connection.receive_op("status")
    _expect(status.get("id") == "field" and "w" in str(status.get("msg")), f"status {status}"[:200])


def _other_type(connection: _Connection) -> None:
    connection.advertise_and_subscribe("std_msgs/msg/String")
    connection.send(op="advertise", topic=connection.topic, type="std_msgs/msg/Bool", id="type")
    _expect(connection.receive_op("status").get("id") == "type", "status without the id")


def _fragments_in(connection: _Connection) -> None:
    connection.advertise_and_subscribe("std_msgs/msg/String")
    text = json.dumps({"op": "publish", "topic": connection.topic, "msg": {"data": "in pieces"}})
    half = len(text) // 2
    # The total as rosbridge_suite itself writes it, and the second piece first.
    for number, piece in ((1, text[half:]), (0, text[:half])):
        connection.send(op="fragment", id="f", num=number, total=1.7, data=piece)
    data = connection.receive_op("publish")["msg"]["data"]
    _expect(data == "in pieces", f"came as {data}")


def _latch(connection: _Connection) -> None:
    connection.send(op="advertise", topic=connection.topic, type="std_msgs/msg/String", latch=True)
    connection.send(op="publish", topic=connection.topic, msg={"data": "kept"}, latch=True)
    connection.send(op="subscribe", topic=connection.topic, type="std_msgs/msg/String")
    _expect(connection.receive_op("publish")["msg"]["data"] == "kept", "another message came")


def _both_names(connection: _Connection) -> None:
    for kind in ("std_msgs/String", "std_msgs/msg/String"):
        connection.new_topic()  # some servers take one topic's two spellings for two types
        _expect(connection.echo(kind, {"data": kind})["data"] == kind, f"{kind} did not work")


def _survives_garbage(connection: _Connection) -> None:
    connection.echo("std_msgs/msg/String", {"data": "before"})
    connection.send_text('{"op": "publish", "topic": ')
    connection.send(op="publish", topic=connection.topic, msg={"data": "after"})
    data = "before"  # some servers deliver the first message twice
    while data == "before":
        data = connection.receive_op("publish")["msg"]["data"]
    _expect(data == "after", f"came back as {data}")


def _garbage_has_status(connection: _Connection) -> None:
    connection.send_text('{"op": "publish", "topic": ')
    connection.receive_op("status")


def _unknown_has_status(connection: _Connection) -> None:
    connection.send(op="no_such_operation", id="unknown")
    _expect(connection.receive_op("status").get("id") == "unknown", "status without the id")


def _set_level(connection: _Connection) -> None:
    connection.send(op="set_level", level="error")
    connection.send(op="no_such_operation")
    connection.receive_op("status")  # a server that never sends one obeys nothing
    connection.send(op="set_level", level="none")
    connection.send(op="no_such_operation")
    _expect(connection.receive(_QUIET_S) is None, "a status came in spite of level none")


def _fragments(connection: _Connection) -> None:
    connection.advertise_and_subscribe("std_msgs/msg/String", fragment_size=100)
    identifiers = set()
    for _ in range(2):
        connection.send(op="publish", topic=connection.topic, msg={"data": "x" * 400})
        pieces = [connection.receive_op("fragment")]
        _expect(isinstance(pieces[0]["total"], int), f"total is {pieces[0]['total']}")
        pieces += [connection.receive_op("fragment") for _ in range(pieces[0]["total"] - 1)]
        whole = json.loads("".join(piece["data"] for piece in sorted(pieces, key=lambda piece: int(piece["num"]))))
        _expect(whole["msg"]["data"] == "x" * 400, "the pieces do not make the message")
        identifiers |= {str(piece["id"]) for piece in pieces}
    _expect(len(identifiers) == 2, "two messages in pieces have one id")


def _once(connection: _Connection) -> None:
    connection.advertise_and_subscribe("std_msgs/msg/String", id="first")
    connection.send(op="subscribe", topic=connection.topic, type="std_msgs/msg/String", id="second")
    connection.send(op="publish", topic=connection.topic, msg={"data": "once"})
    connection.receive_op("publish")
    _expect(connection.receive(_QUIET_S) is None, "it came more than once")


def _failed_call(connection: _Connection) -> None:
    connection.send(op="call_service", service=f"{connection.topic}_nothing", id="call")
    answer = connection.receive_op("service_response")
    _expect(answer.get("id") == "call" and answer.get("result") is False, f"answered {answer}"[:200])


def _cbor(connection: _Connection) -> None:
    connection.advertise_and_subscribe("std_msgs/msg/String", compression="cbor")
    connection.send(op="publish", topic=connection.topic, msg={"data": "x"})
    _expect(b"publish" in connection.receive_op("binary")["bytes"], "no publish in the binary message")


CHECKS: Final[dict[str, Callable[[_Connection], None]]] = {
    "NaN literal in is taken, out is null": _literal_in,
    "null in is NaN, out is null": _null_in,
    "NaN in an array goes out as null": _not_a_number_in_array,
    "integer for a float is taken": _integer_for_float,
    "octets go out as base64, a list is taken": _octets,
    "value out of range has a status with id and field": _out_of_range,
    "stamps are taken in both spellings": _both_stamps,
    'the stamp "now" is the present': _now,
    "header without a stamp is stamped now": _header_without_stamp,
    "message without a header is stamped now": _no_header,
    "header's seq is passed over": _sequence,
    "octets are taken in base64": _octets_in_base64,
    "integers above 2^53 come back whole": _long_integer,
    "slashes come back whole": _slashes,
    "missing fields get their defaults": _missing_fields,
    "unknown field has a status with id and field": _unknown_field,
    "advertising with another type has a status with id": _other_type,
    "latched message is for late subscribers": _latch,
    "fragments are taken in any order": _fragments_in,
    "type names are taken in two and three parts": _both_names,
    "malformed JSON does not spoil the next message": _survives_garbage,
    "malformed JSON has a status": _garbage_has_status,
    "unknown operation has a status with id": _unknown_has_status,
    "set_level is obeyed": _set_level,
    "fragments have integer totals and unique ids": _fragments,
    "two subscriptions of one client are one delivery": _once,
    "failed call is answered with result false": _failed_call,
    "cbor comes in binary messages": _cbor,
}


def check(url: str, token: str | None = None) -> list[CheckResult]:
    """Run every check on the server at `url`.

    Raises:
        BridgeError: nobody answers there.
    """
    return [_try(url, token, name, probe) for name, probe in CHECKS.items()]


def _try(url: str, token: str | None, name: str, probe: Callable[[_Connection], None]) -> CheckResult:
    headers = None if token is None else {"Authorization": f"Bearer {token}"}
    try:
        with connect(url, open_timeout=_OPEN_S, close_timeout=1.0, additional_headers=headers) as peer:
            return _probe(peer, name, probe)
    except (OSError, ValueError, WebSocketException) as error:
        raise BridgeError(f"{url}: {error}") from None


def _probe(peer: ClientConnection, name: str, probe: Callable[[_Connection], None]) -> CheckResult:
    try:
        probe(_Connection(peer))
    except DeviationError as deviation:
        return CheckResult(name, False, str(deviation))
    except WebSocketException as error:
        return CheckResult(name, False, f"connection lost: {error}")
    except (KeyError, IndexError, TypeError, AttributeError, ValueError) as error:
        return CheckResult(name, False, f"answered in another form: {error!r}")
    return CheckResult(name, True, "")
