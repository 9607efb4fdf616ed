"""Services and actions of clients in a graph made by hand; tests/interop/test_relay_survives.py has a real one."""

import sys
from collections.abc import Generator
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from simconsole.bridge.console.graph_view import GraphOperation
from simconsole.bridge.protocol.operations import CANCELED, SUCCEEDED
from simconsole.bridge.ros2 import offered_calls
from simconsole.bridge.ros2.offered_calls import LINGER_POLLS, OfferedCalls


class Future:
    """Awaited until it has a result."""

    def __init__(self, **_: Any) -> None:
        self.found: Any = None

    def set_result(self, found: Any) -> None:
        self.found = found

    def __await__(self) -> Generator[None, None, Any]:
        while self.found is None:
            yield
        return self.found


class Goal:
    """A goal of the graph, and what became of it."""

    def __init__(self, number: int = 1) -> None:
        self.request = b"goal"
        self.goal_id = SimpleNamespace(uuid=bytes([number]))
        self.is_cancel_requested = False
        self.feedback: list[Any] = []
        self.end = ""

    def publish_feedback(self, feedback: Any) -> None:
        self.feedback.append(feedback)

    def succeed(self) -> None:
        self.end = "succeeded"

    def abort(self) -> None:
        self.end = "aborted"

    def canceled(self) -> None:
        self.end = "canceled"


class Bench:
    """What a node offers, its one service and action, and what they put into the bridge's inbox."""

    def __init__(self) -> None:
        self.put: list[tuple[Any, ...]] = []
        self.destroyed: list[Any] = []
        self.serve: Any = None
        self.action: dict[str, Any] = {}
        self.woken = 0
        node = SimpleNamespace(create_service=self._service, destroy_service=self.destroyed.append)
        executor = SimpleNamespace(wake=self._wake)
        self.offered = OfferedCalls(node, executor, None, lambda *words: self.put.append(words))

    def _wake(self) -> None:
        self.woken += 1

    def _service(self, types: Any, name: str, serve: Any, **_: Any) -> Any:
        self.serve = serve
        return SimpleNamespace(send_response=None)

    def server(self, node: Any, types: Any, name: str, execute: Any, **more: Any) -> Any:
        self.action = {"execute": execute, **more}
        endpoint = SimpleNamespace()
        endpoint.destroy = lambda: self.destroyed.append(endpoint)
        return endpoint

    def finish(self, data: bytes | None, status: int = 0, text: str = "") -> None:
        self.offered.finish(GraphOperation("end", "/it", self.put[-1][1], data=data, status=status, text=text))


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Bench:
    made = Bench()
    words = SimpleNamespace(ACCEPT="accept", REJECT="reject")
    parts: dict[str, dict[str, Any]] = {
        "action": {"ActionServer": made.server, "CancelResponse": words, "GoalResponse": words},
        "serialization": {"serialize_message": lambda it: it, "deserialize_message": lambda data, kind: data},
        "qos": {"QoSProfile": lambda **_: None},
        "task": {"Future": Future},
    }
    monkeypatch.setitem(sys.modules, "rclpy", ModuleType("rclpy"))
    for name, content in parts.items():
        module = ModuleType(f"rclpy.{name}")
        vars(module).update(content)
        monkeypatch.setitem(sys.modules, f"rclpy.{name}", module)
    types = SimpleNamespace(Response=None, Result=lambda: b"empty", Feedback=None)
    monkeypatch.setattr(offered_calls, "load", lambda kind: types)
    return made


def turn(coroutine: Any) -> Any:
    """Run a coroutine as far as it goes; return its result once it has one."""
    try:
        coroutine.send(None)
    except StopIteration as end:
        return end.value
    return None


def test_a_request_is_answered(bench: Bench) -> None:
    bench.offered.make_service("/it", "made/srv/It")
    request = bench.serve(b"ask", b"default")
    assert turn(request) is None
    assert bench.put == [("call_service", "graph:1", "/it", b"ask")]
    bench.finish(b"answer")
    assert bench.woken
    assert turn(request) == b"answer"
    assert bench.offered.open == 0


def test_a_request_that_fails_gets_the_default_answer(bench: Bench) -> None:
    bench.offered.make_service("/it", "made/srv/It")
    request = bench.serve(b"ask", b"default")
    turn(request)
    bench.finish(None, text="no")
    assert turn(request) == b"default"
    assert bench.put[-1] == ("remarked", "/it", "no")


def test_a_service_is_answered_before_it_is_destroyed(bench: Bench) -> None:
    offered = bench.offered.make_service("/it", "made/srv/It")
    request = bench.serve(b"ask", b"default")
    turn(request)
    assert not bench.offered.end(offered)
    late = bench.serve(b"ask", b"default")
    assert turn(late) == b"default", "its provider has left"
    for _ in range(LINGER_POLLS):
        bench.offered.poll()
    assert not bench.offered.end(offered), "one is not yet answered"
    assert turn(request) == b"default"
    assert bench.offered.end(offered)
    assert bench.destroyed == [offered.endpoint]


@pytest.mark.parametrize(
    ("data", "status", "cancelled", "end"),
    [
        (b"result", SUCCEEDED, False, "succeeded"),
        (b"result", CANCELED, True, "canceled"),
        (b"result", CANCELED, False, "aborted"),  # nobody has asked for that
        (None, SUCCEEDED, False, "aborted"),
    ],
)
def test_a_goal_ends(bench: Bench, data: bytes | None, status: int, cancelled: bool, end: str) -> None:
    bench.offered.make_action("/it", "made/action/It")
    goal = Goal()
    pursuit = bench.action["execute"](goal)
    turn(pursuit)
    assert bench.put == [("send_goal", "graph:1", "/it", b"goal")]
    bench.offered.publish_feedback(GraphOperation("feedback", "/it", "graph:1", data=b"half"))
    bench.offered.publish_feedback(GraphOperation("feedback", "/it", "graph:2", data=b"nobody's"))
    assert goal.feedback == [b"half"]
    goal.is_cancel_requested = cancelled
    bench.finish(data, status)
    assert turn(pursuit) == (data or b"empty")
    assert goal.end == end


def test_a_goal_is_cancelled(bench: Bench) -> None:
    bench.offered.make_action("/it", "made/action/It")
    goal = Goal()
    pursuit = bench.action["execute"](goal)
    turn(pursuit)
    assert bench.action["cancel_callback"](goal) == "accept"
    assert bench.put[-1] == ("cancel", "graph:1", "/it")
    assert bench.action["cancel_callback"](Goal(2)) == "reject"


def test_an_action_whose_provider_leaves_aborts_its_goals_and_takes_no_more(bench: Bench) -> None:
    offered = bench.offered.make_action("/it", "made/action/It")
    goal = Goal()
    pursuit = bench.action["execute"](goal)
    turn(pursuit)
    assert turn(bench.action["goal_callback"](None)) == "accept"
    assert not bench.offered.end(offered)
    assert turn(bench.action["goal_callback"](None)) == "reject"
    assert turn(pursuit) == b"empty"
    assert goal.end == "aborted"
    for _ in range(LINGER_POLLS):
        bench.offered.poll()
    assert bench.offered.end(offered)
    assert bench.destroyed == [offered.endpoint]
