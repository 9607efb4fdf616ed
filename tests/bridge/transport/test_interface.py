"""What server and connections ask of each other: each library's connections give it, and so does one in memory."""

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from functools import partial
from typing import Any, Protocol

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.frames import Frame, Opcode
from websockets.protocol import Protocol as WebSocketProtocol
from websockets.protocol import Side

from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.frames import FRAME_BYTES, INVALID_DATA, FrameWriter, MessageAssembler, framed
from simconsole.bridge.protocol.handshake import Admission, HandshakeRequest, Refusal
from simconsole.bridge.protocol.message_decoding import Binary
from simconsole.bridge.transport.interface import Connection, ConnectionHandler
from simconsole.bridge.transport.server import BridgeServer
from simconsole.bridge.transport.sockets import listen
from simconsole.bridge.transport.transport_registry import load_transport
from simconsole.profiles.bridge import BridgeProfile
from tests.patience import PATIENCE_S, stamp_ns, until

PROFILE = BridgeProfile(port=0)
ADMISSION = Admission(Role.CONTROL, "ros2")


class Far(Protocol):
    """The client's end."""

    async def say(self, message: bytes) -> None: ...
    async def hear(self) -> bytes: ...
    async def leave(self) -> None: ...


class Notes:
    """A client as the server has it, who notes what it is told."""

    def __init__(self) -> None:
        self.heard: list[bytes] = []
        self.resumed = 0
        self.ended = 0

    def receive(self, message: bytes) -> None:
        self.heard.append(message)

    def resume(self) -> None:
        self.resumed += 1

    def closed(self) -> None:
        self.ended += 1


class Home:
    """Lets everybody in; the latest connection and its client are kept. `make` makes the client."""

    def __init__(self, make: Callable[[Connection], ConnectionHandler]) -> None:
        self.connection: Connection | None = None
        self.client: ConnectionHandler | None = None
        self._make = make

    def admit(self, request: HandshakeRequest) -> Admission | Refusal:
        return ADMISSION

    def accept(self, connection: Connection, peer: str, admission: Admission) -> ConnectionHandler:
        self.connection, self.client = connection, self._make(connection)
        return self.client


class InMemory:
    """A transport without any network: two messages may wait to be heard."""

    def __init__(self) -> None:
        self.is_open = True
        self.client: ConnectionHandler
        self.max_bytes = 0
        self._protocol = WebSocketProtocol(Side.CLIENT, max_size=None)
        self._parts = MessageAssembler(1 << 30)
        self._out: list[bytes] = []
        self._more = asyncio.Event()

    @property
    def takes_more(self) -> bool:
        return len(self._out) < 2

    def write(self, frames: bytes) -> None:
        self._protocol.receive_data(frames)
        for frame in self._protocol.events_received():
            assert isinstance(frame, Frame)
            message = self._parts.add(frame.opcode, bytes(frame.data), frame.fin, 0)
            if message is not None:
                self._out.append(message)
        self._more.set()

    def limit_messages(self, max_bytes: int) -> None:
        self.max_bytes = max_bytes

    def pause_reading(self) -> None:
        """What a far end in memory says is here at once."""

    def resume_reading(self) -> None:
        """See `pause_reading`."""

    def abort(self) -> None:
        if self.is_open:
            self.is_open = False
            asyncio.get_running_loop().call_soon(self.client.closed)

    def check(self, now_ns: int) -> str | None:
        return None

    async def say(self, message: bytes) -> None:
        self.client.receive(message)

    async def hear(self) -> bytes:
        while not self._out:
            self._more.clear()
            await self._more.wait()
        was_full = not self.takes_more
        message = self._out.pop(0)
        if was_full and self.takes_more:
            self.client.resume()
        return message

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

    def write(self, data: bytes) -> None:
        """Send octets as they are, in one piece."""
        self._peer.transport.write(data)

    async def close_code(self) -> int | None:
        await self._peer.wait_closed()
        return self._peer.close_code


@asynccontextmanager
async def in_memory(
    make: Callable[[Connection], ConnectionHandler],
) -> AsyncIterator[tuple[Connection, ConnectionHandler, Far]]:
    both = InMemory()
    both.client = make(both)
    yield both, both.client, both


@asynccontextmanager
async def over_sockets(
    library: Any, make: Callable[[Connection], ConnectionHandler]
) -> AsyncIterator[tuple[Connection, ConnectionHandler, Far]]:
    profile = BridgeProfile(port=0, transport=library)
    sock = listen(profile.host, 0)
    home = Home(make)
    listener = await load_transport(profile)(home, sock, profile, None, stamp_ns)
    async with connect(f"ws://127.0.0.1:{sock.getsockname()[1]}", max_size=None) as far:
        await until(lambda: home.client is not None)
        assert home.client is not None
        assert home.connection is not None
        try:
            yield home.connection, home.client, OverSockets(far)
        finally:
            home.connection.abort()
            listener.close()
            await listener.wait_closed()


Pair = Callable[[Callable[[Connection], ConnectionHandler]], AbstractAsyncContextManager[tuple[Connection, Any, Far]]]
each = pytest.mark.parametrize(
    "pair",
    [in_memory, partial(over_sockets, "websockets"), partial(over_sockets, "picows")],
    ids=["in memory", "websockets", "picows"],
)


def run(pair: Pair, check: Callable[[Connection, Notes, Far], Any]) -> None:
    async def main() -> None:
        async with asyncio.timeout(PATIENCE_S), pair(lambda _: Notes()) as (connection, client, far):
            await check(connection, client, far)

    asyncio.run(main())


@each
def test_messages_come_in_whole_and_say_whether_they_are_text(pair: Pair) -> None:
    async def check(connection: Connection, client: Notes, far: Far) -> None:
        said = [b"{}", Binary(b"\xa0"), b"x" * 100_000]
        for message in said:
            await far.say(message)
        await far.leave()
        await until(lambda: client.ended == 1)
        assert client.heard == said
        assert [isinstance(message, Binary) for message in client.heard] == [False, True, False]
        assert not connection.is_open

    run(pair, check)


@pytest.mark.parametrize("library", ["websockets", "picows"])
def test_what_arrives_in_one_piece_is_taken_in_order_up_to_wrong_text(library: str) -> None:
    said = [(Opcode.TEXT, b"{}"), (Opcode.PING, b"p"), (Opcode.BINARY, b"\xa0"), (Opcode.TEXT, b"[]")]
    wrong = [(Opcode.TEXT, b"1"), (Opcode.TEXT, b"\xff"), (Opcode.TEXT, b"2")]

    def piece(messages: list[tuple[Opcode, bytes]]) -> bytes:
        return b"".join(Frame(opcode, data).serialize(mask=True) for opcode, data in messages)

    async def check(connection: Connection, client: Notes, far: Far) -> None:
        assert isinstance(far, OverSockets)
        whole = piece(said)
        far.write(whole + whole[:5])
        await until(lambda: len(client.heard) == 3)
        far.write(whole[5:])
        await until(lambda: len(client.heard) == 6)
        far.write(piece(wrong))
        assert await far.close_code() == INVALID_DATA
        assert client.heard == [b"{}", b"\xa0", b"[]", b"{}", b"\xa0", b"[]", b"1"]

    run(partial(over_sockets, library), check)


@each
def test_messages_go_out_in_order_and_no_more_are_taken_of_who_does_not_read(pair: Pair) -> None:
    async def check(connection: Connection, client: Notes, far: Far) -> None:
        given = [bytes([65 + number % 26]) * 65_536 for number in range(400)]
        sent = 0
        while connection.takes_more:
            connection.write(framed(given[sent : sent + 1]))
            sent += 1
            await asyncio.sleep(0)
        assert sent < len(given), "26 MB were taken though nobody reads"
        assert client.resumed == 0
        heard = 0
        while heard < len(given):
            if connection.takes_more and sent < len(given):
                connection.write(framed(given[sent : sent + 1]))
                sent += 1
            assert await far.hear() == given[heard]
            heard += 1
        assert client.resumed > 0

    run(pair, check)


@each
def test_text_and_binary_go_out_as_they_are(pair: Pair) -> None:
    async def check(connection: Connection, client: Notes, far: Far) -> None:
        connection.write(framed([b"a", Binary(b"b")]))
        heard = [await far.hear(), await far.hear()]
        assert heard == [b"a", b"b"]
        assert [isinstance(message, Binary) for message in heard] == [False, True]

    run(pair, check)


@each
def test_abort_ends_it_at_once(pair: Pair) -> None:
    async def check(connection: Connection, client: Notes, far: Far) -> None:
        assert connection.is_open
        assert connection.check(0) is None
        connection.abort()
        await until(lambda: client.ended == 1)
        assert client.heard == []
        assert not connection.is_open

    run(pair, check)


@each
def test_a_server_drives_over_it(pair: Pair, snapshot: Callable[..., Any], control: Callable[..., Any]) -> None:
    async def main() -> None:
        server = BridgeServer(PROFILE)

        def accept(connection: Connection) -> ConnectionHandler:
            return server.accept(connection, "far", ADMISSION)

        async with asyncio.timeout(PATIENCE_S), pair(accept) as (_, _, far):
            await far.say(b'{"op":"subscribe","topic":"/odom"}')
            await until(lambda: server.console.router.has_subscribers("/odom"))
            server.publish(snapshot(5, x_m=7.0))
            assert json.loads(await far.hear())["msg"]["pose"]["pose"]["position"]["x"] == 7.0
            command = {"op": "publish", "topic": "/control/command/control_cmd", "msg": control(0.25)}
            await far.say(json.dumps(command).encode())
            await until(lambda: server.console.inputs.command.sequence > 0.0)
            assert server.console.inputs.command.road_wheel_rad == 0.25
            assert server.clients == 1
            await far.leave()
            await until(lambda: server.clients == 0)

    asyncio.run(main())


@each
def test_long_message_comes_whole_in_several_frames(pair: Pair) -> None:
    message = b"x" * (2 * FRAME_BYTES + 1)

    async def check(connection: Connection, client: Notes, far: Far) -> None:
        given, writer = [Binary(message), message, b"{}"], FrameWriter()
        take = iter(given)
        while frames := writer.batch(lambda: next(take, None), FRAME_BYTES):
            assert len(frames) < FRAME_BYTES + 100
            connection.write(frames)
        for said in given:
            heard = await far.hear()
            assert heard == said
            assert isinstance(heard, Binary) is isinstance(said, Binary)

    run(pair, check)


@each
def test_length_of_messages_can_be_changed(pair: Pair) -> None:
    async def check(connection: Connection, client: Notes, far: Far) -> None:
        connection.limit_messages(5_000_000)
        await far.say(b"x" * 4_000_000)
        await until(lambda: len(client.heard) == 1)
        connection.limit_messages(1000)
        await far.say(b"x" * 1001)
        await until(lambda: not connection.is_open or isinstance(connection, InMemory))

    run(pair, check)
