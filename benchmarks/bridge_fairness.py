"""How long a client waits for an answer while another one floods the bridge, beside how long it waits without.

    .venv-ros2/bin/python benchmarks/bridge_fairness.py [--rounds 3] [--transport picows]

Floods: of a graph (20 topics x 100 Hz x 16 kB to one viewer; left out without rclpy), of questions to rosapi, and of
the same with `fragment_size` 16. Each in a process of its own with a low priority, so that its own work does not count.
A newcomer's time is from connecting to its first answer. A server for each flood and round, unloaded before loaded.
"""

import argparse
import importlib.util
import itertools
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from statistics import median

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

TOPICS = 20
TOPIC_HZ = 100.0
TOPIC_BYTES = 16_000
ASKED = 200
PERIOD_S = 0.01
BEGUN = 100
"""Messages of a flood before the wait of others is measured; with few of them it would not be one."""
LIMIT = 3.0
DOMAIN = "73"
FLOODS = ("graph", "rosapi", "fragments")


def publish() -> None:
    """The node: 20 topics."""
    import rclpy
    from std_msgs.msg import String

    rclpy.init()
    node = rclpy.create_node("flood")
    publishers = [node.create_publisher(String, f"/flood/t{number}", 10) for number in range(TOPICS)]
    message = String(data="x" * TOPIC_BYTES)

    def send() -> None:
        for publisher in publishers:
            publisher.publish(message)

    node.create_timer(1.0 / TOPIC_HZ, send)
    rclpy.spin(node)


def view(url: str) -> None:
    """The viewer of all 20."""
    with connect(url, max_size=None, compression=None) as web:
        for number in range(TOPICS):
            topic = {"topic": f"/flood/t{number}", "type": "std_msgs/String"}
            web.send(json.dumps({"op": "subscribe", **topic, "queue_length": 100}))
        for number, _ in enumerate(web):
            if number == BEGUN:
                print("it floods", flush=True)


def ask_without_end(url: str, fragment_size: int | None) -> None:
    """The client that floods with questions; it reads what it gets in between."""
    more = {} if fragment_size is None else {"fragment_size": fragment_size}
    text = json.dumps({"op": "call_service", "service": "/rosapi/topics_and_raw_types", **more})
    with connect(url, max_size=None, compression=None) as web:
        for number in itertools.count():
            web.send(text)
            if number >= BEGUN:  # so many are always unanswered
                web.recv()
            if number == BEGUN:
                print("it floods", flush=True)


def answer_s(web: ClientConnection) -> float:
    """The time until a question is answered."""
    began_s = time.perf_counter()
    web.send(json.dumps({"op": "call_service", "service": "/rosapi/get_time"}))
    web.recv()
    return time.perf_counter() - began_s


def waits_s(url: str) -> tuple[float, float]:
    """The median wait of one client, and a newcomer's."""
    with connect(url, compression=None) as web:
        found = []
        for _ in range(ASKED):
            found.append(answer_s(web))
            time.sleep(PERIOD_S)
    began_s = time.perf_counter()
    with connect(url, compression=None) as web:
        answer_s(web)
        return median(found), time.perf_counter() - began_s


@contextmanager
def started(*words: str) -> Iterator["subprocess.Popen[str]"]:
    around = {**os.environ, "ROS_DOMAIN_ID": DOMAIN, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    with subprocess.Popen([sys.executable, *words], env=around, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def measure(flood: str, transport: str) -> tuple[float, float, float]:
    """The median wait without and with a flood, and a newcomer's wait with it, in s."""
    options = ["--ros2"] if flood == "graph" else []
    with ExitStack() as stack:
        words = ["-m", "simconsole", "bridge", "serve", "--port", "0", "--transport", transport, *options]
        server = stack.enter_context(started(*words))
        assert server.stdout is not None
        line = server.stdout.readline()
        while "rosbridge at" not in line:
            line = server.stdout.readline()
        url = line.split("rosbridge at ")[1].split()[0].rstrip(",;")
        alone_s, _ = waits_s(url)
        if flood == "graph":
            stack.enter_context(started(__file__, "--part", "node"))
        part = "viewer" if flood == "graph" else flood
        flooding = stack.enter_context(started(__file__, "--part", part, "--url", url))
        assert flooding.stdout is not None
        flooding.stdout.readline()
        return (alone_s, *waits_s(url))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--transport", choices=("websockets", "picows"), default="websockets")
    parser.add_argument("--part", help=argparse.SUPPRESS)
    parser.add_argument("--url", default="", help=argparse.SUPPRESS)
    options = parser.parse_args()
    parts: dict[str, Callable[[], None]] = {
        "node": publish,
        "viewer": lambda: view(options.url),
        "rosapi": lambda: ask_without_end(options.url, None),
        "fragments": lambda: ask_without_end(options.url, 16),
    }
    if options.part is not None:
        os.nice(10)
        with suppress(ConnectionClosed):
            parts[options.part]()
        return 0
    fair = True
    for flood in FLOODS:
        if flood == "graph" and importlib.util.find_spec("rclpy") is None:
            print("graph: left out, no rclpy here")
            continue
        rounds = [measure(flood, options.transport) for _ in range(options.rounds)]
        alone_ms, loaded_ms, newcomer_ms = (1000.0 * median(column) for column in zip(*rounds, strict=True))
        ratio = median(loaded / alone for alone, loaded, _ in rounds)
        fair = fair and ratio <= LIMIT
        print(
            f"{flood}: p50 {alone_ms:.2f} ms alone, {loaded_ms:.2f} ms beside the flood: {ratio:.2f} times "
            f"(limit {LIMIT:g}); a newcomer is answered after {newcomer_ms:.1f} ms"
        )
    return 0 if fair else 1


if __name__ == "__main__":
    raise SystemExit(main())
