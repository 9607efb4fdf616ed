"""`simconsole bridge bench`: what a rosbridge server carries, beside a bare broker of the same library.

The bare broker parses, encodes once and fans out, with no validation: what is left to gain. Servers run in processes
of their own, rounds are interleaved, and a publisher with its subscribers runs here: a closed loop with a number of
messages under way, then 100 messages a second.
"""

import asyncio
import multiprocessing
import time
from multiprocessing.connection import Connection
from statistics import median
from typing import Any, Final, NamedTuple

import orjson
from websockets.asyncio.client import ClientConnection, connect
from websockets.asyncio.server import ServerConnection
from websockets.asyncio.server import serve as serve_websockets
from websockets.exceptions import WebSocketException

from simconsole.errors import BridgeError

UNDER_WAY: Final = 20
RATE_HZ: Final = 100
_START_S: Final = 30.0
_SILENCE_S: Final = 0.3
_TRIES: Final = 40
_TYPES: Final = {"odometry": "nav_msgs/Odometry", "laser_scan": "sensor_msgs/LaserScan"}


class Case(NamedTuple):
    """One measurement: of which server, which message, to how many."""

    server: str
    message: str
    subscribers: int


class Figures(NamedTuple):
    """Medians over the rounds: messages a second to each subscriber, with how many under way, and latency at 100 Hz."""

    rate_hz: float
    under_way: float
    p50_ms: float
    p99_ms: float


def bench(rounds: int = 3, seconds: float = 1.0, url: str | None = None) -> dict[Case, Figures]:
    """Measure our server, the bare broker and, if `url` is given, that server.

    Raises:
        BridgeError: a server cannot be reached, or loses messages.
    """
    context = multiprocessing.get_context("spawn")
    started, urls = [], {}
    try:
        for name, serve in (("bare", _serve_bare), ("simconsole", _serve_ours)):
            ours, theirs = context.Pipe()
            process = context.Process(target=serve, args=(theirs,), daemon=True)
            process.start()
            started.append((process, ours))
            if not ours.poll(_START_S):
                raise BridgeError(f"the {name} server did not start")
            urls[name] = f"ws://127.0.0.1:{ours.recv()}"
        if url is not None:
            urls["url"] = url
        return asyncio.run(_measure(urls, rounds, seconds))
    finally:
        for process, ours in started:
            ours.close()
            process.terminate()
            process.join()


async def _measure(urls: dict[str, str], rounds: int, seconds: float) -> dict[Case, Figures]:
    found: dict[Case, list[Figures]] = {}
    for _ in range(rounds):
        for message, subscribers in (("odometry", 1), ("odometry", 10), ("laser_scan", 1)):
            for server, url in urls.items():
                try:
                    figures = await _once(url, message, subscribers, seconds)
                except TimeoutError:
                    raise BridgeError(f"{url}: loses messages") from None
                except (OSError, WebSocketException) as error:
                    raise BridgeError(f"{url}: {error}") from None
                found.setdefault(Case(server, message, subscribers), []).append(figures)
    return {
        case: Figures(*(median(column) for column in zip(*several, strict=True))) for case, several in found.items()
    }


async def _once(url: str, message: str, subscribers: int, seconds: float) -> Figures:
    topic = f"/bench/t{time.monotonic_ns()}"
    peers = [await connect(url, compression=None, max_size=None) for _ in range(subscribers + 1)]
    try:
        publisher, *listeners = peers
        kind = _TYPES[message]
        await publisher.send(orjson.dumps({"op": "advertise", "topic": topic, "type": kind}).decode())
        wish = {"op": "subscribe", "topic": topic, "type": kind, "queue_length": 1000}
        for listener in listeners:
            await listener.send(orjson.dumps(wish).decode())
        text = _text(topic, message)
        await _warm_up(publisher, listeners, text)
        under_way = await _window(publisher, listeners, text)
        rate_hz = await _closed_loop(publisher, listeners, text, under_way, seconds)
        latencies_ms = sorted(await _paced(publisher, listeners[0], listeners[1:], text, seconds))
    finally:
        for peer in peers:
            await peer.close()
    return Figures(rate_hz, under_way, median(latencies_ms), latencies_ms[int(0.99 * (len(latencies_ms) - 1))])


def _text(topic: str, message: str) -> str:
    content: dict[str, Any] = {"header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "map"}}
    if message == "odometry":
        content["pose"] = {"pose": {"position": {"x": 1.5, "y": 2.5, "z": 0.0}}, "covariance": [0.0] * 36}
        content["twist"] = {"twist": {"linear": {"x": 13.9, "y": 0.1, "z": 0.0}}, "covariance": [0.0] * 36}
    else:
        content["ranges"] = [0.5 + number / 100.0 for number in range(360)]
    return orjson.dumps({"op": "publish", "topic": topic, "msg": content}).decode()


async def _warm_up(publisher: ClientConnection, listeners: list[ClientConnection], text: str) -> None:
    """Return when every subscription stands: each listener has heard, and nothing more is under way."""
    for listener in listeners:
        for tries_left in reversed(range(_TRIES)):
            await publisher.send(text)
            try:
                await asyncio.wait_for(listener.recv(), 0.5)
            except TimeoutError:
                if not tries_left:
                    raise
                continue
            break
    await asyncio.gather(*(_heard(listener, _SILENCE_S) for listener in listeners))


async def _heard(listener: ClientConnection, silence_s: float) -> int:
    """Return how many messages come until none has come for `silence_s`."""
    count = 0
    try:
        while True:
            await asyncio.wait_for(listener.recv(), silence_s)
            count += 1
    except TimeoutError:
        return count


async def _window(publisher: ClientConnection, listeners: list[ClientConnection], text: str) -> int:
    """Return how many messages may be under way: UNDER_WAY, or half of what a server with shorter queues keeps of them.

    A ROS 2 graph behind the server keeps the last 10 by default. With more under way the loop would wait for lost ones;
    a burst fares a little better than the queue is long, hence half.
    """
    for _ in range(UNDER_WAY):
        await publisher.send(text)
    kept = min(await asyncio.gather(*(_heard(listener, _SILENCE_S) for listener in listeners)))
    return UNDER_WAY if kept == UNDER_WAY else max(1, kept // 2)


async def _closed_loop(
    publisher: ClientConnection, listeners: list[ClientConnection], text: str, under_way: int, seconds: float
) -> float:
    for _ in range(under_way):
        await publisher.send(text)
    count, began_s = 0, time.monotonic()
    while (elapsed_s := time.monotonic() - began_s) < seconds:
        for listener in listeners:
            await asyncio.wait_for(listener.recv(), 10.0)
        count += 1
        await publisher.send(text)
    for _ in range(under_way):
        for listener in listeners:
            await asyncio.wait_for(listener.recv(), 10.0)
    return count / elapsed_s


async def _paced(
    publisher: ClientConnection, first: ClientConnection, others: list[ClientConnection], text: str, seconds: float
) -> list[float]:
    latencies_ms, next_s = [], time.monotonic()
    for _ in range(max(1, int(seconds * RATE_HZ))):
        await asyncio.sleep(max(0.0, next_s - time.monotonic()))
        next_s += 1.0 / RATE_HZ
        sent_s = time.monotonic()
        await publisher.send(text)
        await asyncio.wait_for(first.recv(), 10.0)
        latencies_ms.append(1000.0 * (time.monotonic() - sent_s))
        for listener in others:
            await asyncio.wait_for(listener.recv(), 10.0)
    return latencies_ms


def _serve_ours(pipe: Connection) -> None:
    from simconsole.bridge.server import serve
    from simconsole.profiles.bridge import BridgeProfile

    serve(BridgeProfile(port=0), lambda: None, lambda *_: None, lambda _: None, pipe.poll, on_ready=pipe.send)


def _serve_bare(pipe: Connection) -> None:
    listening: dict[str, list[ServerConnection]] = {}

    async def client(peer: ServerConnection) -> None:
        async for text in peer:
            operation = orjson.loads(text)
            if operation["op"] == "subscribe":
                listening.setdefault(operation["topic"], []).append(peer)
            elif operation["op"] == "publish":
                encoded = orjson.dumps(operation)
                for listener in listening.get(operation["topic"], []):
                    await listener.send(encoded, text=True)

    async def main() -> None:
        async with serve_websockets(client, "127.0.0.1", 0, compression=None) as server:
            pipe.send(next(iter(server.sockets)).getsockname()[1])
            await server.serve_forever()

    asyncio.run(main())
