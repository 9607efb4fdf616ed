"""Servers to be measured, each in a process of its own: ours, and bare brokers of the same libraries.

A bare broker parses, encodes once and fans out, with no validation: what is left to gain.
"""

import asyncio
import importlib.util
import multiprocessing
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

import orjson
from websockets.asyncio.server import ServerConnection
from websockets.asyncio.server import serve as serve_websockets

from simconsole.processes.lifetimes import attached
from simconsole.values.errors import BridgeError

_START_S: Final = 30.0
_TICKS_PER_S: Final = 100.0
"""What /proc counts processor time in (Linux: proc.5, USER_HZ)."""
_USER_AT: Final = 11
"""Index of utime, then stime, in /proc/PID/stat behind the name's bracket."""


class RunningServer(NamedTuple):
    """A server that runs."""

    server: str
    library: str
    url: str
    process: int | None

    def cpu_s(self) -> float | None:
        """Return the processor time it has taken, None where the system does not say."""
        try:
            text = Path(f"/proc/{self.process}/stat").read_text()
        except OSError:
            return None
        fields = text.rpartition(")")[2].split()
        return (int(fields[_USER_AT]) + int(fields[_USER_AT + 1])) / _TICKS_PER_S


@contextmanager
def running_servers() -> Iterator[list[RunningServer]]:
    """Run every server until the block's end.

    Raises:
        BridgeError: one does not start.
    """
    programs: list[tuple[str, str, Callable[[Connection], None]]] = [
        ("bare", "websockets", _serve_bare),
        ("simconsole", "websockets", _serve_ours),
    ]
    if importlib.util.find_spec("picows") is not None:
        programs += [("bare", "picows", _serve_bare_picows), ("simconsole", "picows", _serve_ours_picows)]
    with ExitStack() as servers:
        yield [servers.enter_context(server_process(name, library, program))[0] for name, library, program in programs]


@contextmanager
def server_process(
    name: str, library: str, program: Callable[[Connection], None]
) -> Iterator[tuple[RunningServer, Connection]]:
    """Run `program` in a process until the block's end; it sends its port through its end of the pipe first.

    Raises:
        BridgeError: it does not start.
    """
    context = multiprocessing.get_context("spawn")
    ours: Any
    ours, theirs = context.Pipe()  # another class on Windows
    process = context.Process(target=attached, args=(program, theirs), daemon=True)
    process.start()
    try:
        if not ours.poll(_START_S):
            raise BridgeError(f"the {name} server on {library} did not start")
        yield RunningServer(name, library, f"ws://127.0.0.1:{ours.recv()}", process.pid), ours
    finally:
        ours.close()
        process.terminate()
        process.join()


def _serve_ours(pipe: Connection, transport: Literal["websockets", "picows"] = "websockets") -> None:
    from simconsole.bridge.transport.server import serve
    from simconsole.profiles.bridge import BridgeProfile

    profile = BridgeProfile(port=0, transport=transport)
    # Until it is terminated: asking a pipe every millisecond would be measured too.
    serve(profile, lambda: None, lambda *_: None, lambda _: None, lambda: False, on_ready=pipe.send)


def _serve_ours_picows(pipe: Connection) -> None:
    _serve_ours(pipe, "picows")


def _serve_bare(pipe: Connection) -> None:
    listening: dict[str, list[ServerConnection]] = {}

    async def client(peer: ServerConnection) -> None:
        """Take subscriptions, and pass on what is published to the subscribers."""
        async for text in peer:
            operation = orjson.loads(text)
            if operation["op"] == "subscribe":
                listening.setdefault(operation["topic"], []).append(peer)
            elif operation["op"] == "publish":
                encoded = orjson.dumps(operation)
                for listener in listening.get(operation["topic"], []):
                    await listener.send(encoded, text=True)

    async def main() -> None:
        """Say the port, and serve until the process is ended."""
        async with serve_websockets(client, "127.0.0.1", 0, compression=None) as server:
            pipe.send(next(iter(server.sockets)).getsockname()[1])
            await server.serve_forever()

    asyncio.run(main())


def _serve_bare_picows(pipe: Connection) -> None:
    from picows import WSFrame, WSListener, WSMsgType, WSTransport, ws_create_server

    listening: dict[str, list[WSTransport]] = {}

    class Client(WSListener):
        def on_ws_frame(self, transport: WSTransport, frame: WSFrame) -> None:
            """Take a subscription, pass on what is published, or end the connection."""
            if frame.msg_type == WSMsgType.CLOSE:
                transport.disconnect()
                return
            operation = orjson.loads(frame.get_payload_as_memoryview())
            if operation["op"] == "subscribe":
                listening.setdefault(operation["topic"], []).append(transport)
            elif operation["op"] == "publish":
                encoded = orjson.dumps(operation)
                for listener in listening.get(operation["topic"], []):
                    listener.send(WSMsgType.TEXT, encoded)

    async def main() -> None:
        """Say the port, and serve until the process is ended."""
        server = await ws_create_server(lambda _: Client(), "127.0.0.1", 0)
        pipe.send(server.sockets[0].getsockname()[1])
        await server.serve_forever()

    asyncio.run(main())
