"""How fast messages cross between rosbridge clients and a ROS 2 graph, each way, through ours and through a peer.

    .venv-ros2/bin/python benchmarks/bridge_graph.py [--peer ws://127.0.0.1:9190 --peer-domain 70] [--rounds 5]

A client in this process and a node in another one, both with nothing to do but this: an Odometry in a closed loop with
20 under way (half of what a server keeps of 20, if it loses some), then 100 a second for their latency; and the same
from client to client of a server that is in a graph. Rounds of all servers are interleaved. The peer runs already, in a
domain of its own: two bridges in one graph would pass on each other's topics.
"""

import argparse
import asyncio
import os
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from statistics import median

import orjson

from simconsole.bridge.tools.bench_peers import connect

TYPE = "nav_msgs/Odometry"
UNDER_WAY = 20
RATE_HZ = 100
DOMAIN = 71
SILENCE_S = 0.5
START_S = 120.0  # the first start compiles
WAYS = {"in": "client to node", "out": "node to client", "between": "client to client"}
CONTENT = {
    "header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "map"},
    "pose": {"pose": {"position": {"x": 1.5, "y": 2.5, "z": 0.0}}, "covariance": [0.0] * 36},
    "twist": {"twist": {"linear": {"x": 13.9, "y": 0.1, "z": 0.0}}, "covariance": [0.0] * 36},
}


def node(way: str, topic: str) -> None:
    """The other end: says a byte for each message that it gets, or sends a message for each byte that it is told."""
    import rclpy
    from nav_msgs.msg import Odometry
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.qos import QoSProfile
    from rclpy.serialization import serialize_message

    rclpy.init()
    made = rclpy.create_node("bench", start_parameter_services=False, enable_rosout=False)
    qos = QoSProfile(depth=1000)
    if way == "in":

        def take(_data: bytes) -> None:
            """Take all that waits: a turn of rclpy costs as much as a message on its way, and is not measured here."""
            count = 1
            with subscription.handle:
                while subscription.handle.take_message(Odometry, True) is not None:
                    count += 1
            os.write(1, b"m" * count)

        subscription = made.create_subscription(Odometry, topic, take, qos, raw=True)
        executor = SingleThreadedExecutor()
        executor.add_node(made)
        os.write(1, b"r")
        while rclpy.ok():
            executor.spin_once()
    message = Odometry()
    message.header.frame_id = "map"
    message.twist.twist.linear.x = 13.9
    text = serialize_message(message)
    publisher = made.create_publisher(Odometry, topic, qos)
    os.write(1, b"r")
    while wanted := os.read(0, 4096):
        for _ in wanted:
            publisher.publish(text)


class Link:
    """A client and a node at one server, or two clients (`between`): `send` sends one message, `received` counts."""

    def __init__(self, way: str) -> None:
        self.way = way
        self.received = 0
        self.on_message: Callable[[], object] = lambda: None
        self.send: Callable[[], object]

    def _arrived(self) -> None:
        self.received += 1
        self.on_message()

    def _all_arrived(self, messages: bytes) -> None:
        for _ in messages:
            self._arrived()

    async def open(self, url: str, domain: int, stack: ExitStack) -> None:
        topic = f"/bench/t{time.monotonic_ns()}"
        self.peers = []
        if self.way != "in":
            self.peers.append(await connect(url, self._arrived))
            wish = {"op": "subscribe", "topic": topic, "type": TYPE, "queue_length": 1000}
            self.peers[0].send(orjson.dumps(wish))
        if self.way != "out":
            publisher = await connect(url, lambda: None)
            self.peers.append(publisher)
            publisher.send(orjson.dumps({"op": "advertise", "topic": topic, "type": TYPE, "queue_size": 1000}))
            text = orjson.dumps({"op": "publish", "topic": topic, "msg": CONTENT})
            self.send = lambda: publisher.send(text)
        if self.way != "between":
            await self._start_node(topic, domain, stack)
        deadline_s = time.monotonic() + START_S
        while not self.received:
            self.send()
            await asyncio.sleep(0.2)
            if time.monotonic() > deadline_s:
                raise SystemExit(f"{url}: nothing arrives")
        await self.silence()

    async def _start_node(self, topic: str, domain: int, stack: ExitStack) -> None:
        around = {**os.environ, "ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
        words = [sys.executable, __file__, "--node", self.way, topic]
        process = subprocess.Popen(words, env=around, stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
        stack.callback(process.wait)
        stack.callback(process.kill)
        assert process.stdin is not None
        assert process.stdout is not None
        told, tells = process.stdin.fileno(), process.stdout.fileno()
        await asyncio.to_thread(os.read, tells, 1)
        if self.way == "out":
            self.send = lambda: os.write(told, b"m")
        else:
            loop = asyncio.get_running_loop()
            loop.add_reader(tells, lambda: self._all_arrived(os.read(tells, 4096)))
            stack.callback(loop.remove_reader, tells)

    async def silence(self) -> None:
        before = -1
        while before != self.received:
            before = self.received
            await asyncio.sleep(SILENCE_S)

    async def close(self) -> None:
        for peer in self.peers:
            await peer.close()

    async def window(self) -> int:
        self.received = 0
        for _ in range(UNDER_WAY):
            self.send()
        await self.silence()
        return UNDER_WAY if self.received == UNDER_WAY else max(1, self.received // 2)

    async def rate_hz(self, under_way: int, seconds: float) -> float:
        self.received = 0
        began_s = ended_s = time.monotonic()

        def again() -> None:
            nonlocal ended_s
            ended_s = time.monotonic()
            if ended_s < began_s + seconds:
                self.send()

        self.on_message = again
        for _ in range(under_way):
            self.send()
        await asyncio.sleep(seconds)
        await self.silence()
        self.on_message = lambda: None
        return self.received / (ended_s - began_s)

    async def latencies_ms(self, seconds: float) -> list[float]:
        found: list[float] = []
        next_s = time.monotonic()
        for _ in range(int(seconds * RATE_HZ)):
            await asyncio.sleep(max(0.0, next_s - time.monotonic()))
            next_s += 1.0 / RATE_HZ
            arrived: asyncio.Future[float] = asyncio.get_running_loop().create_future()
            self.on_message = partial(note_time, arrived)
            sent_s = time.monotonic()
            self.send()
            found.append(1000.0 * (await asyncio.wait_for(arrived, 5.0) - sent_s))
        self.on_message = lambda: None
        return sorted(found)


def note_time(arrived: "asyncio.Future[float]") -> None:
    if not arrived.done():
        arrived.set_result(time.monotonic())


async def measure(url: str, domain: int, way: str, seconds: float) -> tuple[float, float, float, float]:
    """Rate in Hz with how many under way; p50 and p99 at 100 Hz in ms."""
    link = Link(way)
    with ExitStack() as stack:
        await link.open(url, domain, stack)
        under_way = await link.window()
        rate_hz = await link.rate_hz(under_way, seconds)
        latencies_ms = await link.latencies_ms(seconds)
        await link.close()
    return rate_hz, under_way, median(latencies_ms), latencies_ms[int(0.99 * (len(latencies_ms) - 1))]


def listens(port: int) -> bool:
    with socket.socket() as probe:
        return not probe.connect_ex(("127.0.0.1", port))


@contextmanager
def ours(port: int, transport: str) -> Iterator[str]:
    around = {**os.environ, "ROS_DOMAIN_ID": str(DOMAIN)}
    words = [sys.executable, "-m", "simconsole", "bridge", "serve", "--ros2", "--transport", transport]
    limits = ["--limit", "commands_hz=100000"]
    with subprocess.Popen([*words, "--port", str(port), *limits], env=around, stdout=subprocess.DEVNULL) as process:
        try:
            deadline_s = time.monotonic() + START_S
            while not listens(port):
                if time.monotonic() > deadline_s:
                    raise SystemExit("the console does not start")
                time.sleep(0.1)
            yield f"ws://127.0.0.1:{port}"
        finally:
            process.terminate()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peer", metavar="URL", help="another rosbridge server, running")
    parser.add_argument("--peer-domain", type=int, default=70)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--ways", nargs="+", choices=list(WAYS), default=list(WAYS))
    parser.add_argument("--transport", default="websockets")
    parser.add_argument("--port", type=int, default=9191)
    parser.add_argument("--node", nargs=2, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.node:
        node(*args.node)
        return
    found: dict[tuple[str, str], list[tuple[float, ...]]] = {}
    with ours(args.port, args.transport) as url:
        servers = [("simconsole", url, DOMAIN)]
        if args.peer:
            servers.append(("peer", args.peer, args.peer_domain))
        for _ in range(args.rounds):
            for way in args.ways:
                for name, where, domain in servers:
                    figures = asyncio.run(measure(where, domain, way, args.seconds))
                    found.setdefault((name, way), []).append(figures)
                    print(name, way, *(f"{figure:.2f}" for figure in figures), file=sys.stderr, flush=True)
    for (name, way), several in found.items():
        rate_hz, under_way, p50_ms, p99_ms = (median(column) for column in zip(*several, strict=True))
        line = f"{rate_hz:8.0f} /s with {under_way:.0f} under way; p50 {p50_ms:.2f}, p99 {p99_ms:.2f} ms"
        print(f"{name:12s} {WAYS[way]}: {line}")
    if args.peer:
        for way in args.ways:
            ratios = [a[0] / b[0] for a, b in zip(found["simconsole", way], found["peer", way], strict=True)]
            print(f"{WAYS[way]}: {median(ratios):.1f} times the peer's rate ({min(ratios):.1f} to {max(ratios):.1f})")


if __name__ == "__main__":
    main()
