"""N02, N03: servers and clients that come and go, over real sockets; everything is there again and nothing stays."""

import asyncio
import gc
import json
import logging
import socket
import threading
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from websockets.asyncio.client import connect

from simconsole.bridge.client import BridgeClient
from simconsole.bridge.messages import standard_registry
from simconsole.bridge.server import BridgeServer
from simconsole.profiles.bridge import BridgeProfile
from tests.bridge.fixtures import Served

RESTARTS = 100
CONTROL = "/control/command/control_cmd"


def open_files() -> int:
    return len(list(Path("/proc/self/fd").iterdir()))


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


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
    record_property: Callable[[str, object], None],
    transport: Any,
) -> None:
    caplog.set_level(logging.CRITICAL)  # or what is kept of the log would count as growth
    # Classes that msgspec has generated are never freed; a server is restarted in a process of its own.
    port, registry = free_port(), standard_registry()
    states: list[Any] = []
    times_s = []
    with BridgeClient(f"ws://127.0.0.1:{port}", on_state=states.append, first_s=0.005, cap_s=0.02) as client:
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.advertise(CONTROL, "autoware_control_msgs/Control")
        assert not client.publish(CONTROL, control())
        descriptors = 0
        for number in range(RESTARTS):
            server = Served(BridgeProfile(port=port, rates_hz={"/odom": 250.0}, transport=transport), registry)
            began_s = time.monotonic()
            odometry(client, server, snapshot)
            times_s.append(time.monotonic() - began_s)
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
    text = f"median {sorted(times_s)[RESTARTS // 2]:.3f} s, longest of {RESTARTS} {max(times_s):.3f} s (aim 2 s)"
    record_property("restored after a server's restart", text)


@pytest.mark.fault("N02")
def test_n02_a_hundred_clients_that_come_and_go_leave_nothing_behind(transport: Any) -> None:
    wishes = [
        {"op": "subscribe", "topic": "/odom"},
        {"op": "subscribe", "topic": "/own", "type": "std_msgs/String", "queue_length": 5},
        {"op": "advertise", "topic": "/own", "type": "std_msgs/String"},
        {"op": "advertise_service", "service": "/serve", "type": "std_srvs/Empty"},
        {"op": "call_service", "service": "/serve", "id": "never answered"},
        {"op": "fragment", "id": "a", "num": 0, "total": 3, "data": "x"},
        {"op": "no_such", "id": "settled"},
    ]

    async def come_and_go(server: BridgeServer, number: int) -> None:
        peer = await connect(server.url)
        for wish in wishes:
            await peer.send(json.dumps(wish))
        while json.loads(await peer.recv()).get("id") != "settled":
            pass
        if number % 2:
            peer.transport.abort()
        await peer.close()
        while server.clients or len(asyncio.all_tasks()) > 2:  # this one and the server's watcher
            await asyncio.sleep(0.001)

    async def main() -> None:
        server = BridgeServer(BridgeProfile(port=0, transport=transport))
        await server.start()
        try:
            held: list[tuple[int, int, int, int]] = []
            for number in range(110):
                await come_and_go(server, number)
                if number == 9:
                    tracemalloc.start()
                if number >= 9 and number % 10 == 9:
                    gc.collect()
                    router = server.console.router
                    counted = (len(asyncio.all_tasks()), len(router.topics), router.calls.open, open_files())
                    held.append(counted)
            assert set(held) == {held[0]}
            assert tracemalloc.get_traced_memory()[0] < 1 << 20
            assert router.sessions == ()
            assert router.calls.services().get("/serve") is None
        finally:
            tracemalloc.stop()
            await server.close()

    asyncio.run(main())


@pytest.mark.fault("N03")
def test_n03_several_clients_are_back_and_nobody_is_engaged(
    serving: Callable[..., Any], snapshot: Callable[..., Any], control: Callable[..., Any]
) -> None:
    port = free_port()
    server = serving(port=port, rates_hz={"/odom": 250.0})
    clients = [BridgeClient(server.url, first_s=0.005, cap_s=0.02) for _ in range(3)]
    for client in clients:
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.advertise(CONTROL, "autoware_control_msgs/Control")
        odometry(client, server, snapshot)
    assert clients[0].publish(CONTROL, control(0.5))
    assert server.command().road_wheel_rad == 0.5
    server.stop()
    server = serving(port=port, rates_hz={"/odom": 250.0})  # at once: the port is free again
    for client in clients:
        while client.connections < 2:
            client.receive(0.01)
        odometry(client, server, snapshot)
    # A new server begins with no command and no events: whoever drove before has to ask again.
    assert server.commands.empty()
    assert server.events.empty()
    for client in clients:
        client.disconnect()
