"""The client that comes back, over real sockets."""

import gc
import socket
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from simconsole.bridge.steady_client import SteadyClient
from simconsole.errors import LocalProtocolError

RESTARTS = 100
CONTROL = "/control/command/control_cmd"


def open_files() -> int:
    return len(list(Path("/proc/self/fd").iterdir()))


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


def odometry(client: SteadyClient, server: Any, snapshot: Callable[..., Any]) -> None:
    """Return when odometry of this server has arrived."""
    for tick in range(10, 10_000, 5):
        server.snapshots.put(snapshot(tick))
        received = client.receive(0.02)
        if received is not None:
            assert received.topic == "/odom"
            return
    pytest.fail("no odometry")


def test_everything_is_there_again_after_each_of_many_restarts(
    serving: Callable[..., Any], snapshot: Callable[..., Any], control: Callable[..., Any]
) -> None:
    port, states = free_port(), []
    times_s = []
    with SteadyClient(f"ws://127.0.0.1:{port}", on_state=states.append, first_s=0.005, cap_s=0.02) as client:
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.advertise(CONTROL, "autoware_control_msgs/Control")
        assert not client.publish(CONTROL, control())
        descriptors = 0
        for number in range(RESTARTS):
            server = serving(port=port, rates_hz={"/odom": 250.0})
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
        client.receive(0.05)
        gc.collect()
        assert open_files() <= descriptors
        assert threading.active_count() <= threads
    assert client.connections == RESTARTS
    assert states == ["connected", "connecting"] * RESTARTS
    assert client.failure
    print(f"measured: restored after a restart {sorted(times_s)[RESTARTS // 2]:.3f} s (median), {max(times_s):.3f} s")


def test_silent_server_is_given_up(monkeypatch: pytest.MonkeyPatch, serving: Callable[..., Any]) -> None:
    server = serving()
    with SteadyClient(server.url, first_s=0.01, cap_s=0.02) as client:
        assert client.receive(0.05) is None
        assert client.state == "connected"
        # As if three seconds had passed in silence, and a ping had not been answered.
        client._liveness.begin(time.monotonic() - 3.5)
        client._client.heard_s = 0.0
        assert client.receive(0.0) is None
        assert (client.state, client.connections) == ("connecting", 1)
        assert "silent" in client.failure
        assert client.receive(0.2) is None
        assert (client.state, client.connections) == ("connected", 2)


def test_ping_keeps_a_quiet_connection(serving: Callable[..., Any]) -> None:
    with SteadyClient(serving().url) as client:
        client.receive(0.01)
        client._liveness.begin(time.monotonic() - 1.5)
        client._client.heard_s = 0.0
        assert client.receive(0.3) is None
        assert client._client.heard_s > 0.0
        assert client.connections == 1


def test_a_programs_own_mistakes_are_not_swallowed(serving: Callable[..., Any]) -> None:
    with SteadyClient(serving().url) as client:
        client.receive(0.01)
        client.advertise("/a", "std_msgs/String")
        with pytest.raises(LocalProtocolError, match="cannot be std_msgs/msg/Bool too"):
            client.advertise("/a", "std_msgs/Bool")
        with pytest.raises(LocalProtocolError, match="advertise it before"):
            client.publish("/b", {})
        client.unadvertise("/a")
        client.subscribe("/a", "std_msgs/String")
        client.unsubscribe("/a")
        assert client.registry.struct("std_msgs/String")
