"""N02, N03: servers and clients that come and go, over real sockets; everything is there again and nothing stays."""

import gc
import json
import logging
import subprocess
import sys
import threading
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.messages import standard_registry
from simconsole.bridge.protocol.backoff import CAP_S, JITTER
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.signals import Mode
from tests.bridge.fixtures import Served
from tests.drives.console import Running
from tests.patience import Stopwatch
from tests.ports import free_port
from tests.samples import Measured, Sample

RESTARTS = 100
MIB = 1 << 20
CONTROL = "/control/command/control_cmd"


def open_files() -> int:
    return len(list(Path("/proc/self/fd").iterdir()))


def odometry(client: BridgeClient, server: Any, snapshot: Callable[..., Any]) -> None:
    """Return when odometry of this server has arrived."""
    for tick in range(10, 10_000, 5):
        server.snapshots.put(snapshot(tick))
        received = client.receive(0.02)
        if received is not None:
            assert received.topic == "/odom"
            return
    pytest.fail("no odometry")


@pytest.mark.fault("N02")
def test_n02_everything_is_there_again_after_each_of_many_restarts(
    caplog: pytest.LogCaptureFixture,
    snapshot: Callable[..., Any],
    control: Callable[..., Any],
    measured: Measured,
    transport: Any,
) -> None:
    caplog.set_level(logging.CRITICAL)  # or what is kept of the log would count as growth
    # Classes that msgspec has generated are never freed; a server is restarted in a process of its own.
    port, registry = free_port(), standard_registry()
    states: list[Any] = []
    restored = Stopwatch()
    with BridgeClient(f"ws://127.0.0.1:{port}", on_state=states.append, first_s=0.005, cap_s=0.02) as client:
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.advertise(CONTROL, "autoware_control_msgs/Control")
        assert not client.publish(CONTROL, control())
        descriptors = 0
        for number in range(RESTARTS):
            server = Served(BridgeProfile(port=port, rates_hz={"/odom": 250.0}, transport=transport), registry)
            restored.start()
            odometry(client, server, snapshot)
            restored.lap()
            assert client.publish(CONTROL, control(number / 1000))
            assert server.command().road_wheel_rad == number / 1000
            stopping = threading.Thread(target=server.stop)
            stopping.start()
            while client.state == "connected":
                client.receive(0.01)
            stopping.join()
            if number == 5:
                gc.collect()
                descriptors, threads = open_files(), threading.active_count()
                tracemalloc.start()
        client.receive(0.05)
        del server, stopping
        gc.collect()
        held_bytes, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert open_files() <= descriptors
        assert threading.active_count() <= threads
        assert held_bytes < 1 << 20
    assert client.connections == RESTARTS
    assert states == ["connected", "connecting"] * RESTARTS
    assert client.failure
    seen = f"median {restored.median}, longest of {RESTARTS} {restored.longest}"
    measured("N02", f"restored after a restart, {transport}", seen, "of real time, not asserted")


# In a process of its own, whose resident memory is its own.
COME_AND_GO = """
import asyncio, gc, json, os, sys
from pathlib import Path
from websockets.asyncio.client import connect
from simconsole.bridge.transport.server import BridgeServer
from simconsole.profiles.bridge import BridgeProfile

WISHES = [json.dumps(wish) for wish in (
    {"op": "subscribe", "topic": "/odom"},
    {"op": "subscribe", "topic": "/own", "type": "std_msgs/String", "queue_length": 5},
    {"op": "advertise", "topic": "/own", "type": "std_msgs/String"},
    {"op": "advertise_service", "service": "/serve", "type": "std_srvs/Empty"},
    {"op": "call_service", "service": "/serve", "id": "never answered"},
    {"op": "fragment", "id": "a", "num": 0, "total": 3, "data": "x"},
    {"op": "no_such", "id": "settled"},
)]

async def come_and_go(server, number):
    peer = await connect(server.url)
    for wish in WISHES:
        await peer.send(wish)
    while json.loads(await peer.recv()).get("id") != "settled":
        pass
    if number % 2:
        peer.transport.abort()
    await peer.close()
    while server.clients or len(asyncio.all_tasks()) > 2:  # this one and the server's watcher
        await asyncio.sleep(0.001)

async def main():
    server = BridgeServer(BridgeProfile(port=0, transport=sys.argv[1]))
    await server.start()
    router = server.console.router
    for number in range(int(sys.argv[2])):
        await come_and_go(server, number)
        if number % 10 == 9:
            gc.collect()
            resident = int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
            files = len(list(Path("/proc/self/fd").iterdir()))
            held = len(asyncio.all_tasks()), len(router.topics), router.calls.open, files, len(router.sessions)
            print(json.dumps([resident, *held, "/serve" in router.calls.services()]), flush=True)
    await server.close()

asyncio.run(main())
"""


@pytest.mark.fault("N02")
def test_n02_a_hundred_clients_that_come_and_go_leave_nothing_behind(
    transport: Any, sample: Sample, measured: Measured
) -> None:
    """The first forty warm it up."""
    count = sample.of(100, 500)
    command = [sys.executable, "-c", COME_AND_GO, transport, str(count)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    assert all(row[1:] == rows[0][1:] for row in rows), rows
    assert rows[0][5:] == [0, False], "no session, no service"
    grown = rows[-1][0] - rows[3][0]
    seen = f"{grown / MIB:+.2f} MiB after {count - 40} more clients"
    measured("N02", f"resident memory, {transport}", seen, "at most 1 MiB")
    assert grown <= MIB


@pytest.mark.fault("N03")
def test_n03_several_clients_are_back_with_their_first_try_and_nobody_is_engaged(
    serving: Callable[..., Any], snapshot: Callable[..., Any], control: Callable[..., Any], measured: Measured
) -> None:
    """Their pauses are those of a client that nobody tuned, less than 2 s each: they are back within one of them."""
    port = free_port()
    server = serving(port=port, rates_hz={"/odom": 250.0})
    clients = [BridgeClient(server.url) for _ in range(3)]
    for client in clients:
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.advertise(CONTROL, "autoware_control_msgs/Control")
        odometry(client, server, snapshot)
    assert clients[0].publish(CONTROL, control(0.5))
    assert server.command().road_wheel_rad == 0.5
    server.stop()
    tries = [0 for _ in clients]
    pauses_s: list[float] = []
    for number, client in enumerate(clients):
        while client.state == "connected":
            client.receive(0.01)
        counted(client, tries, number, pauses_s)
    server = serving(port=port, rates_hz={"/odom": 250.0})  # once, at once: the port is free again, or this raises
    for client in clients:
        while client.connections < 2:
            client.receive(0.01)
        odometry(client, server, snapshot)
    # A new server begins with no command and no events: whoever drove before has to ask again.
    assert server.commands.empty()
    assert server.events.empty()
    for client in clients:
        client.disconnect()
    longest_s = CAP_S * (1.0 + JITTER)
    measured("N03", "tries of three clients until they were back", str(tries), "one each")
    measured("N03", "longest pause before one", f"{longest_s:.2f} s by the rule", "less than 2 s")
    assert tries == [1, 1, 1]
    assert not pauses_s, "none had to wait again"
    assert longest_s < 2.0


def counted(client: BridgeClient, tries: list[int], number: int, pauses_s: list[float]) -> None:
    """Count the tries of a client from now on, and the pauses that it takes after one that failed."""
    open_link, pause_s = client._connection.open, client._backoff.pause_s

    def opened() -> None:
        tries[number] += 1
        open_link()

    def paused(chance: float) -> float:
        pauses_s.append(pause_s(chance))
        return pauses_s[-1]

    client._connection.open, client._backoff.pause_s = opened, paused  # type: ignore[method-assign]


@pytest.mark.fault("N03")
def test_n03_console_that_is_killed_and_started_again_on_its_port_is_parked(
    tmp_path: Path, control: Callable[..., Any]
) -> None:
    """The program; its client never stops to command, and asks for nothing after the restart."""
    port = free_port()
    modes: list[list[int]] = []
    with BridgeClient(f"ws://127.0.0.1:{port}") as client:
        client.subscribe("/console/arbitration", "simconsole_msgs/Arbitration")
        client.advertise(CONTROL, "autoware_control_msgs/Control")
        for number in range(2):
            with Running(tmp_path / str(number), "bridge", "serve", "--port", port) as server:
                modes.append([])
                while len(modes[-1]) < 50:
                    assert server.process.poll() is None, server.err.read_text()
                    received = client.receive(0.05)
                    client.publish(CONTROL, control(0.1))
                    if received is not None and client.connections == number + 1:
                        modes[-1].append(received.message.mode)
                server.process.kill()
        assert client.connections == 2
    assert set(modes[1]) == {Mode.PARKED}
