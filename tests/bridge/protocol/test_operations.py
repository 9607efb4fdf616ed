import json
import math
from typing import Any

import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.protocol.operations import (
    Advertise,
    Publish,
    Qos,
    SetLevel,
    Status,
    Subscribe,
    Unadvertise,
    Unsubscribe,
    read_operation,
    read_published,
    write_publish,
    write_status,
)
from simconsole.values.errors import RemoteProtocolError


@pytest.mark.parametrize(
    ("fields", "operation"),
    [
        (
            {"op": "advertise", "topic": "/a", "type": "b/C", "id": 3, "latch": True, "queue_size": 9},
            Advertise("/a", "b/C", 3, True),
        ),
        ({"op": "unadvertise", "topic": "/a", "id": "x"}, Unadvertise("/a", "x")),
        ({"op": "publish", "topic": "/a", "msg": {"x": 1}, "latch": True}, Publish("/a", {"x": 1}, None, True)),
        ({"op": "publish", "topic": "/a", "msg": 1, "id": ["bad"]}, Publish("/a", 1, None)),
        ({"op": "subscribe", "topic": "/a"}, Subscribe("/a")),
        (
            {"op": "subscribe", "topic": "/a", "throttle_rate": 20, "queue_length": 5, "qos": {}},
            Subscribe("/a", None, None, 20.0, 5, qos=Qos()),
        ),
        ({"op": "unsubscribe", "topic": "/a"}, Unsubscribe("/a")),
        ({"op": "status", "level": "warning", "msg": "m"}, Status("warning", "m")),
        ({"op": "set_level", "level": "none"}, SetLevel("none")),
    ],
)
def test_operations_are_read(fields: dict[str, Any], operation: object) -> None:
    assert read_operation(fields) == operation


@pytest.mark.parametrize(
    ("fields", "complaint"),
    [
        ({}, "no op"),
        ({"op": 5}, "no op"),
        ({"op": "call_servise", "service": "/x"}, "'call_servise' is not supported here, only advertise"),
        ({"op": "Publish"}, "not supported"),
        ({"op": "publish", "topic": "/a"}, "publish: .*missing required field `msg`"),
        ({"op": "publish", "msg": {}}, "publish: .*missing required field `topic`"),
        ({"op": "publish", "topic": 5, "msg": {}}, r"\$.topic"),
        ({"op": "advertise", "topic": "/a"}, "missing required field `type`"),
        ({"op": "subscribe", "topic": "/a", "throttle_rate": -1}, r"\$.throttle_rate"),
        ({"op": "subscribe", "topic": "/a", "qos": {"depth": -1}}, r"\$.qos.depth"),
        ({"op": "publish", "topic": "/a", "msg": {}, "qos": {"durability": "eternal"}}, r"\$.qos.durability"),
        ({"op": "subscribe", "topic": "/a", "queue_length": 1.5}, r"\$.queue_length"),
        ({"op": "subscribe", "topic": "/a", "compression": "zip"}, r"\$.compression"),
        ({"op": "subscribe", "topic": "/a", "id": {}}, r"\$.id"),
        ({"op": "subscribe", "topic": "/a", "fragment_size": 1}, r"\$.fragment_size"),
        ({"op": "call_service"}, "call_service: .*missing required field `service`"),
        ({"op": "fragment", "id": 0, "data": 5, "num": 0, "total": 1}, r"\$.data"),
        ({"op": "fragment", "id": 0, "data": "x", "num": -1, "total": 1}, r"\$.num"),
        ({"op": "cancel_action_goal", "id": "a"}, "missing required field `action`"),
        ({"op": "publish", "topic": "/a", "msg": {}, "type": 7}, r"\$.type"),
        ({"op": "set_level", "level": "loud"}, r"\$.level"),
    ],
)
def test_refusals_name_operation_and_field(fields: dict[str, Any], complaint: str) -> None:
    with pytest.raises(RemoteProtocolError, match=complaint):
        read_operation(fields)


def test_publish_is_valid_json_whatever_is_in_it() -> None:
    message = standard_registry().struct("geometry_msgs/Point")(math.nan, math.inf, -math.inf)
    text = write_publish('/a"b', message)
    assert json.loads(text, parse_constant=pytest.fail) == {
        "op": "publish",
        "topic": '/a"b',
        "msg": {"x": None, "y": None, "z": None},
    }


def test_status_carries_the_id_it_answers() -> None:
    assert json.loads(write_status("error", "m", "i7")) == {"op": "status", "level": "error", "msg": "m", "id": "i7"}
    assert "id" not in json.loads(write_status("error", "m"))
    assert len(json.loads(write_status("error", "m" * 5000))["msg"]) == 1000


def test_a_published_text_is_taken_apart_as_it_was_written() -> None:
    assert read_published(write_publish("/a", {"data": 1})) == (b"/a", b'{"data":1}')
    for text in (b'{"op":"publish", "topic":"/a","msg":{}}', b'{"op":"publish","topic":"/a"}', b"", b"{}"):
        assert read_published(text) is None
