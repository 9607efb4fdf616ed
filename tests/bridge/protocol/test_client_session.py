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


def test_client_that_is_too_slow_is_told_once_a_second() -> None:
    client, latest = session(), SubscriptionQueue(b"", 1)
    client.set_level("warning")
    for now_ns in (0, 1, 2, 500_000_000, 1_000_000_001, 1_000_000_002):
        client.deliver(latest, b"x", now_ns)
    texts = [client.next_text(0) for _ in range(3)]
    assert [text is not None and b"too slow" in text for text in texts] == [True, True, False]
