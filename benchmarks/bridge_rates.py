"""Two rosbridge servers of ours in alternation: processor time for one message to one subscriber, second over first.

Run: python benchmarks/bridge_rates.py [TREE:]TRANSPORT [TREE:]TRANSPORT [--pairs N] [--subscribers N ...]
For example: python benchmarks/bridge_rates.py websockets picows
             python benchmarks/bridge_rates.py ../before:websockets .:websockets

Each server runs in a process of its own, from its own checkout, its clients with it in one event loop: how many
messages are read or written in one piece then hangs on no other process, and a busy machine does not decide. The
clients (picows, which count messages and no more) are part of the time, equal for both. An Odometry goes round in a
closed loop with 20 under way. The interval is that of the median's order statistics (`two_trees.py`).
"""

import argparse
import asyncio
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import orjson
from two_trees import interval

if TYPE_CHECKING:
    from simconsole.bridge.transport.server import BridgeServer

UNDER_WAY = 20
DELIVERIES = 4000
"""Messages to subscribers in one round."""


CONTENT = {
    "header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "map"},
    "pose": {"pose": {"position": {"x": 1.5, "y": 2.5, "z": 0.0}}, "covariance": [0.0] * 36},
    "twist": {"twist": {"linear": {"x": 13.9, "y": 0.1, "z": 0.0}}, "covariance": [0.0] * 36},
}


async def work(transport: Literal["websockets", "picows"]) -> None:
    """Serve; for each number of subscribers on standard input, say what a message to one of them costs, in us."""
    from simconsole.bridge.transport.server import BridgeServer
    from simconsole.profiles.bridge import BridgeLimits, BridgeProfile

    server = BridgeServer(BridgeProfile(port=0, transport=transport, limits=BridgeLimits(clients=200)))
    await server.start()
    while line := await asyncio.to_thread(sys.stdin.readline):
        print(await one_round(server, int(line)), flush=True)


async def one_round(server: "BridgeServer", subscribers: int) -> float:
    from simconsole.bridge.tools.bench_peers import connect

    received, done = 0, asyncio.Event()
    wanted = max(2 * UNDER_WAY, DELIVERIES // subscribers) * subscribers
    topic = f"/bench/t{time.monotonic_ns()}"
    text = orjson.dumps({"op": "publish", "topic": topic, "msg": CONTENT})

    def hear() -> None:
        nonlocal received
        received += 1
        if received == wanted:
            done.set()
        elif received % subscribers == 0 and received <= wanted - UNDER_WAY * subscribers:
            publisher.send(text)

    peers = [await connect(server.url, hear) for _ in range(subscribers)]
    for peer in peers:
        wish = {"op": "subscribe", "topic": topic, "type": "nav_msgs/Odometry", "queue_length": 1000}
        peer.send(orjson.dumps(wish))
    publisher = await connect(server.url, lambda: None)
    publisher.send(orjson.dumps({"op": "advertise", "topic": topic, "type": "nav_msgs/Odometry"}))
    while sum(len(found.subscribers) for found in server.console.router.topics.values()) < subscribers:
        await asyncio.sleep(0.01)
    before_s = time.process_time()
    for _ in range(UNDER_WAY):
        publisher.send(text)
    await done.wait()
    cost_us = 1e6 * (time.process_time() - before_s) / wanted
    for peer in (*peers, publisher):
        await peer.close()
    return cost_us


def start(what: str) -> "subprocess.Popen[str]":
    tree, _, transport = what.rpartition(":")
    around = {**os.environ, "PYTHONPATH": str(Path(tree or ".").resolve())}
    words = [sys.executable, __file__, "--worker", transport]
    return subprocess.Popen(words, env=around, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def cost_us(server: "subprocess.Popen[str]", subscribers: int) -> float:
    assert server.stdin is not None
    assert server.stdout is not None
    server.stdin.write(f"{subscribers}\n")
    server.stdin.flush()
    return float(server.stdout.readline())


def main() -> None:
    """Print, for each number of subscribers, both times and their ratio."""
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("servers", nargs="*", metavar="[TREE:]TRANSPORT", default=["websockets", "picows"])
    words.add_argument("--pairs", type=int, default=30)
    words.add_argument("--subscribers", type=int, nargs="+", default=[1, 10, 100])
    words.add_argument("--worker", help=argparse.SUPPRESS)
    given = words.parse_args()
    if given.worker:
        asyncio.run(work(given.worker))
        return
    servers = [start(what) for what in given.servers]
    for subscribers in given.subscribers:
        for server in servers:
            cost_us(server, subscribers)  # fills caches
        pairs = []
        for number in range(given.pairs):
            order = servers if number % 2 else servers[::-1]
            costs = {server.pid: cost_us(server, subscribers) for server in order}
            pairs.append([costs[server.pid] for server in servers])
        first_us, second_us = (statistics.median(column) for column in zip(*pairs, strict=True))
        ratios = sorted(second / first for first, second in pairs)
        low, high = interval(len(ratios))
        print(f"to {subscribers}: {given.servers[0]} {first_us:.1f} us, {given.servers[1]} {second_us:.1f} us each")
        print(
            f"  second over first, median of {len(ratios)} pairs: {statistics.median(ratios):.3f} "
            f"(95 % interval {ratios[low]:.3f} to {ratios[high]:.3f})",
            flush=True,
        )
    for server in servers:
        server.kill()
        server.wait()


if __name__ == "__main__":
    main()
