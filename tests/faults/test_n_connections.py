"""N01, N04, N05, N06: connections that end, lose, delay, or are read by nobody; the others lose nothing."""

import asyncio
import json
import socket
import tracemalloc
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from time import process_time
from typing import Any

import pytest
from websockets.asyncio.client import ClientConnection, connect

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.bridge.transport.server import BridgeServer
from simconsole.bridge.transport.sockets import is_unacknowledged
from simconsole.profiles.bridge import BridgeLimits, BridgeProfile
from simconsole.values.signals import Event
from tests.bridge.networks import CLOSE, PING, PONG, Chaos, Raw, far_end, go_deaf, lose
from tests.patience import PATIENCE_S, stamp_ns, until
from tests.samples import Measured

CONTROL = "/control/command/control_cmd"
S = 10**9
MIB = 1 << 20
MESSAGES = 6000
"""Of odometry: more than the kernel and a queue of 1,000 keep for a reader that does not read."""


@asynccontextmanager
async def served(profile: BridgeProfile, clock_ns: Callable[[], int] = stamp_ns) -> AsyncIterator[BridgeServer]:
    server = BridgeServer(profile, clock_ns=clock_ns)
    await server.start()
    try:
        yield server
    finally:
        await server.close()


def looked(server: BridgeServer) -> int:
    """Let a server look after its clients; return how many are left."""
    server.check_clients()
    return server.clients


async def raw(server: BridgeServer, **options: Any) -> Raw:
    return await asyncio.to_thread(Raw, server.port, **options)


async def say(peer: ClientConnection, **operation: Any) -> None:
    await peer.send(json.dumps(operation))


@pytest.mark.fault("N01")
@pytest.mark.parametrize("how", ["close", "reset", "half", "frame"])
def test_n01_commander_that_closes_is_an_event_and_the_others_go_on(
    serving: Callable[..., Any], snapshot: Callable[..., Any], control: Callable[..., Any], how: str
) -> None:
    server = serving(lease_ms=10_000.0, rates_hz={"/odom": 250.0})
    with BridgeClient(server.url) as watcher:
        watcher.subscribe("/odom", "nav_msgs/Odometry", queue_length=1000)
        watcher.connect()
        with Raw(server.port) as commander:
            commander.say(op="publish", topic=CONTROL, msg=control(0.1))
            assert server.command().road_wheel_rad == 0.1
            if how == "reset":
                commander.vanish()
            elif how == "half":
                commander.sock.shutdown(socket.SHUT_WR)
            elif how == "frame":
                commander.send(CLOSE, (1000).to_bytes(2))
            else:
                commander.sock.close()
            assert server.events.get(timeout=PATIENCE_S) == Event.COMMANDER_LOST
        for tick in range(1, 51):
            server.snapshots.put(snapshot(tick, x_m=float(tick)))
            received = watcher.receive(PATIENCE_S)
            assert received is not None
            assert received.message.pose.pose.position.x == tick
        assert server.commands.empty()  # the last command stays what it was and grows old
        with Raw(server.port) as successor:
            successor.say(op="publish", topic=CONTROL, msg=control(0.2))
            assert server.command().road_wheel_rad == 0.2


@pytest.mark.fault("N04")
@pytest.mark.parametrize("subscribed", [False, True])
def test_n04_client_that_went_without_a_word_is_freed_after_three_seconds(
    snapshot: Callable[..., Any], control: Callable[..., Any], subscribed: bool, transport: Any
) -> None:
    """The clock is ours; what the kernel knows of the other side is real."""
    now_ns = 0

    async def main() -> None:
        nonlocal now_ns
        async with served(BridgeProfile(port=0, transport=transport), lambda: now_ns) as server:
            half = await raw(server)
            alive = await connect(server.url)
            await until(lambda: server.clients == 2)
            half.say(op="publish", topic=CONTROL, msg=control())
            if subscribed:
                half.say(op="subscribe", topic="/odom")
            await until(lambda: server.console.inputs.command.sequence == 1.0)
            await until(lambda: not subscribed or server.console.router.has_subscribers("/odom"))
            await until(lambda: not is_unacknowledged(half.sock, 0))  # or it would go on sending
            go_deaf(half.sock)
            for step in range(1, 14):
                now_ns = step * S // 4
                server.publish(snapshot(step))
                server.check_clients()
                pong = await alive.ping()
                await pong
                assert server.clients == 2 or now_ns >= 3 * S
            # The kernel, whose clock is its own, misses it for a second.
            await until(lambda: looked(server) < 2)
            assert server.console.inputs.take(1)[1].events == 0.0  # its lease had ended long before
            await alive.close()
            half.sock.close()

    asyncio.run(main())


@pytest.mark.fault("N04")
def test_n04_program_that_is_merely_slow_is_not_cut(control: Callable[..., Any], transport: Any) -> None:
    now_ns = 0

    async def main() -> None:
        nonlocal now_ns
        async with served(BridgeProfile(port=0, transport=transport), lambda: now_ns) as server:
            slow = await raw(server)
            await until(lambda: server.clients == 1)
            for second in range(1, 60):
                now_ns = second * S
                server.check_clients()  # it is pinged, and its kernel has that; it is busy and answers nothing
                await asyncio.sleep(0)
                assert server.clients == 1
            slow.say(op="publish", topic=CONTROL, msg=control())
            await until(lambda: server.console.inputs.command.sequence == 1.0)
            assert server.console.inputs.command.road_wheel_rad == 0.1
            slow.sock.close()

    asyncio.run(main())


@pytest.mark.fault("N05")
def test_n05_stalled_subscriber_costs_the_others_nothing_and_no_memory(transport: Any, measured: Measured) -> None:
    """A thousand messages of 20 kB: the others get every one, the stalled one's 20 MB are not kept anywhere."""
    messages, text = 1000, "x" * 20_000
    limits = BridgeLimits(queued_bytes=MIB)

    async def listen(server: BridgeServer, heard: list[int]) -> None:
        async with connect(server.url) as peer:
            await say(peer, op="subscribe", topic="/big", type="std_msgs/String", queue_length=1000)
            heard.append(-1)
            async for message in peer:
                heard.append(int(json.loads(message)["msg"]["data"].split()[0]))
                if len(heard) > messages:
                    return

    async def main() -> None:
        async with served(BridgeProfile(port=0, limits=limits, transport=transport, stall_close_s=600.0)) as server:
            stalled = await raw(server, receive_bytes=4096)
            stalled.say(op="subscribe", topic="/big", type="std_msgs/String", queue_length=1000)
            heard: list[list[int]] = [[], [], []]
            listeners = [asyncio.create_task(listen(server, each)) for each in heard]
            topics = server.console.router.topic_registry
            await until(lambda: (topic := topics.find("/big")) is not None and len(topic.subscribers) == 4)
            session = server.console.router.sessions[0]
            tracemalloc.start()
            before, _ = tracemalloc.get_traced_memory()
            most_queued = 0
            async with connect(server.url) as talker:
                for number in range(messages):
                    await say(talker, op="publish", topic="/big", msg={"data": f"{number} {text}"})
                    await until(lambda: all(len(each) > number + 1 for each in heard))  # noqa: B023  (ends here)
                    most_queued = max(most_queued, session.send_queue.bytes)
                await asyncio.gather(*listeners)
                gained = tracemalloc.get_traced_memory()[1] - before
                tracemalloc.stop()
            assert heard == [[-1, *range(messages)]] * 3
            assert most_queued <= MIB
            dropped = session.send_queue.dropped
            assert dropped > messages // 2
            # What waits for it is the newest.
            assert f'"{messages - 1} '.encode() in session.queues["/big"].texts[-1]
            assert gained < 10 * MIB
            seen = f"others lost 0 of {messages}, memory grew by {gained / MIB:.1f} MiB, it lost {dropped}"
            measured("N05", f"stalled subscriber, {transport}", seen, "0, 10 MiB")
        # It still read nothing, and the server has ended all the same.
        stalled.sock.close()

    asyncio.run(main())


@pytest.mark.fault("N05")
@pytest.mark.parametrize("transport", ["websockets", "picows"])
def test_n05_stalled_subscriber_costs_the_server_no_processor_time(
    transport: str, snapshot: Callable[..., Any], measured: Measured
) -> None:
    """The processor time of a message to three readers, with and without one more that reads nothing.

    Without, nothing fills up, and fewer messages tell it.
    """

    async def spent_us(server: BridgeServer, stalled: bool, messages: int = MESSAGES // 3) -> float:
        peers = [await connect(server.url) for _ in range(3)]
        half = await raw(server, receive_bytes=4096) if stalled else None
        for peer in peers:
            await say(peer, op="subscribe", topic="/odom", queue_length=1000)
        if half is not None:
            half.say(op="subscribe", topic="/odom", queue_length=1000)
        router = server.console.router
        await until(lambda: len(router.sessions) == 3 + stalled)
        await until(lambda: all("/odom" in session.queues for session in router.sessions))
        began_s = process_time()
        for tick in range(5, 5 * messages + 1, 5):
            server.publish(snapshot(tick))
            for peer in peers:
                await peer.recv()
        spent = 1e6 * (process_time() - began_s) / messages
        for peer in peers:
            await peer.close()
        if half is not None:
            assert max(session.send_queue.dropped for session in router.sessions) > 0, "it was behind"
            half.vanish()
        await until(lambda: not router.sessions)
        return spent

    async def main() -> tuple[float, float]:
        profile = BridgeProfile(port=0, transport=transport, stall_close_s=600.0, rates_hz={"/odom": 250.0})  # type: ignore[arg-type]
        async with served(profile) as server:
            await spent_us(server, False)
            pairs = [(await spent_us(server, True, MESSAGES), await spent_us(server, False)) for _ in range(3)]
        return min(pair[0] for pair in pairs), min(pair[1] for pair in pairs)

    beside_us, alone_us = asyncio.run(main())
    seen = f"{beside_us / alone_us:.2f} times that without one"
    measured(
        "N05", f"processor time beside a stalled subscriber, {transport}", seen, "at most 1.5, the share of a fourth"
    )
    assert beside_us <= 1.5 * alone_us


@pytest.mark.fault("N05")
def test_n05_slow_reader_gets_the_newest(serving: Callable[..., Any]) -> None:
    server = serving(limits=BridgeLimits(queued_bytes=65_536))
    with Raw(server.port, receive_bytes=4096) as slow, Raw(server.port) as talker:
        slow.say(op="subscribe", topic="/big", type="std_msgs/String")
        slow.say(op="no_such")
        assert slow.receive() is not None
        for number in range(2000):
            talker.say(op="publish", topic="/big", msg={"data": f"{number} " + "x" * 10_000}, type="std_msgs/String")
        talker.say(op="no_such")
        assert talker.receive() is not None
        newest, gaps = -1, 0
        while newest < 1999:
            received = slow.receive()
            assert received is not None
            if received[0] == PING:  # it took long
                slow.send(PONG, received[1])
                continue
            operation = json.loads(received[1])
            if operation["op"] == "publish":
                number = int(operation["msg"]["data"].split()[0])
                assert number > newest
                gaps += number > newest + 1
                newest = number
        assert gaps


@pytest.mark.fault("N06")
@pytest.mark.parametrize("network", ["lossy", "slow"])
def test_n06_commands_over_a_bad_network_arrive_in_order_or_not_at_all(
    serving: Callable[..., Any], snapshot: Callable[..., Any], control: Callable[..., Any], network: str
) -> None:
    """30 % of the packets lost each way, acknowledgements too, or 200 ms each way at 1 Mbit/s.

    Nobody is taken for gone, which is N04: by chance TCP may hear nothing for 3 s.
    """
    server = serving(rates_hz={"/odom": 250.0}, lease_ms=10_000.0, dead_after_s=PATIENCE_S)
    chaos = Chaos(server.port, 0.2, 125_000.0) if network == "slow" else None
    port = server.port if chaos is None else chaos.port
    with BridgeClient(f"ws://127.0.0.1:{port}", dead_after_s=PATIENCE_S) as client:
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.advertise(CONTROL, "autoware_control_msgs/Control")
        client.connect()
        if network == "lossy":
            assert client._connection._socket is not None
            with far_end(client._connection._socket) as far:
                lose(far, 0.3)
            lose(client._connection._socket, 0.3)
        answered, tick = 0, 0
        while answered < 10:
            tick += 1
            server.snapshots.put(snapshot(tick))
            received = client.receive(0.05)
            if received is not None:
                stamp_ns = received.message.header.stamp.nanosec + received.message.header.stamp.sec * S
                client.publish(CONTROL, control(answered / 100, stamp_ns=stamp_ns))
                answered += 1
        angles: list[float] = []
        sequences: list[float] = []
        while not angles or angles[-1] != 0.09:
            command = server.command()
            angles.append(command.road_wheel_rad)
            sequences.append(command.sequence)
        assert angles == sorted(set(angles))
        assert sequences == list(range(1, 11))
        assert client.connections == 1
    if chaos is not None:
        chaos.stop()
