import json

import pytest

from simconsole.bridge.protocol.client_session import ClientSession, resolve_topic
from simconsole.bridge.protocol.subscription_queue import SubscriptionQueue
from simconsole.values.errors import RemoteProtocolError


def session(woken: list[int] | None = None) -> ClientSession:
    return ClientSession(1, "peer", 1000, lambda: woken.append(1) if woken is not None else None)


@pytest.mark.parametrize(("name", "full"), [("/a/b", "/a/b"), ("a", "/a"), ("_x/y_2", "/_x/y_2"), ("/A1", "/A1")])
def test_topic_names(name: str, full: str) -> None:
    assert resolve_topic(name) == full


@pytest.mark.parametrize(
    "name", ["", "/", "//a", "/a/", "/1a", "/a//b", "/a/../b", "/a b", "/ä", "/a\n", "/" + "a" * 256]
)
def test_what_is_no_topic_name(name: str) -> None:
    with pytest.raises(RemoteProtocolError, match="not a topic name"):
        resolve_topic(name)


def test_status_is_sent_from_the_level_on_that_the_client_set() -> None:
    client = session()
    client.send_status("warning", "not by default")
    client.send_status("error", "e")
    client.set_level("info")
    client.send_status("info", "i", 7)
    client.set_level("none")
    client.send_status("error", "never")
    texts = []
    while (text := client.next_text(0)) is not None:
        texts.append(json.loads(text)["msg"])
    assert texts == ["e", "i"]
    assert client.sent == 2


def test_something_to_send_wakes() -> None:
    woken: list[int] = []
    client = session(woken)
    client.send_status("info", "below the level")
    assert woken == []
    client.deliver(SubscriptionQueue(b"", 1), b"x", 0)
    assert woken == [1]
    assert client.due_ns() == 0


def test_client_that_is_too_slow_is_told_for_each_topic_once_a_second() -> None:
    client = session()
    for name in ("/a", "/b"):
        lost = SubscriptionQueue(b"", 2, name)
        lost.subscribe(None, 0.0, 2)
        for now_ns in (0, 1, 2, 3, 500_000_000, 1_000_000_003, 1_000_000_004):
            client.deliver(lost, b"x", now_ns)
    texts = []
    while (text := client.next_text(0)) is not None:
        texts.append(text)
    told = [json.loads(text) for text in texts if text != b"x"]
    assert [(said["level"], said["msg"]) for said in told] == [
        ("error", f"{name}: too slow: {count} messages dropped so far") for name in ("/a", "/b") for count in (1, 4)
    ]


def test_client_whose_commands_are_passed_over_is_told_once_a_second() -> None:
    client = session()
    for now_ns in (0, 1, 1_000_000_000):
        client.throttle("too many", now_ns)
    texts = []
    while (text := client.next_text(0)) is not None:
        texts.append(json.loads(text)["msg"])
    assert texts == ["too many"] * 2
    assert client.throttled == 3
