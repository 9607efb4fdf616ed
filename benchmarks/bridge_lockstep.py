"""Round trips a second of the lockstep bridge with our own client, and what two bare sockets manage in between.

Run: python benchmarks/bridge_lockstep.py [--round-trips N] [--rounds N]

A round trip is odometry out (about 680 B of JSON in a WebSocket frame), command back. The baseline passes the same
number of bytes both ways between two processes over TCP on loopback, with no WebSocket, no JSON and no typing: what
waking a process costs. Rounds are interleaved; the client is a process of its own in both cases.
"""

import argparse
import json
import multiprocessing
import socket
import statistics
import time
from multiprocessing.context import SpawnProcess

import numpy as np

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.transport.lockstep_server import LockstepBridge
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import BridgeError
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot

TICK_HZ = 250
PERIOD_TICKS = 5
OUT_BYTES, BACK_BYTES = 690, 620
CONTROL = "/control/command/control_cmd"
TYPE = "autoware_control_msgs/Control"


def controller(url: str) -> None:
    """Answer every odometry until the server says good-bye."""
    with BridgeClient(url, comes_back=False) as client:
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.advertise(CONTROL, TYPE)
        client.connect()
        command = client.registry.struct(TYPE)()
        try:
            while True:
                received = client.receive(10.0)
                if received is not None:
                    command.stamp = received.message.header.stamp
                    command.lateral.steering_tire_angle = 0.01
                    client.publish(CONTROL, command)
        except BridgeError:
            return


def echo(port: int) -> None:
    """Answer OUT_BYTES with BACK_BYTES until the other side closes."""
    with socket.create_connection(("127.0.0.1", port)) as peer:
        peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        answer = bytes(BACK_BYTES)
        while receive(peer, OUT_BYTES):
            peer.sendall(answer)


def receive(peer: socket.socket, count: int) -> bool:
    while count:
        data = peer.recv(count)
        if not data:
            return False
        count -= len(data)
    return True


def beside(work: object, *arguments: object) -> SpawnProcess:
    process = multiprocessing.get_context("spawn").Process(target=work, args=arguments)  # type: ignore[arg-type]
    process.start()
    return process


def bridge_rate(round_trips: int) -> float:
    row = np.zeros(PLATFORM_AT)
    with LockstepBridge(BridgeProfile(port=0)) as bridge:
        process = beside(controller, bridge.url)
        if not bridge.wait_for_client(30.0):
            raise SystemExit("the client did not come")
        begin = time.perf_counter()
        for number in range(1, round_trips + 1):
            row[LAYOUT.vehicle.start] = number / 3
            if not bridge.exchange(Snapshot(number * PERIOD_TICKS, TICK_HZ, row)):
                raise SystemExit("no answer")
            bridge.take(number * PERIOD_TICKS + 1)
        rate = round_trips / (time.perf_counter() - begin)
    process.join()
    return rate


def bare_rate(round_trips: int) -> float:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        process = beside(echo, listener.getsockname()[1])
        peer, _ = listener.accept()
    with peer:
        peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        question = bytes(OUT_BYTES)
        begin = time.perf_counter()
        for _ in range(round_trips):
            peer.sendall(question)
            receive(peer, BACK_BYTES)
        rate = round_trips / (time.perf_counter() - begin)
    process.join()
    return rate


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--round-trips", type=int, default=5000, help="in each round")
    parser.add_argument("--rounds", type=int, default=5)
    given = parser.parse_args()
    bridge, bare = [], []
    for number in range(given.rounds):
        bridge.append(bridge_rate(given.round_trips))
        bare.append(bare_rate(given.round_trips))
        print(f"round {number + 1}: bridge {bridge[-1]:6.0f}/s   bare sockets {bare[-1]:6.0f}/s")
    rate, floor = statistics.median(bridge), statistics.median(bare)
    control_hz = TICK_HZ / PERIOD_TICKS
    print(
        f"median: bridge {rate:.0f} round trips/s, {rate / control_hz:.0f} x real time at {control_hz:.0f} Hz control"
    )
    print(f"        bare sockets {floor:.0f} round trips/s; the bridge reaches {100.0 * rate / floor:.0f} % of it")
    print(json.dumps({"bridge_per_s": rate, "bare_per_s": floor, "ratio": rate / floor}))


if __name__ == "__main__":
    main()
