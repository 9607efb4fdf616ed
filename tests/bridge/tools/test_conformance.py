"""Our server comes out clean; a server with rosbridge_suite's quirks does not."""

import json
import socket
import threading
from collections.abc import Callable
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection
from websockets.sync.server import serve as serve_websockets

from simconsole.bridge.tools.conformance import CHECKS, check
from simconsole.values.errors import BridgeError


def test_our_server_deviates_nowhere(serving: Callable[..., Any], snapshot: Callable[..., Any]) -> None:
    server = serving()
    server.snapshots.put(snapshot(1000))  # what is the present is not 0
    assert [row for row in check(server.url) if not row.passed] == []


def quirky(peer: ServerConnection) -> None:
    """Echoes what is published, with bare NaN, twice, and never a status."""
    try:
        for text in peer:
            try:
                operation = json.loads(text)
            except ValueError:
                continue
            if operation["op"] == "publish":
                for _ in range(2):
                    peer.send(json.dumps({**operation, "msg": {"data": float("nan")}}))
    except ConnectionClosed:
        pass


def test_deviations_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("simconsole.bridge.tools.conformance._PATIENCE_S", 0.05)
    monkeypatch.setattr("simconsole.bridge.tools.conformance._QUIET_S", 0.05)
    with serve_websockets(quirky, "127.0.0.1", 0) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        rows = check(f"ws://127.0.0.1:{server.socket.getsockname()[1]}")
        server.shutdown()
        thread.join()
    found = {row.name: row.found for row in rows if not row.passed}
    assert [row.name for row in rows] == list(CHECKS)
    assert found["null in is NaN, out is null"] == "sent invalid JSON: the literal NaN"
    assert found["unknown operation has a status with id"] == "no status came"
    assert found["set_level is obeyed"] == "no status came"


def suite_like(peer: ServerConnection) -> None:
    """Echoes texts as rosbridge_suite: no status, one spelling of a type for each topic, the first message twice.

    What is no JSON spoils nothing.
    """
    types: dict[str, str] = {}
    published: set[str] = set()
    try:
        for text in peer:
            try:
                operation = json.loads(text)
            except ValueError:
                continue
            topic = operation.get("topic", "")
            if operation["op"] in ("advertise", "subscribe"):
                types.setdefault(topic, operation["type"])
            elif operation["op"] == "publish":
                for _ in range(1 if topic in published else 2):
                    peer.send(json.dumps(operation))
                published.add(topic)
    except ConnectionClosed:
        pass


def test_quirks_that_a_row_is_not_about_do_not_decide_it(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = (
        "type names are taken in two and three parts",
        "malformed JSON does not spoil the next message",
        "set_level is obeyed",
    )
    monkeypatch.setattr("simconsole.bridge.tools.conformance.CHECKS", {name: CHECKS[name] for name in asked})
    with serve_websockets(suite_like, "127.0.0.1", 0) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        rows = check(f"ws://127.0.0.1:{server.socket.getsockname()[1]}")
        server.shutdown()
        thread.join()
    assert [(row.passed, row.found) for row in rows] == [(True, ""), (True, ""), (False, "no status came")]


@pytest.mark.parametrize("scheme", ["ws", "http"])
def test_nobody_there(scheme: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as closed:
        port = closed.getsockname()[1]
    with pytest.raises(BridgeError, match="127"):
        check(f"{scheme}://127.0.0.1:{port}")
