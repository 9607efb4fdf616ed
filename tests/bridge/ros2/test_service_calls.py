"""Calls and goals of rosbridge clients in a graph made by hand; tests/interop/test_ros2.py has a real one."""

import sys
from collections.abc import Callable
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from simconsole.bridge.console.relay import GraphOperation
from simconsole.bridge.protocol.operations import ABORTED, SUCCEEDED
from simconsole.bridge.ros2 import service_calls
from simconsole.bridge.ros2.service_calls import MAX_POLLS, GraphCalls


class Future:
    """What rclpy answers with, once it is told the result."""

    def __init__(self) -> None:
        self.done: list[Callable[[Any], None]] = []
        self.found: Any = None

    def add_done_callback(self, done: Callable[[Any], None]) -> None:
        self.done.append(done)

    def end(self, found: Any) -> None:
        self.found = found
        for done in self.done:
            done(self)

    def result(self) -> Any:
        return self.found

    def exception(self) -> Exception | None:
        return self.found if isinstance(self.found, Exception) else None


class Client:
    """A client of a service, and of an action."""

    def __init__(self, *_: Any, **__: Any) -> None:
        self.ready = True
        self.sent: list[Any] = []
        self.answer = Future()

    def service_is_ready(self) -> bool:
        return self.ready

    server_is_ready = service_is_ready

    def call_async(self, request: Any, **_: Any) -> Future:
        self.sent.append(request)
        return self.answer

    send_goal_async = call_async


class Goal:
    accepted = True

    def __init__(self) -> None:
        self.cancelled = 0
        self.end = Future()

    def get_result_async(self) -> Future:
        return self.end

    def cancel_goal_async(self) -> None:
        self.cancelled += 1


class Bench:
    """The calls of a node, its one client, and what they put into the bridge's inbox."""

    def __init__(self, client: Client) -> None:
        self.client = client
        self.put: list[tuple[Any, ...]] = []
        node = SimpleNamespace(create_client=lambda *_, **__: client)
        self.calls = GraphCalls(node, None, None, lambda *words: self.put.append(words))

    def do(self, kind: Any, data: bytes | None = b"cdr", text: str = "") -> None:
        self.calls.execute(GraphOperation(kind, "/it", "key", "made/it/It", data, text))


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Bench:
    client = Client()
    serialization = {"serialize_message": lambda found: found, "deserialize_message": lambda data, kind: data}
    parts: dict[str, dict[str, Any]] = {
        "action": {"ActionClient": lambda *_, **__: client},
        "serialization": serialization,
    }
    for name, content in parts.items():
        module = ModuleType(f"rclpy.{name}")
        vars(module).update(content)
        monkeypatch.setitem(sys.modules, f"rclpy.{name}", module)
    monkeypatch.setitem(sys.modules, "rclpy", ModuleType("rclpy"))
    monkeypatch.setattr(service_calls, "load", lambda kind: SimpleNamespace(Request=None, Goal=None))
    return Bench(client)


def test_a_call_is_sent_once_the_service_is_there(bench: Bench) -> None:
    bench.client.ready = False
    bench.do("call")
    for _ in range(3):
        bench.calls.poll()
    assert bench.client.sent == []
    bench.client.ready = True
    bench.calls.poll()
    bench.calls.poll()
    assert bench.client.sent == [b"cdr"]
    bench.client.answer.end(b"yes")
    assert bench.put == [("service_responded", "key", "/it", b"yes", "None")]


def test_a_service_that_never_comes_is_looked_for_no_longer(bench: Bench) -> None:
    bench.client.ready = False
    bench.do("call")
    for _ in range(MAX_POLLS + 1):
        bench.calls.poll()
    bench.client.ready = True
    bench.calls.poll()
    assert bench.client.sent == []


def test_a_call_that_fails_is_answered_with_the_reason(bench: Bench) -> None:
    bench.do("call", data=None, text="no such type")
    bench.do("call")
    bench.client.answer.end(RuntimeError("gone"))
    assert bench.put == [
        ("service_responded", "key", "/it", None, "no such type"),
        ("service_responded", "key", "/it", None, "gone"),
    ]


def test_a_goal_that_is_cancelled_before_it_is_accepted_is_cancelled_then(bench: Bench) -> None:
    goal = Goal()
    bench.do("goal")
    bench.do("cancel")
    bench.do("cancel")
    assert goal.cancelled == 0
    bench.client.answer.end(goal)
    assert goal.cancelled == 1
    goal.end.end(SimpleNamespace(result=b"end", status=SUCCEEDED))
    assert bench.put == [("goal_ended", "key", "/it", b"end", SUCCEEDED, "")]
    bench.do("cancel")
    assert goal.cancelled == 1, "it has ended"


def test_a_goal_that_is_not_accepted_is_aborted(bench: Bench) -> None:
    bench.do("goal")
    bench.client.answer.end(SimpleNamespace(accepted=False))
    assert bench.put == [("goal_ended", "key", "/it", None, ABORTED, "the goal was not accepted")]
