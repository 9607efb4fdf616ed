import json
import random

import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.protocol.message_encoding import Encoding
from simconsole.bridge.protocol.server_protocol import Router
from simconsole.bridge.protocol.subscription_queue import MAX_REPLIES, SendBudget, SendQueue, SubscriptionQueue
from simconsole.profiles.bridge import BridgeLimits


def queue(depth: int, throttle_ms: float = 0.0) -> SubscriptionQueue:
    made = SubscriptionQueue(b"", 1)
    made.subscribe(None, throttle_ms, depth)
    return made


def drain(send_queue: SendQueue, now_ns: int = 0) -> list[bytes]:
    texts = []
    while (text := send_queue.take(now_ns)) is not None:
        texts.append(text)
    return texts


def test_latest_keeps_only_the_newest() -> None:
    send_queue, latest = SendQueue(1000), queue(1)
    for number in range(4):
        send_queue.put(latest, bytes([65 + number]))
    assert drain(send_queue) == [b"D"]
    assert latest.dropped == send_queue.dropped == 3


def test_fifo_keeps_the_newest_in_order() -> None:
    send_queue, fifo = SendQueue(1000), queue(3)
    for number in range(5):
        send_queue.put(fifo, b"%d" % number)
    assert drain(send_queue) == [b"2", b"3", b"4"]


def test_topics_take_turns() -> None:
    send_queue, many, few = SendQueue(1000), queue(10), queue(10)
    for text in (b"a1", b"a2", b"a3"):
        send_queue.put(many, text)
    send_queue.put(few, b"b1")
    assert drain(send_queue) == [b"a1", b"b1", b"a2", b"a3"]


def test_replies_go_first_and_are_bounded() -> None:
    send_queue, fifo = SendQueue(1000), queue(10)
    send_queue.put(fifo, b"topic")
    for number in range(MAX_REPLIES + 2):
        send_queue.reply(b"%d" % number)
    texts = drain(send_queue)
    assert texts[0] == b"2"
    assert texts[-1] == b"topic"
    assert len(texts) == MAX_REPLIES + 1


def test_throttle_holds_the_newest_until_its_time() -> None:
    send_queue, slow = SendQueue(1000), queue(1, throttle_ms=10.0)
    send_queue.put(slow, b"1")
    assert drain(send_queue, 0) == [b"1"]
    for text in (b"2", b"3"):
        send_queue.put(slow, text)
    assert drain(send_queue, 9_999_999) == []
    assert send_queue.due_ns() == 10_000_000
    assert drain(send_queue, 10_000_000) == [b"3"]
    assert send_queue.due_ns() is None


def test_throttled_topic_does_not_hold_up_another() -> None:
    send_queue, slow, fast = SendQueue(1000), queue(5, throttle_ms=1000.0), queue(5)
    send_queue.put(slow, b"s1")
    drain(send_queue)
    send_queue.put(slow, b"s2")
    send_queue.put(fast, b"f1")
    assert drain(send_queue, 1) == [b"f1"]


def test_byte_limit_drops_the_oldest_of_the_topic_first() -> None:
    send_queue, a, b = SendQueue(10), queue(100), queue(100)
    send_queue.put(b, b"bbb")
    for number in range(5):
        send_queue.put(a, b"aa%d" % number)
    assert send_queue.bytes <= 10
    assert drain(send_queue) == [b"bbb", b"aa3", b"aa4"]
    assert (a.dropped, b.dropped) == (3, 0)


def test_byte_limit_reaches_other_topics_when_it_must() -> None:
    send_queue, a, b = SendQueue(10), queue(100), queue(100)
    for text in (b"bbbb1", b"bbbb2"):
        send_queue.put(b, text)
    send_queue.put(a, b"aaaa")
    assert drain(send_queue) == [b"bbbb2", b"aaaa"]
    assert (a.dropped, b.dropped) == (0, 1)


def test_newest_message_of_a_topic_is_kept_whatever_its_length() -> None:
    send_queue, large, small = SendQueue(10), queue(100), queue(100)
    send_queue.put(small, b"s1")
    send_queue.put(small, b"s2")
    for number in range(3):
        send_queue.put(large, b"x" * 1000 + b"%d" % number)
    assert drain(send_queue) == [b"s2", b"x" * 1000 + b"2"]
    assert (large.dropped, small.dropped) == (2, 1)
    assert send_queue.bytes == 0


def test_all_clients_together_have_a_bound_that_the_longest_queue_pays_for() -> None:
    budget = SendBudget(1000)
    told: list[tuple[SubscriptionQueue, int]] = []
    stalled = SendQueue(10_000, budget, lambda lost, now_ns: told.append((lost, now_ns)))
    healthy = SendQueue(10_000, budget)
    many, one = queue(100), queue(100)
    for _ in range(9):
        stalled.put(many, b"x" * 100)
    healthy.put(one, b"y" * 100, 6)
    assert budget.bytes == 1000
    healthy.put(one, b"y" * 100, 7)
    assert told == [(many, 7)]
    assert budget.bytes == 1000
    assert drain(healthy) == [b"y" * 100] * 2
    healthy.put(one, b"z" * 5000, 8)
    assert drain(healthy) == [b"z" * 5000]
    assert (stalled.waiting_bytes, budget.bytes) == (0, 0)


def test_clients_of_a_server_share_64_mb() -> None:
    assert BridgeLimits().all_queued_bytes == 64 * 2**20
    limits = BridgeLimits(all_queued_bytes=2_000_000, queued_bytes=1_000_000)
    router = Router(standard_registry(), limits, 1)
    sessions = [router.connect(str(number)) for number in range(5)]
    for session in sessions:
        wish = {"op": "subscribe", "topic": "/s", "type": "std_msgs/String"}
        assert router.receive(session, json.dumps(wish).encode(), 0).kind == "done"
    text = json.dumps({"op": "publish", "topic": "/s", "msg": {"data": "x" * 90_000}}).encode()
    for _ in range(30):
        assert router.receive(sessions[0], text, 0).kind == "done"
        assert sum(session.send_queue.waiting_bytes for session in sessions) <= 2_000_000
    assert min(session.send_queue.waiting_bytes for session in sessions) > 90_000


def test_answers_count_towards_the_bound_and_who_leaves_gives_back() -> None:
    budget = SendBudget(1000)
    gone, stays = SendQueue(10_000, budget), SendQueue(10_000, budget)
    gone.reply(b"r" * 600)
    gone.put(queue(5), b"t" * 300)
    assert budget.bytes == 900
    stays.put(queue(5), b"s" * 700)
    assert (budget.bytes, gone.waiting_bytes, gone.dropped) == (700, 0, 2)
    gone.reply(b"r" * 100)
    gone.close()
    assert budget.bytes == 700


@pytest.mark.parametrize(("depth", "throttle_ms", "count"), [(1, 0.0, 0), (5, 10.0, 0), (5, 0.0, 3)])
def test_who_asked_for_the_newest_only_is_not_told(depth: int, throttle_ms: float, count: int) -> None:
    told: list[int] = []
    send_queue, some = SendQueue(1000, None, lambda lost, now_ns: told.append(now_ns)), queue(depth, throttle_ms)
    for number in range(depth + 3):
        send_queue.put(some, b"x", number)
    assert len(told) == count
    assert some.dropped == 3


def test_several_wishes_of_one_client_merge_to_the_most_demanding() -> None:
    made = SubscriptionQueue(b"", 7)
    made.subscribe("a", 100.0, 5)
    made.subscribe("b", 50.0, 0)
    assert (made.throttle_ns, made.depth) == (50_000_000, 7)
    assert made.unsubscribe("b")
    assert (made.throttle_ns, made.depth) == (100_000_000, 5)
    assert not made.unsubscribe("b")
    assert made.unsubscribe(None)
    assert made.subscriptions == {}


def test_forgotten_topic_leaves_nothing() -> None:
    send_queue, a = SendQueue(100), queue(5)
    send_queue.put(a, b"1234")
    send_queue.forget(a)
    assert (send_queue.bytes, drain(send_queue)) == (0, [])


@pytest.mark.parametrize("seed", range(20))
def test_bounds_hold_under_random_use(seed: int) -> None:
    print("seed", seed)
    chance = random.Random(seed)
    send_queue = SendQueue(500)
    subscriptions = [queue(chance.randint(1, 5), chance.choice([0.0, 3.0])) for _ in range(4)]
    put = taken = 0
    for now_ns in range(0, 40_000_000, 20_000):
        if chance.random() < 0.7:
            send_queue.put(chance.choice(subscriptions), b"x" * chance.randint(1, 200))
            put += 1
        elif send_queue.take(now_ns) is not None:
            taken += 1
        assert send_queue.bytes == sum(len(text) for each in subscriptions for text in each.texts)
        assert send_queue.bytes <= 500 or all(len(each.texts) <= 1 for each in subscriptions)
        assert all(len(each.texts) <= each.depth for each in subscriptions)
    assert put == taken + send_queue.dropped + sum(len(each.texts) for each in subscriptions)


def test_replies_are_bounded_in_bytes_too() -> None:
    send_queue = SendQueue(100)
    for letter in (b"a", b"b", b"c"):
        send_queue.reply(letter * 45)
    assert drain(send_queue) == [b"b" * 45, b"c" * 45]
    send_queue.reply(b"d" * 200)
    assert drain(send_queue) == [b"d" * 200]


def test_pieces_of_one_message_stay_together() -> None:
    send_queue, topic = SendQueue(1000), SubscriptionQueue(b"", 1)
    topic.subscribe("a", 0.0, 9, fragment_size=50)
    topic.subscribe("b", 0.0, 9, fragment_size=20)
    send_queue.put(topic, b"x" * 45)
    first = send_queue.take(0)
    send_queue.reply(b"later")
    assert send_queue.due_ns() == 0
    texts = [first, *drain(send_queue)]
    assert [b'"fragment"' in (text or b"") for text in texts] == [True, True, True, False]
    assert send_queue.due_ns() is None


def test_most_demanding_form_wins() -> None:
    topic = SubscriptionQueue(b"", 1)
    for number, compression in enumerate(("none", "png", "cbor", "cbor-raw")):
        topic.subscribe(number, 0.0, 1, Encoding("ros2", compression))  # type: ignore[arg-type]  # the literals are listed here
        assert topic.encoding.compression == compression
