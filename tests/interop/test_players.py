"""The npm packages by which Foxglove, Lichtblick and other players read definitions and messages read all of ours."""

import base64
import json
import shutil
import subprocess
from collections.abc import Callable
from typing import Any

import cbor2
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.cdr import serialize
from simconsole.bridge.messages.definition_text import full_text
from simconsole.bridge.messages.ros1 import serialize_ros1
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.profiles.bridge import BridgeProfile
from tests.bridge.fixtures import make_snapshot
from tests.interop.programs import HERE, npm_packages
from tests.patience import PATIENCE_S

PACKAGES = {
    "@foxglove": {"rosmsg": "5.0.5", "rosmsg-serialization": "2.0.4", "rosmsg2-serialization": "3.1.0"},
    "@lichtblick": {"rosmsg": "1.0.0", "rosmsg-serialization": "1.0.0", "rosmsg2-serialization": "1.0.0"},
}
UNDECLARED = {
    "@foxglove": ["tslib@2.8.1"],
    "@lichtblick": [
        "tslib@2.8.1",
        "@lichtblick/cdr@1.0.1",
        "@lichtblick/rostime@1.0.0",
        "@lichtblick/message-definition@1.0.0",
    ],
}
"""What the packages need and do not say."""
DIALECTS = ("ros2", "ros1")
NODE = shutil.which("node")

pytestmark = pytest.mark.skipif(NODE is None or shutil.which("npm") is None, reason="no Node.js with npm")

Read = Callable[[list[dict[str, str]]], dict[str, Any]]


@pytest.fixture(scope="module", params=PACKAGES)
def read(request: pytest.FixtureRequest) -> Read:
    """Give messages to the packages of one player, which npm fetches once; returns what they found."""
    scope, versions = request.param, PACKAGES[request.param]
    names = [f"{scope}/{name}@{version}" for name, version in versions.items()]
    made = f"{scope}/rosmsg2-serialization"
    folder = npm_packages(f"players-{scope}-{'-'.join(versions.values())}", made, *names, *UNDECLARED[scope])
    library = folder / made
    assert json.loads((library / "package.json").read_text())["version"] == versions["rosmsg2-serialization"]

    def found(messages: list[dict[str, str]]) -> dict[str, Any]:
        program = [str(NODE), str(HERE / "players_program.mjs"), str(folder.parent), scope]
        lines = "".join(f"{json.dumps(message)}\n" for message in messages)
        done = subprocess.run(program, input=lines, capture_output=True, text=True, timeout=PATIENCE_S)
        assert done.returncode == 0, done.stderr
        result: dict[str, Any] = json.loads(done.stdout)
        return result

    return found


def line(dialect: str, topic: str, definition: str, data: bytes) -> dict[str, str]:
    return {"dialect": dialect, "topic": topic, "definition": definition, "data": base64.b64encode(data).decode()}


def served(dialect: str) -> list[dict[str, str]]:
    """A message of every topic that a console publishes, with the definition that rosapi gives for it."""
    bridge = ConsoleBridge(BridgeProfile(port=0))
    session = bridge.router.connect("player", dialect=dialect)  # type: ignore[arg-type]  # one of the two

    def send(**operation: Any) -> None:
        assert bridge.receive(session, json.dumps(operation).encode(), 0).kind == "done"

    send(op="call_service", service="/rosapi/topics_and_raw_types")
    told = json.loads(session.next_text(0) or b"")["values"]
    definitions = dict(zip(told["topics"], told["typedefs_full_text"], strict=True))
    assert ("rcl_interfaces/msg/Log" in told["types"]) is (dialect == "ros2")
    for topic in definitions:
        send(op="subscribe", topic=topic, compression="cbor-raw")
    heard = {}
    for tick in range(1, 300):
        bridge.publish(make_snapshot(tick, x_m=1.5, yaw_rad=0.2), 0)
        while (text := session.next_text(0)) is not None:
            assert isinstance(text, Binary), text
            message = cbor2.loads(text)
            heard[message["topic"]] = message["msg"]["bytes"]
    outputs = {topic.name for topic in bridge.router.topics.values() if topic.owned and topic.command is None}
    assert outputs <= heard.keys()
    return [line(dialect, topic, definitions[topic], data) for topic, data in heard.items()]


@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_topic_is_read(read: Read, dialect: str) -> None:
    messages = served(dialect)
    assert len(messages) >= 14
    assert read(messages) == {"messages": len(messages), "failures": []}


@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_type_is_read(read: Read, dialect: str) -> None:
    registry = standard_registry()
    messages = []
    for name in registry.names():
        message = registry.struct(name)()
        data = serialize(registry, name, message) if dialect == "ros2" else serialize_ros1(registry, name, message, 7)
        messages.append(line(dialect, name, full_text(registry.with_parts(name), dialect == "ros1"), data))
    assert len(messages) > 150
    assert read(messages) == {"messages": len(messages), "failures": []}
