"""Services and actions between clients: every call has an end, and nothing of it stays."""

import struct
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile
from simconsole.values.errors import RemoteProtocolError
from tests.bridge.reading import read_any

ADD = {"service": "/add", "type": "example_interfaces/AddTwoInts"}
FIBONACCI = {"action": "/fibonacci", "type": "example_interfaces/action/Fibonacci"}
S = 1_000_000_000


@pytest.fixture
def pair(bridge: ConsoleBridge, join: Callable[..., Any]) -> tuple[Any, Any]:
    """Who provides /add and /fibonacci, and who asks."""
    provider, caller = join(bridge), join(bridge)
    assert provider.send(op="advertise_service", **ADD).kind == "done"
    assert provider.send(op="advertise_action", **FIBONACCI).kind == "done"
    return provider, caller


def request(provider: Any) -> dict[str, Any]:
    (asked,) = provider.heard()
    return asked  # type: ignore[no-any-return]  # a decoded object


def answer(caller: Any) -> dict[str, Any]:
    (answered,) = caller.heard()
    return answered  # type: ignore[no-any-return]  # a decoded object


@pytest.mark.parametrize("args", [{"a": 2, "b": 40}, [2, 40]])
def test_call_and_answer(pair: tuple[Any, Any], args: Any) -> None:
    provider, caller = pair
    assert caller.send(op="call_service", service="add", id="q", args=args).kind == "done"
    asked = request(provider)
    assert (asked["op"], asked["service"], asked["args"]) == ("call_service", "/add", {"a": 2, "b": 40})
    provider.send(op="service_response", service="/add", id=asked["id"], values={"sum": 42}, result=True)
    assert answer(caller) == {
        "op": "service_response", "service": "add", "id": "q", "values": {"sum": 42}, "result": True,
    }  # fmt: skip
    assert provider.bridge.router.calls.open == 0
    assert provider.send(op="service_response", service="/add", id=asked["id"], values={}).kind == "refused"


def test_slow_provider_holds_up_nobody(pair: tuple[Any, Any]) -> None:
    provider, caller = pair
    for number in range(3):
        caller.send(op="call_service", service="/add", id=number, args=[number, 1])
    asked = provider.heard()
    for one in reversed(asked):
        provider.send(op="service_response", service="/add", id=one["id"], values={"sum": one["args"]["a"] + 1})
    assert [(got["id"], got["values"]["sum"]) for got in caller.heard()] == [(2, 3), (1, 2), (0, 1)]


@pytest.mark.parametrize(
    ("operation", "complaint"),
    [
        ({"service": "/nothing"}, "nobody provides"),
        ({"service": "/add", "args": {"c": 1}}, "unknown field `c`"),
        ({"service": "/add", "args": {"a": "x"}}, "`$.a`"),
        ({"service": "/add", "args": [1, 2, 3]}, "3 arguments, expected at most 2"),
        ({"service": "/add", "args": "x"}, "args must be an object or an array"),
    ],
)
def test_failed_call_is_answered_with_why(pair: tuple[Any, Any], operation: dict[str, Any], complaint: str) -> None:
    provider, caller = pair
    assert caller.send(op="call_service", id="q", **operation).kind == "done"
    got = answer(caller)
    assert (got["op"], got["id"], got["result"]) == ("service_response", "q", False)
    assert complaint in got["values"]
    assert provider.heard() == []
    assert provider.bridge.router.calls.open == 0


@pytest.mark.parametrize(
    ("response", "expected"),
    [
        ({"result": False, "values": "no"}, ("no", False)),
        ({"result": False, "values": {}}, ({}, False)),
        ({"result": False, "values": {"sum": 1}}, ({"sum": 1}, True)),
        ({"values": {}}, ({"sum": 0}, True)),
        ({}, ({}, True)),
        ({"values": {"sum": "x"}}, ("/add: the answer does not fit: Expected `int`, got `str` - at `$.sum`", False)),
    ],
)
def test_answers(pair: tuple[Any, Any], response: dict[str, Any], expected: tuple[Any, bool]) -> None:
    provider, caller = pair
    caller.send(op="call_service", service="/add", id="q")
    asked = request(provider)
    provider.send(op="service_response", service="/add", id=asked["id"], **response)
    got = answer(caller)
    assert (got["values"], got["result"]) == expected


def test_call_without_an_answer_ends_at_its_time(pair: tuple[Any, Any]) -> None:
    provider, caller = pair
    caller.send(op="call_service", service="/add", id="long")
    caller.send(op="call_service", service="/add", id="short", timeout=2)
    calls = provider.bridge.router.calls
    calls.expire(2 * S - 1)
    assert caller.heard() == []
    calls.expire(2 * S)
    assert answer(caller)["id"] == "short"
    calls.expire(30 * S)
    got = answer(caller)
    assert (got["id"], got["values"]) == ("long", "/add: no answer within the time limit")
    assert calls.open == 0
    calls.expire(99 * S)


def test_end_of_either_side_ends_the_call(bridge: ConsoleBridge, pair: tuple[Any, Any]) -> None:
    provider, caller = pair
    caller.send(op="call_service", service="/add", id="q")
    caller.send(op="send_action_goal", id="g", action="/fibonacci", args={"order": 1})
    bridge.disconnect(provider.session, 0)
    values = [(got["op"], got["values"]) for got in caller.heard()]
    assert values == [
        ("service_response", "/add: whoever was asked is gone"),
        ("action_result", "/fibonacci: whoever was asked is gone"),
    ]
    assert bridge.router.calls.services().get("/add") is None
    assert bridge.router.calls.actions() == {}


def test_caller_that_goes_takes_its_calls_along(bridge: ConsoleBridge, pair: tuple[Any, Any]) -> None:
    provider, caller = pair
    caller.send(op="call_service", service="/add", id="q")
    caller.send(op="send_action_goal", id="g", action="/fibonacci", args={"order": 1})
    asked, goal = provider.heard()
    bridge.disconnect(caller.session, 0)
    assert request(provider) == {"op": "cancel_action_goal", "action": "/fibonacci", "id": goal["id"]}
    assert provider.send(op="service_response", service="/add", id=asked["id"], values={}).kind == "refused"
    assert bridge.router.calls.open == 0


def test_withdrawn_service_fails_what_waits(pair: tuple[Any, Any]) -> None:
    provider, caller = pair
    caller.send(op="call_service", service="/add", id="q")
    provider.send(op="unadvertise_service", service="/add")
    assert answer(caller)["values"] == "/add: it is no longer provided"
    assert provider.send(op="unadvertise_service", service="/add").kind == "refused"
    assert provider.send(op="unadvertise_action", action="/fibonacci").kind == "done"


def test_service_belongs_to_one_client(bridge: ConsoleBridge, pair: tuple[Any, Any]) -> None:
    provider, other = pair
    assert "somebody else" in other.send(op="advertise_service", **ADD).text
    assert provider.send(op="advertise_service", **ADD).kind == "done"
    assert other.send(op="unadvertise_service", service="/add").kind == "refused"
    other.send(op="call_service", service="/add", id="q")
    asked = provider.heard()[-1]
    assert other.send(op="service_response", service="/add", id=asked["id"], values={}).kind == "refused"
    assert bridge.router.calls.providers() == {"/add": provider.session.number}


def test_numbers_of_calls_and_services_are_bounded(join: Callable[..., Any]) -> None:
    bridge = ConsoleBridge(BridgeProfile(port=0, limits=BridgeLimits(calls=2, topics=32)))
    provider, caller = join(bridge), join(bridge)
    answers = [provider.send(op="advertise_service", service=f"/s{n}", type="demo/X").text for n in range(33)]
    assert [bool(text) for text in answers] == [False] * 32 + [True]
    for number in range(3):
        caller.send(op="call_service", service="/s0", id=number)
    got = answer(caller)
    assert (got["id"], got["result"]) == (2, False)
    assert "2 calls at a time" in got["values"]


def test_unknown_type_is_passed_on_as_it_is(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    provider, caller = join(bridge), join(bridge)
    assert provider.send(op="advertise_service", service="/own", type="demo/Own").kind == "done"
    caller.send(op="call_service", service="/own", id="q", args=[{"x": [1, None]}])
    asked = request(provider)
    assert asked["args"] == [{"x": [1, None]}]
    provider.send(op="service_response", service="/own", id=asked["id"], values={"anything": 1})
    assert answer(caller)["values"] == {"anything": 1}


def test_service_of_the_console(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    def add(args: dict[str, Any], dialect: str) -> dict[str, Any]:
        if args["a"] < 0:
            raise RemoteProtocolError("a must not be negative")
        return {"sum": args["a"] + args["b"]}

    bridge.router.calls.add_builtin("/console/add", "example_interfaces/srv/AddTwoInts", add)
    caller = join(bridge)
    caller.send(op="call_service", service="/console/add", args={"a": 1})
    assert answer(caller) == {
        "op": "service_response", "service": "/console/add", "values": {"sum": 1}, "result": True,
    }  # fmt: skip
    caller.send(op="call_service", service="/console/add", args={"a": -1})
    assert answer(caller)["values"] == "/console/add: a must not be negative"
    assert caller.send(op="advertise_service", service="/console/add", type="x/Y").kind == "refused"
    assert bridge.router.calls.services()["/console/add"] == "example_interfaces/srv/AddTwoInts"


def test_long_answer_comes_in_pieces(pair: tuple[Any, Any]) -> None:
    provider, caller = pair
    caller.send(op="call_service", service="/add", id="q", fragment_size=30)
    asked = request(provider)
    provider.send(op="service_response", service="/add", id=asked["id"], values={"sum": 1})
    pieces = caller.heard()
    assert len(pieces) == pieces[0]["total"] > 1


def test_goal_with_feedback_and_result(pair: tuple[Any, Any]) -> None:
    provider, caller = pair
    caller.send(op="send_action_goal", id="g", action="/fibonacci", args={"order": 2}, feedback=True)
    goal = request(provider)
    assert (goal["op"], goal["args"], goal["feedback"]) == ("send_action_goal", {"order": 2}, True)
    assert goal["action_type"] == FIBONACCI["type"]
    told = {"action": "/fibonacci", "id": goal["id"]}
    provider.send(op="action_feedback", values={"sequence": [0]}, **told)
    provider.send(op="action_result", values={"sequence": [0, 1]}, status=4, result=True, **told)
    feedback, result = caller.heard()
    assert feedback == {"op": "action_feedback", "action": "/fibonacci", "id": "g", "values": {"sequence": [0]}}
    assert (result["id"], result["values"], result["status"], result["result"]) == ("g", {"sequence": [0, 1]}, 4, True)
    assert provider.send(op="action_feedback", values={}, **told).kind == "refused"


def test_feedback_nobody_asked_for_is_not_sent(pair: tuple[Any, Any]) -> None:
    provider, caller = pair
    caller.send(op="send_action_goal", id="g", action="/fibonacci", args={})
    goal = request(provider)
    assert provider.send(op="action_feedback", action="/fibonacci", id=goal["id"], values={}).kind == "done"
    assert caller.heard() == []


def test_cancelled_goal(pair: tuple[Any, Any]) -> None:
    provider, caller = pair
    caller.send(op="send_action_goal", id="g", action="/fibonacci", args={})
    goal = request(provider)
    assert caller.send(op="cancel_action_goal", action="/fibonacci", id="other").kind == "refused"
    assert provider.send(op="cancel_action_goal", action="/fibonacci", id="g").kind == "refused"
    assert len(provider.statuses()) == len(caller.statuses()) == 1
    caller.send(op="cancel_action_goal", action="/fibonacci", id="g")
    assert request(provider) == {"op": "cancel_action_goal", "action": "/fibonacci", "id": goal["id"]}
    provider.send(op="action_result", action="/fibonacci", id=goal["id"], values={}, status=5, result=False)
    got = answer(caller)
    assert (got["status"], got["result"]) == (5, False)


def test_cancelling_without_an_id_cancels_every_goal_of_that_client(
    bridge: ConsoleBridge, pair: tuple[Any, Any], join: Callable[..., Any]
) -> None:
    provider, caller = pair
    other = join(bridge)
    for client, goal in ((caller, "a"), (caller, "b"), (other, "c")):
        client.send(op="send_action_goal", id=goal, action="/fibonacci", args={})
    goals = [asked["id"] for asked in provider.heard()]
    assert caller.send(op="cancel_action_goal", action="/fibonacci").kind == "done"
    assert [(message["op"], message["id"]) for message in provider.heard()] == [
        ("cancel_action_goal", goals[0]),
        ("cancel_action_goal", goals[1]),
    ]


def test_goal_that_cannot_be_pursued(pair: tuple[Any, Any]) -> None:
    provider, caller = pair
    for action, args in (("/nothing", {}), ("/fibonacci", {"order": "x"})):
        caller.send(op="send_action_goal", id="g", action=action, args=args)
        got = answer(caller)
        assert (got["op"], got["status"], got["result"]) == ("action_result", 6, False)
    caller.send(op="send_action_goal", id="g", action="/fibonacci")
    goal = request(provider)
    bad = provider.send(op="action_result", action="/fibonacci", id=goal["id"], values={"sequence": 1})
    assert bad.kind == "refused"
    assert "does not fit" in answer(caller)["values"]


def test_dialect_of_each_side(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    bridge.router.registry.add_service("demo/At", "time when\n---\nbuiltin_interfaces/Time then\n")
    provider, caller = join(bridge), join(bridge)
    provider.session.dialect = "ros1"
    provider.send(op="advertise_service", service="/at", type="demo/At")
    caller.send(op="call_service", service="/at", args={"when": {"sec": 1, "nanosec": 2}})
    asked = request(provider)
    assert asked["args"] == {"when": {"secs": 1, "nsecs": 2}}
    provider.send(op="service_response", service="/at", id=asked["id"], values={"then": {"secs": 3, "nsecs": 4}})
    assert answer(caller)["values"] == {"then": {"sec": 3, "nanosec": 4}}


@pytest.mark.parametrize("compression", ["none", "png", "cbor", "cbor-raw"])
def test_answers_come_in_the_form_that_was_asked_for(
    bridge: ConsoleBridge, join: Callable[..., Any], compression: str
) -> None:
    bridge.router.registry.add_service("test_msgs/Scan", "---\nfloat32[] ranges\nuint8[] octets\n")
    provider, caller = join(bridge), join(bridge)
    provider.send(op="advertise_service", service="/scan", type="test_msgs/Scan")
    provider.send(op="advertise_action", action="/look", type="test_msgs/Look")
    caller.send(op="call_service", service="/scan", id="q", compression=compression)
    caller.send(op="send_action_goal", action="/look", id="g", feedback=True, compression=compression)
    caller.send(op="call_service", service="/nothing", id="n", compression=compression)
    asked, goal = provider.heard()
    values = {"ranges": [0.5, None], "octets": "AQI="}
    provider.send(op="service_response", service="/scan", id=asked["id"], values=values)
    provider.send(op="action_feedback", action="/look", id=goal["id"], values={"far": 1})
    provider.send(op="action_result", action="/look", id=goal["id"], values={"seen": [1]}, status=4)
    answers = []
    while (text := caller.session.next_text(0)) is not None:
        assert isinstance(text, Binary) is compression.startswith("cbor")
        answers.append(read_any(text))
    assert [answer["op"] for answer in answers] == [
        "service_response", "service_response", "action_feedback", "action_result",
    ]  # fmt: skip
    failed, answered, feedback, result = answers
    assert (failed["id"], failed["result"]) == ("n", False)
    assert feedback["values"] == {"far": 1}
    assert (result["values"], result["status"]) == ({"seen": [1]}, 4)
    if compression.startswith("cbor"):
        tag = answered["values"]["ranges"]
        assert tag.tag == 85
        assert struct.unpack("<2f", tag.value)[0] == 0.5
        assert answered["values"]["octets"] == b"\x01\x02"
    else:
        assert answered["values"] == values


@pytest.mark.parametrize(
    ("operation", "answer"),
    [
        ({"op": "call_service", "service": "/add"}, "service_response"),
        ({"op": "send_action_goal", "action": "/go"}, "action_result"),
    ],
)
def test_who_may_not_call_is_answered_too(
    bridge: ConsoleBridge, join: Callable[..., Any], operation: dict[str, str], answer: str
) -> None:
    peer = join(bridge)
    peer.session.role = Role.NONE
    peer.send(id="mine", **operation)
    status, response = peer.heard()
    assert status["op"] == "status"
    assert (response["op"], response["id"], response["result"]) == (answer, "mine", False)
    assert "you have no token" in response["values"]


def test_what_ends_leaves_the_calls_of_others_alone(
    bridge: ConsoleBridge, join: Callable[..., Any], pair: tuple[Any, Any]
) -> None:
    provider, caller = pair
    other = join(bridge)
    other.send(op="advertise_service", service="/other", type="std_srvs/Empty")
    caller.send(op="call_service", service="/add", id="kept")
    other.send(op="unadvertise_service", service="/other")
    bridge.disconnect(other.session, 0)
    assert bridge.router.calls.open == 1
    asked = request(provider)
    provider.send(op="service_response", service="/add", id=asked["id"], values={"sum": 1})
    assert answer(caller)["id"] == "kept"
