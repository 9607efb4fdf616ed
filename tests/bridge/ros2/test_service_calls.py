"""Calls and goals of rosbridge clients in a graph made by hand; tests/interop/test_ros2.py has a real one."""

import sys
from collections.abc import Callable
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from simconsole.bridge.console.graph_view import GraphOperation
from simconsole.bridge.protocol.operations import ABORTED, CANCELED, SUCCEEDED
from simconsole.bridge.ros2 import service_calls
from simconsole.bridge.ros2.endpoints import POLL_S
from simconsole.bridge.ros2.service_calls import IDLE_POLLS, READY_POLLS, WINDOW, GraphCalls


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
        if isinstance(self.found, Exception):
            raise self.found
        return self.found


class Client:
    """A client of a service, and of an action."""

    def __init__(self, *_: Any, **__: Any) -> None:
        self.ready: bool | None = True
        self.broken = False
        self.sent: list[Any] = []
        self.answers: list[Future] = []

    def service_is_ready(self) -> bool:
        if self.ready is None:
            raise RuntimeError("cannot look")
        return self.ready

    server_is_ready = service_is_ready

    def call_async(self, request: Any, **_: Any) -> Future:
        if self.broken:
            raise RuntimeError("cannot send")
        self.sent.append(request)
        self.answers.append(Future())
        return self.answers[-1]

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
        self.destroyed: list[Any] = []
        self.servers = [b"one"]
        """Those of the action."""
        node = SimpleNamespace(
            create_client=lambda *_, **__: client,
            destroy_client=self.destroyed.append,
            get_publishers_info_by_topic=lambda _: [SimpleNamespace(endpoint_gid=gid) for gid in self.servers],
        )
        self.calls = GraphCalls(node, None, lambda *words: self.put.append(words), 30.0)

    def do(self, kind: Any, data: bytes | None = b"cdr", text: str = "", key: str = "key", **more: Any) -> None:
        operation = GraphOperation(kind, "/it", key, "made/it/It", data, text, **more)
        (self.calls.cancel if kind == "cancel" else self.calls.request)(operation)

    def poll(self, times: int) -> None:
        for _ in range(times):
            self.calls.poll()


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Bench:
    client = Client()
    serialization = {"serialize_message": lambda found: found, "deserialize_message": lambda data, kind: data}
    parts: dict[str, dict[str, Any]] = {
        "action": {"ActionClient": lambda *_, **__: client},
        "serialization": serialization,
        "qos": {"QoSProfile": lambda **_: None},
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
    bench.poll(3)
    assert bench.client.sent == []
    bench.client.ready = True
    bench.poll(2)
    assert bench.client.sent == [b"cdr"]
    bench.client.answers[0].end(b"yes")
    assert bench.put == [("service_responded", "key", "/it", b"yes", "")]
    assert bench.calls.open == 0


def test_a_service_that_never_comes_is_said_to_after_a_second(bench: Bench) -> None:
    bench.client.ready = False
    bench.do("call")
    bench.poll(READY_POLLS)
    assert bench.put == []
    bench.poll(1)
    ((event, key, _, data, why),) = bench.put
    assert (event, key, data) == ("service_responded", "key", None)
    assert "not there within a second" in why
    bench.client.ready = True
    bench.poll(1)
    assert bench.client.sent == []


def test_no_more_are_on_their_way_than_a_service_holds(bench: Bench) -> None:
    for number in range(3 * WINDOW):
        bench.do("call", key=str(number))
    assert len(bench.client.sent) == WINDOW
    for number in range(3 * WINDOW):
        bench.client.answers[number].end(b"yes")
    assert [words[1] for words in bench.put] == [str(number) for number in range(3 * WINDOW)]


def test_a_call_that_nobody_answers_ends_and_makes_room(bench: Bench) -> None:
    for number in range(WINDOW + 1):
        bench.do("call", key=str(number), timeout_s=2.0)
    bench.poll(round(2.0 / POLL_S) + 2)
    assert [words[1] for words in bench.put] == [str(number) for number in range(WINDOW)]
    assert all("time limit" in words[-1] for words in bench.put)
    assert len(bench.client.sent) == WINDOW + 1
    bench.client.answers[0].end(b"late")
    assert len(bench.put) == WINDOW


def test_what_is_with_a_service_that_leaves_is_failed(bench: Bench) -> None:
    goal = Goal()
    bench.do("call")
    bench.do("goal", key="goal")
    bench.client.answers[1].end(goal)
    bench.client.ready = False
    bench.poll(READY_POLLS + 1)
    assert [words[:2] for words in bench.put] == [("service_responded", "key"), ("goal_ended", "goal")]
    goal.end.end(SimpleNamespace(result=b"end", status=SUCCEEDED))
    assert len(bench.put) == 2


def test_an_end_that_nobody_uses_is_destroyed(bench: Bench) -> None:
    bench.do("call")
    bench.client.answers[0].end(b"yes")
    assert len(bench.calls) == 1
    bench.poll(IDLE_POLLS + 1)
    assert (len(bench.calls), bench.destroyed) == (0, [bench.client])


def test_a_call_that_fails_is_answered_with_the_reason(bench: Bench) -> None:
    bench.do("call", data=None, text="no such type")
    bench.do("call")
    bench.client.answers[0].end(RuntimeError("gone"))
    bench.client.broken = True
    bench.do("call")
    assert bench.put == [
        ("service_responded", "key", "/it", None, "no such type"),
        ("service_responded", "key", "/it", None, "gone"),
        ("service_responded", "key", "/it", None, "cannot send"),
    ]
    bench.client.ready = None  # whatever asks it raises
    bench.do("goal", key="other")
    assert bench.put[-1] == ("goal_ended", "other", "/it", None, ABORTED, "cannot look")


def test_a_goal_that_is_cancelled_before_it_is_sent(bench: Bench) -> None:
    bench.client.ready = False
    bench.do("goal")
    bench.do("cancel")
    assert bench.put == [("goal_ended", "key", "/it", None, CANCELED, "cancelled before it was sent")]
    bench.client.ready = True
    bench.poll(1)
    assert bench.client.sent == []


def test_a_goal_that_is_cancelled_before_it_is_accepted_is_cancelled_then(bench: Bench) -> None:
    goal = Goal()
    bench.do("goal")
    bench.do("cancel")
    bench.do("cancel")
    assert goal.cancelled == 0
    bench.client.answers[0].end(goal)
    assert goal.cancelled == 1
    goal.end.end(SimpleNamespace(result=b"end", status=SUCCEEDED))
    assert bench.put == [("goal_ended", "key", "/it", b"end", SUCCEEDED, "")]
    bench.do("cancel")
    assert goal.cancelled == 1, "it has ended"


@pytest.mark.parametrize(("before", "later"), [([b"one", b"two"], []), ([b"one"], [b"two"])])
@pytest.mark.parametrize("leaves", [b"one", b"two"])
def test_a_goal_ends_when_a_server_leaves_that_may_have_accepted_it(
    bench: Bench, before: list[bytes], later: list[bytes], leaves: bytes
) -> None:
    bench.servers = before
    bench.do("goal")
    goal = Goal()
    bench.client.answers[0].end(goal)
    bench.servers = [*before, *later]
    bench.poll(2)
    bench.servers = [gid for gid in bench.servers if gid != leaves]
    bench.poll(READY_POLLS)
    assert bench.put == []
    bench.poll(1)
    ((event, key, _, data, status, why),) = bench.put
    assert (event, key, data, status) == ("goal_ended", "key", None, ABORTED)
    assert "has left the graph" in why
    assert goal.cancelled == 1
    assert bench.calls.open == 0


def test_a_server_that_comes_long_after_a_goal_was_accepted_may_leave(bench: Bench) -> None:
    bench.do("goal")
    bench.client.answers[0].end(Goal())
    bench.poll(READY_POLLS + 1)
    bench.servers = [b"one", b"two"]
    bench.poll(5)
    bench.servers = [b"one"]
    bench.poll(2 * READY_POLLS)
    assert bench.put == []
    assert bench.calls.open == 1


def test_a_goal_that_is_not_accepted_is_aborted(bench: Bench) -> None:
    bench.do("goal")
    bench.client.answers[0].end(SimpleNamespace(accepted=False))
    assert bench.put == [("goal_ended", "key", "/it", None, ABORTED, "the goal was not accepted")]


def test_a_goal_that_a_server_does_not_know_ends_and_is_cancelled_at_any_other(bench: Bench) -> None:
    bench.do("goal")
    goal = Goal()
    bench.client.answers[0].end(goal)
    goal.end.end(SimpleNamespace(result=None, status=0))
    ((event, key, _, data, status, why),) = bench.put
    assert (event, key, data, status) == ("goal_ended", "key", None, ABORTED)
    assert "does not know the goal" in why
    assert goal.cancelled == 1
