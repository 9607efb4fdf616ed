"""A client of a server over each library: floods are handled in turns, and nobody else waits for them."""

import json
from collections.abc import Callable
from typing import Any

import pytest
from websockets.sync.client import connect

from simconsole.profiles.bridge import BridgeLimits
from tests.patience import PATIENCE_S

FLOOD = 5000


def call(number: int, **more: Any) -> str:
    return json.dumps({"op": "call_service", "service": "/rosapi/topics_and_raw_types", "id": str(number), **more})


@pytest.mark.parametrize("more", [{}, {"fragment_size": 16}])
def test_a_flood_of_questions_holds_up_nobody_else(serving: Callable[..., Any], more: dict[str, Any]) -> None:
    server = serving(limits=BridgeLimits(answered_bytes_per_s=65_536.0))
    with connect(server.url, max_size=None, close_timeout=0) as flood, connect(server.url) as other:
        for number in range(100):
            flood.send(call(number, **more))
        for number in range(20):
            other.send(json.dumps({"op": "call_service", "service": "/rosapi/get_time", "id": number}))
            assert json.loads(other.recv(timeout=PATIENCE_S))["id"] == number
        with connect(server.url) as newcomer:
            newcomer.send(json.dumps({"op": "call_service", "service": "/rosapi/get_time", "id": 0}))
            assert json.loads(newcomer.recv(timeout=PATIENCE_S))["result"] is True


def test_everything_of_a_burst_is_handled_in_order(serving: Callable[..., Any]) -> None:
    server = serving()
    with connect(server.url, max_size=None) as talker, connect(server.url, max_size=None) as listener:
        topic = {"topic": "/burst", "type": "std_msgs/Int32"}
        listener.send(json.dumps({"op": "subscribe", **topic, "queue_length": 1000, "id": "s"}))
        listener.send(json.dumps({"op": "no_such"}))
        listener.recv(timeout=PATIENCE_S)
        for number in range(FLOOD):
            talker.send(json.dumps({"op": "publish", **topic, "msg": {"data": number}}))
        heard = [json.loads(listener.recv(timeout=PATIENCE_S))]
        while heard[-1]["op"] != "publish" or heard[-1]["msg"]["data"] < FLOOD - 1:
            heard.append(json.loads(listener.recv(timeout=PATIENCE_S)))
        data = [said["msg"]["data"] for said in heard if said["op"] == "publish"]
        assert data == sorted(data)
