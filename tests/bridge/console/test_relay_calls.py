"""Calls and goals through the relay that do not fit; what works is in test_relay.py."""

from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.graph_view import GraphOperation
from simconsole.bridge.console.relay_calls import RelayCalls
from simconsole.bridge.protocol.operations import ABORTED, SUCCEEDED

ADD = "example_interfaces/srv/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"


class Bench:
    """The calls of a relay between a router and nobody."""

    def __init__(self, bridge: ConsoleBridge) -> None:
        self.router = bridge.router
        self.session = bridge.router.connect("ros2")
        self.put: list[GraphOperation] = []
        self.calls = RelayCalls(
            bridge.router, self.session, {"service": {"/sum": ADD}, "action": {"/go": FIBONACCI}}, self.put.append
        )


@pytest.fixture
def bench(bridge: ConsoleBridge) -> Bench:
    return Bench(bridge)


def test_an_answer_of_the_graph_that_is_none(bench: Bench, bridge: ConsoleBridge, join: Any) -> None:
    peer = join(bridge)
    bench.router.receive(bench.session, b'{"op":"advertise_service","service":"/sum","type":"%s"}' % ADD.encode(), 0)
    bench.router.receive(bench.session, b'{"op":"advertise_action","action":"/go","type":"%s"}' % FIBONACCI.encode(), 0)
    peer.send(op="call_service", service="/sum", id=1, args={"a": 1}, timeout=3.0)
    peer.send(op="send_action_goal", action="/go", action_type=FIBONACCI, id=2, args={"order": 1}, feedback=True)
    while (text := bench.session.next_text(0)) is not None:
        import orjson

        bench.calls.translate(orjson.loads(text))
    call, goal = bench.put
    assert (call.kind, call.timeout_s, goal.kind) == ("call", 3.0, "goal")
    bench.calls.service_responded(call.key, "/sum", b"\0\1\0\0", "", 0)
    bench.calls.feedback_received(goal.key, "/go", b"", 0)
    bench.calls.goal_ended(goal.key, "/go", b"", SUCCEEDED, "", 0)
    answer, end = peer.heard()
    assert (answer["result"], end["result"]) == (False, False)
    assert "CDR" in answer["values"]


@pytest.mark.parametrize(("part", "kind"), [("call_service", "reply"), ("send_goal", "end")])
def test_what_the_graph_asks_and_nobody_understands(bench: Bench, part: str, kind: str) -> None:
    getattr(bench.calls, part)("one", "/none", b"\0\1\0\0", 0)
    (operation,) = bench.put
    assert (operation.kind, operation.key, operation.data, operation.status) == (kind, "one", None, ABORTED)
    assert operation.text


def test_what_does_not_fit_the_type_of_the_graph(bench: Bench) -> None:
    bench.calls.translate({"op": "call_service", "service": "/sum", "id": "one", "args": {"a": "many"}})
    bench.calls.translate({"op": "call_service", "service": "/gone", "id": "two", "args": {}})
    wrong, gone = bench.put
    assert (wrong.key, wrong.data, "a" in wrong.text) == ("one", None, True)
    assert (gone.data, gone.text) == (None, "it has left the graph")
