"""`simconsole bridge bench`: what a rosbridge server carries, beside bare brokers of the same libraries.

Rounds are interleaved, and a publisher with its subscribers runs here: a closed loop with a number of messages under
way, then 100 messages a second.
"""

import asyncio
import time
from collections.abc import Callable, Sequence
from statistics import median
from typing import Any, Final, NamedTuple, Protocol

import orjson

from simconsole.bridge.tools.bench_peers import Peer, connect
from simconsole.bridge.tools.bench_servers import RunningServer, running_servers
from simconsole.values.errors import BridgeError

IN_FLIGHT: Final = 20
RATE_HZ: Final = 100
_SILENCE_S: Final = 0.3
_PATIENCE_S: Final = 10.0
_TRIES: Final = 40
_TYPES: Final = {"odometry": "nav_msgs/Odometry", "laser_scan": "sensor_msgs/LaserScan"}
_CASES: Final = (("odometry", 1), ("odometry", 10), ("laser_scan", 1))


class BenchedServer(Protocol):
    """Where a server is, and what processor time (s) it has taken, None where nobody knows."""

    @property
    def url(self) -> str:
        """Where clients connect."""

    def cpu_s(self) -> float | None:
        """Return the time so far."""


class Case(NamedTuple):
    """One measurement: of which server on which library, which message, to how many."""

    server: str
    library: str
    message: str
    subscribers: int


class Measurement(NamedTuple):
    """Medians over the rounds.

    Messages a second to each subscriber, with how many under way; the server's processor time for one message to one
    subscriber (of our own processes); latency at 100 Hz.
    """

    rate_hz: float
    under_way: float
    cpu_us: float | None
    p50_ms: float
    p99_ms: float


def bench(rounds: int = 3, seconds: float = 1.0, url: str | None = None) -> dict[Case, Measurement]:
    """Measure our server, the bare brokers and, if `url` is given, that server.

    Raises:
        BridgeError: a server cannot be reached, or loses messages.
    """
    with running_servers() as served:
        if url is not None:
            served.append(RunningServer("url", "", url, None))
        return asyncio.run(_measure(served, rounds, seconds))


async def _measure(served: Sequence[RunningServer], rounds: int, seconds: float) -> dict[Case, Measurement]:
    found: dict[Case, list[Measurement]] = {}
    for _ in range(rounds):
        for message, subscribers in _CASES:
            for one in served:
                try:
                    figures = await measure_once(one, message, subscribers, seconds)
                except TimeoutError:
                    raise BridgeError(f"{one.url}: loses messages") from None
                found.setdefault(Case(one.server, one.library, message, subscribers), []).append(figures)
    return {case: _medians(several) for case, several in found.items()}


def _medians(several: Sequence[Measurement]) -> Measurement:
    columns = zip(*several, strict=True)
    return Measurement(*(None if None in column else median(column) for column in columns))  # type: ignore[arg-type]  # None in one column only


async def measure_once(served: BenchedServer, message: str, subscribers: int, seconds: float) -> Measurement:
    """Return one measurement of a server: a closed loop for `seconds`, then as long at 100 Hz.

    Raises:
        BridgeError: it cannot be reached.
        TimeoutError: it loses messages.
    """
    topic = f"/bench/t{time.monotonic_ns()}"
    deliveries = _Deliveries(subscribers)
    peers = [await connect(served.url, lambda: None)]
    try:
        peers += [await connect(served.url, deliveries.listener(number)) for number in range(subscribers)]
        publisher, *listeners = peers
        kind = _TYPES[message]
        publisher.send(orjson.dumps({"op": "advertise", "topic": topic, "type": kind}))
        wish = {"op": "subscribe", "topic": topic, "type": kind, "queue_length": 1000}
        for listener in listeners:
            listener.send(orjson.dumps(wish))
        text = _text(topic, message)
        await _warm_up(publisher, deliveries, text)
        under_way = await _window(publisher, deliveries, text)
        before_s = served.cpu_s()
        rate_hz, count = await _closed_loop(publisher, deliveries, text, under_way, seconds)
        after_s = served.cpu_s()
        latencies_ms = sorted(await _paced(publisher, deliveries, text, seconds))
    finally:
        for peer in peers:
            await peer.close()
    cpu_us = None if before_s is None or after_s is None else 1e6 * (after_s - before_s) / (count * subscribers)
    p99_ms = latencies_ms[int(0.99 * (len(latencies_ms) - 1))]
    return Measurement(rate_hz=rate_hz, under_way=under_way, cpu_us=cpu_us, p50_ms=median(latencies_ms), p99_ms=p99_ms)


def _text(topic: str, message: str) -> bytes:
    content: dict[str, Any] = {"header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "map"}}
    if message == "odometry":
        content["pose"] = {"pose": {"position": {"x": 1.5, "y": 2.5, "z": 0.0}}, "covariance": [0.0] * 36}
        content["twist"] = {"twist": {"linear": {"x": 13.9, "y": 0.1, "z": 0.0}}, "covariance": [0.0] * 36}
    else:
        content["ranges"] = [0.5 + number / 100.0 for number in range(360)]
    return orjson.dumps({"op": "publish", "topic": topic, "msg": content})


class _Deliveries:
    """Messages delivered to each subscriber; a round is a message that all have received."""

    def __init__(self, listeners: int) -> None:
        self.received = [0] * listeners
        self.rounds = 0
        self.on_round: Callable[[], None] = lambda: None
        self._missing: dict[int, int] = {}

    def listener(self, number: int) -> Callable[[], None]:
        """Return what a listener calls for each message."""
        if len(self.received) == 1:
            return self._receive_alone
        return lambda: self._receive(number)

    def forget(self) -> None:
        """Begin to count anew: some messages never came to everybody."""
        self.received = [0] * len(self.received)
        self.rounds = 0
        self._missing.clear()

    async def wait_for_silence(self) -> None:
        """Return when nothing has come for a while."""
        while True:
            before = list(self.received)
            await asyncio.sleep(_SILENCE_S)
            if before == self.received:
                return

    async def wait_for_rounds(self, count: int) -> None:
        """Return when all have received `count` messages. Raises TimeoutError: none came for long."""
        while self.rounds < count:
            before, deadline_s = self.rounds, time.monotonic() + _PATIENCE_S
            while self.rounds == before:
                if time.monotonic() > deadline_s:
                    raise TimeoutError
                await asyncio.sleep(0.001)

    def _receive_alone(self) -> None:
        self.received[0] += 1
        self.rounds += 1
        self.on_round()

    def _receive(self, number: int) -> None:
        index = self.received[number]
        self.received[number] = index + 1
        missing = self._missing.get(index, len(self.received)) - 1
        if missing:
            self._missing[index] = missing
            return
        del self._missing[index]
        self.rounds += 1
        self.on_round()


async def _warm_up(publisher: Peer, deliveries: _Deliveries, text: bytes) -> None:
    """Return when every subscription works: each subscriber has received, and nothing more is in flight."""
    for _ in range(_TRIES):
        publisher.send(text)
        deadline_s = time.monotonic() + 0.5
        while time.monotonic() < deadline_s and not all(deliveries.received):
            await asyncio.sleep(0.005)
        if all(deliveries.received):
            await deliveries.wait_for_silence()
            return
    raise TimeoutError


async def _window(publisher: Peer, deliveries: _Deliveries, text: bytes) -> int:
    """Return how many messages may be under way: IN_FLIGHT, or half of what a server with shorter queues keeps of them.

    A ROS 2 graph behind the server keeps the last 10 by default. With more under way the loop would wait for lost ones;
    a burst fares a little better than the queue is long, hence half.
    """
    deliveries.forget()
    for _ in range(IN_FLIGHT):
        publisher.send(text)
    await deliveries.wait_for_silence()
    kept = min(deliveries.received)
    return IN_FLIGHT if kept == IN_FLIGHT else max(1, kept // 2)


async def _closed_loop(
    publisher: Peer, deliveries: _Deliveries, text: bytes, under_way: int, seconds: float
) -> tuple[float, int]:
    """Send one for each that all have received; return the rate in Hz, and how many there were altogether."""
    deliveries.forget()
    count, ended_s = under_way, 0.0
    began_s = time.monotonic()
    until_s = began_s + seconds

    def again() -> None:
        """Send the next message until the time is over; note when it is."""
        nonlocal count, ended_s
        now_s = time.monotonic()
        if now_s < until_s:
            publisher.send(text)
            count += 1
        elif not ended_s:
            ended_s = now_s

    deliveries.on_round = again
    for _ in range(under_way):
        publisher.send(text)
    await asyncio.sleep(seconds)
    await deliveries.wait_for_rounds(count)
    deliveries.on_round = lambda: None
    return (count - under_way + 1) / (ended_s - began_s), count


async def _paced(publisher: Peer, deliveries: _Deliveries, text: bytes, seconds: float) -> list[float]:
    """Return, for each of the messages sent at RATE_HZ, how long it took to everybody, in ms."""
    latencies_ms: list[float] = []
    next_s, sent_s = time.monotonic(), 0.0
    deliveries.forget()

    def note() -> None:
        """Note how long the message took."""
        latencies_ms.append(1000.0 * (time.monotonic() - sent_s))

    deliveries.on_round = note
    for number in range(1, max(1, int(seconds * RATE_HZ)) + 1):
        await asyncio.sleep(max(0.0, next_s - time.monotonic()))
        next_s += 1.0 / RATE_HZ
        sent_s = time.monotonic()
        publisher.send(text)
        await deliveries.wait_for_rounds(number)
    deliveries.on_round = lambda: None
    return latencies_ms
