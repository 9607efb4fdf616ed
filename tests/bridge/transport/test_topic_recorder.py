import json
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cbor2
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from websockets.sync.client import connect

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.messages.cdr import deserialize
from simconsole.bridge.transport import topic_recorder as record
from simconsole.bridge.transport.lockstep_server import LockstepBridge
from simconsole.bridge.transport.topic_recorder import TopicRecorder, open_recorder
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import BridgeError
from tests.patience import PATIENCE_S

GRIP = {"force": [1.5, 2.5], "state": 2, "name": "left"}


def read(path: Path) -> list[tuple[str, int, Any]]:
    """Topic, time in ns and message of everything in a file, decoded by a library that knows nothing of us."""
    with path.open("rb") as file:
        found = make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages()
        return [(channel.topic, message.log_time, decoded) for _, channel, message, decoded in found]


def test_outputs_and_commands_and_topics_of_clients(
    bridge: ConsoleBridge, join: Callable[..., Any], snapshot: Any, tmp_path: Path
) -> None:
    peer, recorder = join(bridge), TopicRecorder(bridge, tmp_path, ("/odom", "/c*"))
    recorder.update(0)
    bridge.publish(snapshot(5, x_m=3.0), 0)
    peer.publish("/cmd_vel", {"linear": {"x": 1.0}, "angular": {"z": 0.5}})
    peer.send(op="advertise", topic="/chatter", type="std_msgs/String")
    recorder.update(0)
    peer.publish("/chatter", {"data": "hé"})
    peer.send(op="unadvertise", topic="/chatter")
    recorder.update(0)
    assert bridge.router.topic("/chatter") is None
    peer.send(op="advertise", topic="/chatter", type="std_msgs/Int8")  # the name again, another type
    recorder.update(0)
    peer.publish("/chatter", {"data": 7})
    peer.publish("/cmd_vel", {"linear": {}})  # refused: not recorded
    recorder.close()
    recorder.close()
    bridge.publish(snapshot(10), 0)
    found = [
        (topic, time_ns, decoded) for topic, time_ns, decoded in read(tmp_path / "topics.mcap") if topic != "/clock"
    ]
    names = [topic for topic, _, _ in found if not topic.startswith("/console")]
    assert names == ["/odom", "/cmd_vel", "/chatter", "/chatter"]
    by_name = {topic: (time_ns, decoded) for topic, time_ns, decoded in found}
    assert by_name["/odom"][0] == 20_000_000
    assert by_name["/odom"][1].pose.pose.position.x == 3.0
    assert by_name["/cmd_vel"][1].angular.z == 0.5
    assert [decoded.data for topic, _, decoded in found if topic == "/chatter"] == ["hé", 7]


def test_a_user_type_through_the_bridge_into_mcap_and_back(tmp_path: Path, snapshot: Any) -> None:
    """Validation, JSON, CBOR, CDR and MCAP of a type that a folder defines, at once."""
    types = tmp_path / "types/own_msgs/msg"
    types.mkdir(parents=True)
    (types / "Grip.msg").write_text("float32[<=4] force\nuint8 OPEN=1\nuint8 state\nstring<=8 name\n")
    profile = BridgeProfile(port=0, messages=str(tmp_path / "types"), record=("/grip",))
    heard: list[Any] = []

    def talk(url: str) -> None:
        with connect(url) as web, connect(url) as other:
            web.send(json.dumps({"op": "advertise", "topic": "/grip", "type": "own_msgs/Grip"}))
            for peer, form in ((web, "cbor"), (other, "cbor-raw")):
                ask = {"op": "subscribe", "topic": "/grip", "type": "own_msgs/Grip", "compression": form}
                peer.send(json.dumps(ask))
                peer.send(json.dumps({"op": "call_service", "id": 1, "service": "/rosapi/get_time"}))
                peer.recv(timeout=PATIENCE_S)  # the answer: the subscription before it is made
            web.send(json.dumps({"op": "publish", "topic": "/grip", "msg": {**GRIP, "name": "much too long"}}))
            heard.append(json.loads(web.recv(timeout=PATIENCE_S)))
            web.send(json.dumps({"op": "publish", "topic": "/grip", "msg": GRIP}))
            heard.extend(cbor2.loads(peer.recv(timeout=PATIENCE_S, decode=False)) for peer in (web, other))

    with LockstepBridge(profile, folder=tmp_path) as bridge:
        client = threading.Thread(target=talk, args=(bridge.url,))
        client.start()
        tick = 0
        while client.is_alive():
            tick += 5
            bridge.publish(snapshot(tick))
            client.join(0.005)
        registry = bridge.console.router.registry
    refused, cbor, raw = heard
    assert "length <= 8 - at `$.name`" in refused["msg"]
    assert (cbor["msg"]["state"], cbor["msg"]["name"]) == (2, "left")
    assert deserialize(registry, "own_msgs/Grip", raw["msg"]["bytes"]) == GRIP
    ((topic, _, message),) = read(tmp_path / "topics.mcap")
    assert (topic, list(message.force), message.state, message.name) == ("/grip", [1.5, 2.5], 2, "left")


def test_a_second_recording_gets_a_name_of_its_own(
    bridge: ConsoleBridge, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(record, "MAX_FILES", 2)
    for _ in range(2):
        TopicRecorder(bridge, tmp_path, ("*",)).close()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["topics.2.mcap", "topics.mcap"]
    with pytest.raises(BridgeError, match=r"outputs\.bridge\.record: .*2 recordings already"):
        TopicRecorder(bridge, tmp_path, ("*",))


def _open_full_disk(folder: Path) -> Any:
    return Path("/dev/full").open("wb", buffering=8192)  # the recorder closes it; Python 3.14 alone would keep 128 KiB


def test_a_full_disk_ends_the_recording_only(
    bridge: ConsoleBridge,
    join: Callable[..., Any],
    snapshot: Any,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    monkeypatch.setattr(record, "_new_file", _open_full_disk)
    recorder = TopicRecorder(bridge, Path(), ("/odom",))
    recorder.update(0)
    peer = join(bridge)
    peer.send(op="subscribe", topic="/odom")
    for tick in range(5, 10_000, 5):
        bridge.publish(snapshot(tick), 0)
    assert caplog.text.count("recording ends") == 1
    recorder.update(0)
    assert len(bridge.router.sessions) == 1
    assert peer.heard()
    recorder.update(0)  # nothing more


def test_only_where_it_is_asked_for(bridge: ConsoleBridge, tmp_path: Path) -> None:
    assert open_recorder(bridge, BridgeProfile(), tmp_path) is None
    assert open_recorder(bridge, BridgeProfile(record=("*",)), None) is None
