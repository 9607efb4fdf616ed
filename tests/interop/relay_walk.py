"""A random walk of rosbridge clients and ROS 2 nodes, who do to each other whatever they can do."""

import json
import threading
from collections.abc import Callable
from contextlib import ExitStack
from random import Random
from typing import Any, Final

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from tests.interop.programs import Client
from tests.interop.puppets import Puppet
from tests.patience import wait_until

TOPICS: Final = ("/walk/a", "/walk/b", "/walk/c")
TYPES: Final = ("std_msgs/String", "std_msgs/Int32")
DATA: Final[dict[str, Any]] = {"std_msgs/String": "text", "std_msgs/Int32": 7}
SERVICES: Final = ("/walk/web/flip", "/walk/web/flop", "/walk/ros/flip", "/walk/ros/flop")
ACTIONS: Final = ("/walk/web/go", "/walk/ros/go")
FLIP: Final = "std_srvs/srv/SetBool"
FIBONACCI: Final = "test_msgs/action/Fibonacci"
TIMEOUT_S: Final = 5.0
SUCCEEDED: Final = 4


class Walker:
    """One client, in as many connections as it pleases. It answers what it is asked, mostly."""

    def __init__(self, url: str, random: Random) -> None:
        self._url = url
        self._random = random
        self._numbers = 0
        self.sent = 0
        self.answered = 0
        self.unexpected: list[Any] = []
        """Answers that nobody waits for, and failures without a reason, of all connections."""
        self.connect()

    def connect(self) -> None:
        self.waiting: dict[str, str] = {}
        """Calls and goals without an end, on the present connection."""
        self._stack = ExitStack()
        self._web = self._stack.enter_context(connect(self._url, close_timeout=0.2, max_size=None))
        threading.Thread(target=self._read, args=(self._web, self.waiting), daemon=True).start()

    def close(self) -> None:
        self._stack.close()

    def step(self) -> None:
        """Do one thing."""
        random = self._random
        topic, kind = random.choice(TOPICS), random.choice(TYPES)
        service, action = random.choice(SERVICES), random.choice(ACTIONS)
        acts: list[tuple[float, Callable[[], None]]] = [
            (3.0, lambda: self.say(op="subscribe", topic=topic, type=kind)),
            (3.0, lambda: self.say(op="unsubscribe", topic=topic)),
            (3.0, lambda: self.say(op="advertise", topic=topic, type=kind, latch=random.random() < 0.3)),
            (3.0, lambda: self.say(op="unadvertise", topic=topic)),
            (9.0, lambda: self.say(op="publish", topic=topic, msg={"data": DATA[kind]})),
            (3.0, lambda: self.say(op="advertise_service", service=service, type=FLIP)),
            (2.0, lambda: self.say(op="unadvertise_service", service=service)),
            (2.0, lambda: self.say(op="advertise_action", action=action, type=FIBONACCI)),
            (2.0, lambda: self.say(op="unadvertise_action", action=action)),
            (9.0, lambda: self._call(service)),
            (4.0, lambda: self._pursue(action)),
            (2.0, self._cancel),
            (1.0, lambda: self.say(op="advertise", topic="/" + "n" * random.randint(240, 255), type=kind)),
            (1.0, lambda: self.say(op="advertise_service", service="/walk/odd", type=random.choice(("a/b/c/d", "a")))),
            (0.5, self._again),
        ]
        weights, choices = zip(*acts, strict=True)
        random.choices(choices, weights)[0]()

    def say(self, **operation: Any) -> None:
        self._web.send(json.dumps(operation))

    def is_done(self) -> bool:
        return not self.waiting

    def _again(self) -> None:
        self.close()
        self.connect()

    def _identify(self, name: str) -> str:
        self._numbers += 1
        self.sent += 1
        identifier = f"{name}#{self._numbers}"
        self.waiting[identifier] = name
        return identifier

    def _call(self, service: str) -> None:
        args = {"data": self._random.random() < 0.5}
        self.say(op="call_service", id=self._identify(service), service=service, args=args, timeout=TIMEOUT_S)

    def _pursue(self, action: str) -> None:
        goal = {"action": action, "action_type": FIBONACCI, "args": {"order": 3}, "feedback": True}
        self.say(op="send_action_goal", id=self._identify(action), **goal)

    def _cancel(self) -> None:
        goals = [identifier for identifier, name in list(self.waiting.items()) if name in ACTIONS]
        if goals:
            identifier = self._random.choice(goals)
            self.say(op="cancel_action_goal", action=identifier.partition("#")[0], id=identifier)

    def _read(self, web: Any, waiting: dict[str, str]) -> None:
        answers = Random(0)  # of this thread's own
        try:
            for text in web:
                self._hear(web, waiting, json.loads(text), answers)
        except ConnectionClosed:
            return

    def _hear(self, web: Any, waiting: dict[str, str], heard: dict[str, Any], answers: Random) -> None:
        match heard["op"]:
            case "service_response" | "action_result":
                if waiting.pop(heard["id"], None) is None or (heard["result"] is False and not heard["values"]):
                    self.unexpected.append(heard)
                self.answered += 1
            case "call_service":
                good = answers.random() < 0.8
                values = {"success": True, "message": "web"} if good else "no"
                told = {"service": heard["service"], "id": heard["id"], "values": values, "result": good}
                web.send(json.dumps({"op": "service_response", **told}))
            case "send_action_goal":
                told = {"action": heard["action"], "id": heard["id"], "values": {"sequence": [0, 1]}}
                web.send(json.dumps({"op": "action_feedback", **told}))
                web.send(json.dumps({"op": "action_result", **told, "status": SUCCEEDED, "result": True}))


def node_step(node: Puppet, random: Random) -> None:
    """Have a node do one thing."""
    topic, kind = random.choice(TOPICS), random.choice(("String", "Int32"))
    service = random.choice(SERVICES)
    data: Any = "text" if kind == "String" else 7
    acts: list[tuple[float, dict[str, Any]]] = [
        (5.0, {"do": "publish", "name": f"{topic}/{kind}", "data": data, "kind": kind, "latched": kind == "String"}),
        (3.0, {"do": "subscribe", "name": topic, "kind": kind}),
        (2.0, {"do": "destroy", "kind": "publisher", "name": f"{topic}/{kind}"}),
        (2.0, {"do": "destroy", "kind": "subscription", "name": topic}),
        (2.0, {"do": "serve", "name": random.choice(SERVICES[2:])}),
        (1.0, {"do": "destroy", "kind": "service", "name": random.choice(SERVICES[2:])}),
        (4.0, {"do": "call", "name": service, "patience_s": 1.0}),
        (1.0, {"do": "act", "name": ACTIONS[1]}),
        (1.0, {"do": "destroy", "kind": "action server", "name": ACTIONS[1]}),
        (2.0, {"do": "pursue", "name": ACTIONS[0]}),
    ]
    weights, choices = zip(*acts, strict=True)
    order = random.choices(choices, weights)[0]
    node.do(order.pop("do"), **order)


def endpoints(node: Puppet) -> dict[str, list[str]]:
    """What the console has in the graph, of this walk; why it is not known where the node has lost sight of it."""
    node.do("list")
    found = node.hear(lambda said: "subscriptions" in said or said.get("failed") == "list")
    if "failed" in found:
        return {"failed": [found["why"]]}
    return {
        kind: sorted(name for name in names if "walk" in name or "nnnn" in name)
        for kind, names in found.items()
    }  # fmt: skip


def known(witness: Client) -> list[str]:
    """The names of this walk that the console still knows, of topics, services and actions."""
    found: list[str] = []
    for service, key in (("topics", "topics"), ("services", "services"), ("action_servers", "action_servers")):
        witness.say(op="call_service", id=service, service=f"/rosapi/{service}")
        answer = witness.hear(lambda heard: "values" in heard)
        found += [name for name in answer["values"][key] if "walk" in name or "nnnn" in name]
    return found


def wait_for_all(walkers: list[Walker]) -> None:
    wait_until(lambda: all(walker.is_done() for walker in walkers), "the end of every call and goal")
