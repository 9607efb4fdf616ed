"""What the server asks of a connection: websockets' gives it, and so does another, here one in memory."""

import asyncio
import json
import time
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from functools import partial
from typing import Any, Protocol

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.asyncio.server import ServerConnection, serve

from simconsole.bridge.access import Role
from simconsole.bridge.documents import Binary
from simconsole.bridge.peer import Peer
from simconsole.bridge.server import BridgeServer
from simconsole.bridge.transport import Transport
from simconsole.profiles.bridge import BridgeProfile

PROFILE = BridgeProfile(port=0)


class Far(Protocol):
    """The client's end."""

    async def say(self, message: bytes) -> None: ...
    async def hear(self) -> bytes: ...
    async def leave(self) -> None: ...


class InMemory:
    """A transport without any network: two queues."""

    def __init__(self) -> None:
        self.is_open = True
        self._in: asyncio.Queue[bytes | None] = asyncio.Queue()
        self._out: asyncio.Queue[bytes] = asyncio.Queue(maxsize=2)

    async def messages(self) -> AsyncIterator[bytes]:
        while (message := await self._in.get()) is not None:
            yield message

    async def put(self, messages: Sequence[bytes]) -> None:
        for message in messages:
            await self._out.put(message)

    def abort(self) -> None:
        self.is_open = False
        self._in.put_nowait(None)

    def look(self, now_ns: int) -> str | None:
        return None

    async def say(self, message: bytes) -> None:
        await self._in.put(message)

    async def hear(self) -> bytes:
        return await self._out.get()

    async def leave(self) -> None:
        self.abort()


class OverSockets:
    """The client's end of a WebSocket."""

    def __init__(self, peer: ClientConnection) -> None:
        self._peer = peer

    async def say(self, message: bytes) -> None:
        await self._peer.send(message, text=not isinstance(message, Binary))

    async def hear(self) -> bytes:
        message = await self._peer.recv()
        return message.encode() if isinstance(message, str) else Binary(message)

    async def leave(self) -> None:
        await self._peer.close()


@asynccontextmanager
async def in_memory() -> AsyncIterator[tuple[Transport, Far]]:
    both = InMemory()
    yield both, both


@asynccontextmanager
async def over_sockets() -> AsyncIterator[tuple[Transport, Far]]:
    came: asyncio.Queue[Peer] = asyncio.Queue()

    async def serve_client(connection: ServerConnection) -> None:
        assert isinstance(connection, Peer)
        came.put_nowait(connection)
        await connection.wait_closed()

    make: Any = partial(Peer, PROFILE, time.monotonic_ns)
    options = {"compression": None, "ping_interval": None}
    async with serve(serve_client, "127.0.0.1", 0, create_connection=make, **options) as server:  # type: ignore[arg-type]  # a dictionary of options
        port = next(iter(server.sockets)).getsockname()[1]
        async with connect(f"ws://127.0.0.1:{port}", max_size=None) as far:
            yield await came.get(), OverSockets(far)


Pair = Callable[[], AbstractAsyncContextManager[tuple[Transport, Far]]]
both = pytest.mark.parametrize("pair", [in_memory, over_sockets])


def run(pair: Pair, check: Callable[[Transport, Far], Any]) -> None:
    async def main() -> None:
        async with asyncio.timeout(20.0), pair() as (transport, far):
            await check(transport, far)

    asyncio.run(main())


@both
def test_messages_come_in_whole_and_say_whether_they_are_text(pair: Pair) -> None:
    async def check(transport: Transport, far: Far) -> None:
        said = [b"{}", Binary(b"\xa0"), b"x" * 100_000]
        for message in said:
            await far.say(message)
        await far.leave()
        heard = [message async for message in transport.messages()]
        assert heard == said
        assert [isinstance(message, Binary) for message in heard] == [False, True, False]
        assert not transport.is_open

    run(pair, check)


@both
def test_messages_go_out_in_order_and_wait_for_who_does_not_read(pair: Pair) -> None:
    async def check(transport: Transport, far: Far) -> None:
        given = [bytes([65 + number]) * 65_536 for number in range(20)]
        rounds = 20

        async def send() -> None:
            for _ in range(rounds):
                await transport.put(given)

        sender = asyncio.create_task(send())
        done, _ = await asyncio.wait([sender], timeout=0.1)
        assert not done, "26 MB were taken though nobody reads"
        for _ in range(rounds):
            assert [await far.hear() for _ in given] == given
        await sender

    run(pair, check)


@both
def test_abort_ends_it_at_once(pair: Pair) -> None:
    async def check(transport: Transport, far: Far) -> None:
        assert transport.is_open
        assert transport.look(0) is None
        transport.abort()
        assert [message async for message in transport.messages()] == []
        assert not transport.is_open

    run(pair, check)


@both
def test_a_server_drives_over_it(pair: Pair, snapshot: Callable[..., Any], control: Callable[..., Any]) -> None:
    async def check(transport: Transport, far: Far) -> None:
        server = BridgeServer(PROFILE)
        client = asyncio.create_task(server.attend(transport, "far", "ros2", Role.CONTROL))
        await far.say(b'{"op":"subscribe","topic":"/odom"}')
        while not server.console.router.wanted("/odom"):
            await asyncio.sleep(0)
        server.publish(snapshot(5, x_m=7.0))
        assert json.loads(await far.hear())["msg"]["pose"]["pose"]["position"]["x"] == 7.0
        command = {"op": "publish", "topic": "/control/command/control_cmd", "msg": control(0.25)}
        await far.say(json.dumps(command).encode())
        while server.console.inputs.command.sequence == 0.0:
            await asyncio.sleep(0)
        assert server.console.inputs.command.road_wheel_rad == 0.25
        await far.leave()
        await client
        assert server.clients == 0

    run(pair, check)
