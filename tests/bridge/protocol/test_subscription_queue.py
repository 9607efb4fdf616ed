import random

import pytest

from simconsole.bridge.protocol.message_encoding import Form
from simconsole.bridge.protocol.subscription_queue import MAX_REPLIES, Outgoing, Outlet


def outlet(depth: int, throttle_ms: float = 0.0) -> Outlet:
    made = Outlet(b"", 1)
    made.wish(None, throttle_ms, depth)
    return made


def drain(outgoing: Outgoing, now_ns: int = 0) -> list[bytes]:
    texts = []
    while (text := outgoing.take(now_ns)) is not None:
        texts.append(text)
    return texts


def test_latest_keeps_only_the_newest() -> None:
    outgoing, latest = Outgoing(1000), outlet(1)
    assert [outgoing.put(latest, bytes([65 + number])) for number in range(4)] == [0, 1, 1, 1]
    assert drain(outgoing) == [b"D"]
    assert latest.dropped == outgoing.dropped == 3


def test_fifo_keeps_the_newest_in_order() -> None:
    outgoing, fifo = Outgoing(1000), outlet(3)
    for number in range(5):
        outgoing.put(fifo, b"%d" % number)
    assert drain(outgoing) == [b"2", b"3", b"4"]


def test_topics_take_turns() -> None:
    outgoing, many, few = Outgoing(1000), outlet(10), outlet(10)
    for text in (b"a1", b"a2", b"a3"):
        outgoing.put(many, text)
    outgoing.put(few, b"b1")
    assert drain(outgoing) == [b"a1", b"b1", b"a2", b"a3"]


def test_replies_go_first_and_are_bounded() -> None:
    outgoing, fifo = Outgoing(1000), outlet(10)
    outgoing.put(fifo, b"topic")
    for number in range(MAX_REPLIES + 2):
        outgoing.reply(b"%d" % number)
    texts = drain(outgoing)
    assert texts[0] == b"2"
    assert texts[-1] == b"topic"
    assert len(texts) == MAX_REPLIES + 1


def test_throttle_holds_the_newest_until_its_time() -> None:
    outgoing, slow = Outgoing(1000), outlet(1, throttle_ms=10.0)
    outgoing.put(slow, b"1")
    assert drain(outgoing, 0) == [b"1"]
    for text in (b"2", b"3"):
        outgoing.put(slow, text)
    assert drain(outgoing, 9_999_999) == []
    assert outgoing.due_ns() == 10_000_000
    assert drain(outgoing, 10_000_000) == [b"3"]
    assert outgoing.due_ns() is None


def test_throttled_topic_does_not_hold_up_another() -> None:
    outgoing, slow, fast = Outgoing(1000), outlet(5, throttle_ms=1000.0), outlet(5)
    outgoing.put(slow, b"s1")
    drain(outgoing)
    outgoing.put(slow, b"s2")
    outgoing.put(fast, b"f1")
    assert drain(outgoing, 1) == [b"f1"]


def test_byte_limit_drops_the_oldest_of_the_topic_first() -> None:
    outgoing, a, b = Outgoing(10), outlet(100), outlet(100)
    outgoing.put(b, b"bbb")
    for number in range(5):
        outgoing.put(a, b"aa%d" % number)
    assert outgoing.bytes <= 10
    assert drain(outgoing) == [b"bbb", b"aa3", b"aa4"]
    assert (a.dropped, b.dropped) == (3, 0)


def test_byte_limit_reaches_other_topics_when_it_must() -> None:
    outgoing, a, b = Outgoing(10), outlet(100), outlet(100)
    outgoing.put(b, b"bbbbbbbb")
    outgoing.put(a, b"aaaa")
    assert drain(outgoing) == [b"aaaa"]
    assert b.dropped == 1


def test_text_beyond_the_limit_is_dropped_itself() -> None:
    outgoing, a = Outgoing(10), outlet(100)
    assert outgoing.put(a, b"x" * 11) == 1
    assert drain(outgoing) == []
    assert outgoing.bytes == 0


def test_several_wishes_of_one_client_merge_to_the_most_demanding() -> None:
    made = Outlet(b"", 7)
    made.wish("a", 100.0, 5)
    made.wish("b", 50.0, 0)
    assert (made.throttle_ns, made.depth) == (50_000_000, 7)
    assert made.withdraw("b")
    assert (made.throttle_ns, made.depth) == (100_000_000, 5)
    assert not made.withdraw("b")
    assert made.withdraw(None)
    assert made.wishes == {}


def test_forgotten_topic_leaves_nothing() -> None:
    outgoing, a = Outgoing(100), outlet(5)
    outgoing.put(a, b"1234")
    outgoing.forget(a)
    assert (outgoing.bytes, drain(outgoing)) == (0, [])


@pytest.mark.parametrize("seed", range(20))
def test_bounds_hold_under_random_use(seed: int) -> None:
    print("seed", seed)
    chance = random.Random(seed)
    outgoing = Outgoing(500)
    outlets = [outlet(chance.randint(1, 5), chance.choice([0.0, 3.0])) for _ in range(4)]
    put = taken = 0
    for now_ns in range(0, 40_000_000, 20_000):
        if chance.random() < 0.7:
            outgoing.put(chance.choice(outlets), b"x" * chance.randint(1, 200))
            put += 1
        elif outgoing.take(now_ns) is not None:
            taken += 1
        assert outgoing.bytes == sum(len(text) for each in outlets for text in each.texts) <= 500
        assert all(len(each.texts) <= each.depth for each in outlets)
    assert put == taken + outgoing.dropped + sum(len(each.texts) for each in outlets)


def test_replies_are_bounded_in_bytes_too() -> None:
    outgoing = Outgoing(100)
    for letter in (b"a", b"b", b"c"):
        outgoing.reply(letter * 45)
    assert drain(outgoing) == [b"b" * 45, b"c" * 45]
    outgoing.reply(b"d" * 200)
    assert drain(outgoing) == [b"d" * 200]


def test_pieces_of_one_message_stay_together() -> None:
    outgoing, topic = Outgoing(1000), Outlet(b"", 1)
    topic.wish("a", 0.0, 9, fragment_size=50)
    topic.wish("b", 0.0, 9, fragment_size=20)
    outgoing.put(topic, b"x" * 45)
    first = outgoing.take(0)
    outgoing.reply(b"later")
    assert outgoing.due_ns() == 0
    texts = [first, *drain(outgoing)]
    assert [b'"fragment"' in (text or b"") for text in texts] == [True, True, True, False]
    assert outgoing.due_ns() is None


def test_most_demanding_form_wins() -> None:
    topic = Outlet(b"", 1)
    for number, compression in enumerate(("none", "png", "cbor", "cbor-raw")):
        topic.wish(number, 0.0, 1, Form("ros2", compression))  # type: ignore[arg-type]  # the literals are listed here
        assert topic.form.compression == compression
