"""What one turn does is bounded whatever waits, everybody gets turns, and who asks for much is slowed alone."""

import random

from simconsole.bridge.protocol.rate_limiter import ByteMeter
from simconsole.bridge.protocol.turns import FULL_BYTES, FULL_MESSAGES, Inbox, Turns
from tests.samples import Sample

S = 10**9


class Handled:
    """What clients have sent, in the order in which it was handled."""

    def __init__(self) -> None:
        self.messages: list[tuple[str, bytes]] = []

    def inbox(self, name: str, cost: int = 0, bytes_per_s: float = 1e9) -> Inbox:
        def apply(message: bytes, now_ns: int) -> int:
            self.messages.append((name, message))
            return cost

        return Inbox(apply, ByteMeter(bytes_per_s))

    def count(self) -> int:
        return len(self.messages)

    def size(self) -> int:
        return sum(len(message) for _, message in self.messages)


def test_first_messages_of_a_turn_are_handled_at_once_and_the_rest_waits_for_the_next() -> None:
    handled, turns = Handled(), Turns(messages=4, num_bytes=1000)
    client = handled.inbox("a")
    for number in range(10):
        turns.receive(client, b"%d" % number, 0)
    assert (handled.count(), turns.waits) == (4, True)
    assert turns.run(0) == 0
    assert handled.count() == 8
    assert turns.run(0) is None
    assert [message for _, message in handled.messages] == [b"%d" % number for number in range(10)]
    assert not turns.waits


def test_bytes_of_a_turn_are_bounded_too() -> None:
    handled, turns = Handled(), Turns(messages=100, num_bytes=1000)
    client = handled.inbox("a")
    for _ in range(10):
        turns.receive(client, b"x" * 400, 0)
    assert handled.size() == 1200
    turns.run(0)
    assert handled.size() == 2400


def test_answers_count() -> None:
    handled, turns = Handled(), Turns(messages=100, num_bytes=1000)
    client = handled.inbox("a", cost=500)
    for _ in range(10):
        turns.receive(client, b"", 0)
    assert handled.count() == 2


def test_who_sends_little_does_not_wait_behind_who_sends_much() -> None:
    handled, turns = Handled(), Turns(messages=10, num_bytes=1_000_000)
    flood, other = handled.inbox("flood"), handled.inbox("other")
    for _ in range(1000):
        turns.receive(flood, b"f", 0)
    turns.receive(other, b"o", 0)
    before = handled.count()
    turns.run(0)
    assert ("other", b"o") in handled.messages[before : before + 2]


def test_clients_take_turns_from_one_turn_to_the_next() -> None:
    handled, turns = Handled(), Turns(messages=1, num_bytes=1_000_000)
    clients = [handled.inbox(name) for name in "abc"]
    turns.receive(handled.inbox("first"), b"", 0)
    for client in clients:
        for _ in range(2):
            turns.receive(client, b"", 0)
    while turns.waits:
        turns.run(0)
    assert [name for name, _ in handled.messages[1:]] == list("abcabc")


def test_who_has_asked_for_too_much_waits_alone_until_it_is_paid_off() -> None:
    handled, turns = Handled(), Turns(messages=100, num_bytes=1_000_000)
    greedy, other = handled.inbox("greedy", cost=1500, bytes_per_s=1000.0), handled.inbox("other")
    for _ in range(3):
        turns.receive(greedy, b"g", S)
    turns.receive(other, b"o", S)
    assert [name for name, _ in handled.messages] == ["greedy", "other"]
    assert turns.run(S) == S + S // 2
    assert handled.count() == 2
    assert turns.run(S + S // 2) == S + S // 2 + 3 * S // 2
    assert [name for name, _ in handled.messages] == ["greedy", "other", "greedy"]


def test_what_was_sent_before_leaving_is_handled_but_not_what_is_slowed_down() -> None:
    handled, turns = Handled(), Turns(messages=1, num_bytes=1_000_000)
    quick, greedy = handled.inbox("quick"), handled.inbox("greedy", cost=1500, bytes_per_s=1000.0)
    for client in (quick, greedy):
        for _ in range(3):
            turns.receive(client, b"", S)
    turns.leave(quick, S)
    turns.leave(greedy, S)
    assert [name for name, _ in handled.messages] == ["quick"] * 3 + ["greedy"]
    assert not turns.waits


def test_inbox_says_when_no_more_should_be_read() -> None:
    many, long = Handled().inbox("a"), Handled().inbox("b")
    for _ in range(FULL_MESSAGES + 1):
        assert not many.is_full
        many.put(b"")
    assert many.is_full
    long.put(b"x" * (FULL_BYTES + 1))
    assert long.is_full
    long.pop()
    assert not long.is_full


def test_no_turn_does_more_than_its_share_and_nothing_is_lost(sample: Sample) -> None:
    chance = random.Random(sample.seed)
    for _ in range(sample.of(8, 2000)):
        handled, turns = Handled(), Turns(messages=8, num_bytes=2000)
        clients = [handled.inbox(str(number), chance.choice([0, 0, 300]), 5000.0) for number in range(5)]
        sent, now_ns = 0, 0
        while sent < 300 or turns.waits:
            count, size = handled.count(), handled.size()
            if turns.waits:
                turns.run(now_ns)
            for _ in range(chance.randint(0, 20) if sent < 300 else 0):
                turns.receive(chance.choice(clients), b"x" * chance.randint(0, 1000), now_ns)
                sent += 1
            assert handled.count() - count <= 8
            assert handled.size() - size < 2000 + 1000
            now_ns += chance.choice([0, S // 100])
        assert handled.count() == sent
