"""The bridge for a process or thread of its own: an asyncio server around the transport-free console bridge.

Every client has one task that takes texts out of its bounded queues and waits for its socket, so that a client that
stops reading stops nobody else and costs a bounded amount of memory.
"""

import asyncio
import logging
import socket
import time
from collections.abc import Callable
from http import HTTPStatus
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

from websockets.asyncio.server import Server, ServerConnection
from websockets.asyncio.server import serve as serve_websockets
from websockets.http11 import Request, Response

from simconsole.bridge.access import Role
from simconsole.bridge.console import ConsoleBridge
from simconsole.bridge.counters import standing
from simconsole.bridge.forms import Dialect
from simconsole.bridge.handshake import FORBIDDEN, FULL, UNKNOWN, dialect_of, is_host_allowed, origins, role_at
from simconsole.bridge.inputs import OnCommand, OnEvents
from simconsole.bridge.message_files import load_registry
from simconsole.bridge.messages import Registry
from simconsole.bridge.operate import OnAct
from simconsole.bridge.peer import CLOSE_S, Peer
from simconsole.bridge.record import TopicRecorder, open_recorder
from simconsole.bridge.session import Session
from simconsole.bridge.transport import Transport
from simconsole.bridge.uplink import Uplink
from simconsole.bridge.wire import (
    address_url,
    listen,
    load_access,
    load_tls,
    log_outcome,
)
from simconsole.errors import RemoteProtocolError
from simconsole.profiles.bridge import BridgeProfile
from simconsole.rows import Snapshot
from simconsole.units import NS_PER_S

if TYPE_CHECKING:
    from simconsole.bridge.ros2 import Ros2Link

_HANDSHAKE_S: Final = 5.0
_WATCH_S: Final = 0.25
_POLL_S: Final = 0.001
_COUNT_S: Final = 1.0
_STANDING_S: Final = 0.1
_WRITE_BYTES: Final = 32_768

_logger = logging.getLogger("simconsole.bridge.server")


class _Client:
    """One connection and what its sender is doing."""

    def __init__(self, transport: Transport) -> None:
        self.transport = transport
        self.ready = asyncio.Event()
        self.sending_since_ns: int | None = None


class BridgeServer:
    """A rosbridge server in a running event loop. All methods belong to that loop's thread."""

    def __init__(
        self,
        profile: BridgeProfile,
        *,
        registry: Registry | None = None,
        on_command: OnCommand | None = None,
        on_events: OnEvents | None = None,
        on_act: OnAct | None = None,
        clock_ns: Callable[[], int] = time.monotonic_ns,
        folder: Path | None = None,
    ) -> None:
        """Build the bridge; `start` opens it.

        Arguments and errors as `ConsoleBridge`; `clock_ns` is its clock, `folder` where topics are recorded.
        """
        registry = load_registry(profile) if registry is None else registry
        self.console = ConsoleBridge(profile, registry, on_command, on_events, on_act)
        self._folder = folder
        self._recorder: TopicRecorder | None = None
        self._profile = profile
        self._access = self.console.router.access = load_access(profile)
        self._tls = load_tls(profile)
        self._clock_ns = clock_ns
        self._clients: dict[Session, _Client] = {}
        self._server: Server | None = None
        self._watcher: asyncio.Task[None] | None = None
        self._uplink: asyncio.Task[None] | None = None
        self._port = 0
        self._ros2: Ros2Link | None = None
        self._ros2_woken = False

    @property
    def port(self) -> int:
        """The port listened on, 0 before `start`."""
        return self._port

    @property
    def url(self) -> str:
        """Where clients connect."""
        return address_url(self._profile.host, self._port, self._tls is not None)

    @property
    def clients(self) -> int:
        """How many clients are connected."""
        return len(self._clients)

    def standing(self) -> str:
        """Return how the link stands, in one word of `simconsole.words`."""
        return standing(self.console.router, self._clock_ns())

    async def start(self) -> None:
        """Listen.

        Raises:
            BridgeError: the address cannot be listened on.
        """
        listener = listen(self._profile.host, self._profile.port)
        self._port = int(listener.getsockname()[1])
        self._server = await serve_websockets(
            self._serve_client,
            sock=listener,
            ssl=self._tls,
            origins=cast("Any", origins(self._profile)),  # a NewType of str there
            process_request=self._admit,
            create_connection=cast("Any", self._peer),  # any function will do; its type says a class
            compression=None,
            max_size=self._profile.limits.message_bytes,
            ping_interval=None,  # `_watch` asks, and cuts nobody who is merely slow
            open_timeout=_HANDSHAKE_S,
            close_timeout=CLOSE_S,
            server_header=None,
            logger=_logger,
        )
        self._watcher = asyncio.create_task(self._watch())
        if self._profile.upstream is not None:
            uplink = Uplink(self.console, self._profile.upstream, self._clock_ns)
            self._uplink = asyncio.create_task(uplink.run())
        self._recorder = open_recorder(self.console, self._profile, self._folder)
        if self._profile.ros2 is not None:
            self._join_ros2(asyncio.get_running_loop())

    def publish(self, snapshot: Snapshot) -> None:
        """Queue what is due of a snapshot; the clients' tasks send it."""
        now_ns = self._clock_ns()
        if self._recorder is not None:
            self._recorder.look(now_ns)
        self.console.publish(snapshot, now_ns)
        if self._ros2 is not None:
            self._ros2.check()

    async def close(self) -> None:
        """Say good-bye to all clients and stop listening; harmless when closed."""
        if self._ros2 is not None:
            self._ros2.close()
            self._ros2 = None
        if self._recorder is not None:
            self._recorder.close()
        if self._watcher is not None:
            self._watcher.cancel()
            self._watcher = None
        if self._uplink is not None:
            self._uplink.cancel()
            await asyncio.gather(self._uplink, return_exceptions=True)
            self._uplink = None
        server, self._server = self._server, None
        if server is not None:
            server.close()
            try:
                async with asyncio.timeout(2.0 * CLOSE_S):
                    await server.wait_closed()
            except TimeoutError:  # somebody takes nothing, not even a good-bye
                for client in self._clients.values():
                    client.transport.abort()
                await server.wait_closed()

    def _join_ros2(self, loop: asyncio.AbstractEventLoop) -> None:
        from simconsole.bridge.ros2 import Ros2Link

        def wake() -> None:
            if not self._ros2_woken:
                self._ros2_woken = True
                loop.call_soon_threadsafe(self._pump_ros2)

        self._ros2 = Ros2Link(self.console, self._profile, wake)

    def _pump_ros2(self) -> None:
        self._ros2_woken = False
        if self._ros2 is not None:
            self._ros2.pump(self._clock_ns())

    def _admit(self, connection: ServerConnection, request: Request) -> Response | None:
        hosts = request.headers.get_all("Host")
        if len(hosts) != 1 or not is_host_allowed(hosts[0], self._profile):
            return connection.respond(HTTPStatus.FORBIDDEN, f"{FORBIDDEN}\n")
        try:
            self._role(request)
        except RemoteProtocolError:
            return connection.respond(HTTPStatus.UNAUTHORIZED, f"{UNKNOWN}\n")
        if len(self._clients) >= self._profile.limits.clients:
            return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, f"{FULL}\n")
        return None

    def _role(self, request: Request) -> Role:
        given = request.headers.get_all("Authorization")
        return role_at(request.path, given[0] if given else None, self._access)

    def _peer(self, *arguments: Any, **options: Any) -> Peer:
        return Peer(self._profile, self._clock_ns, *arguments, **options)

    async def _serve_client(self, connection: ServerConnection) -> None:
        assert isinstance(connection, Peer)
        sock: socket.socket = connection.transport.get_extra_info("socket")
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        host, port = connection.remote_address[:2]
        assert connection.request is not None
        dialect = dialect_of(connection.request.path, self._profile)
        await self.attend(connection, f"{host}:{port}", dialect, self._role(connection.request))

    async def attend(self, transport: Transport, peer: str, dialect: Dialect, role: Role) -> None:
        """Serve one client until its connection ends; `peer` names it in the log."""
        client = _Client(transport)
        session = self.console.router.connect(peer, client.ready.set, dialect, role)
        self._clients[session] = client
        _logger.info("%s connected", session.peer)
        sender = asyncio.create_task(self._send(session, client))
        try:
            async for data in transport.messages():
                log_outcome(_logger, session, self.console.receive(session, data, self._clock_ns()))
        finally:
            sender.cancel()
            del self._clients[session]
            commanded = self.console.disconnect(session, self._clock_ns())
            if commanded and self._server is not None:
                _logger.warning("%s was commanding and is gone", session.peer)
            else:  # also when it was this side that closed
                _logger.info("%s is gone", session.peer)

    async def _send(self, session: Session, client: _Client) -> None:
        """Send what waits for one client, for as long as it is connected."""
        transport = client.transport
        while True:
            await client.ready.wait()
            client.ready.clear()
            while transport.is_open and (messages := self._due(session)):
                client.sending_since_ns = self._clock_ns()
                await transport.put(messages)
                client.sending_since_ns = None
            due_ns = session.due_ns()
            if due_ns is not None and transport.is_open:
                # Throttled: look again when the first may go, whether or not more is published until then.
                wait_s = max(0, due_ns - self._clock_ns()) / NS_PER_S
                asyncio.get_running_loop().call_later(wait_s, client.ready.set)

    def _due(self, session: Session) -> list[bytes]:
        """Return the messages that may be sent now, at most a system call's worth of them."""
        messages: list[bytes] = []
        size, now_ns = 0, self._clock_ns()
        while size < _WRITE_BYTES and (message := session.next_text(now_ns)) is not None:
            messages.append(message)
            size += len(message)
        return messages

    async def _watch(self) -> None:
        """Ask quiet clients for a sign of life, cut those that are gone and those that take nothing."""
        while True:
            await asyncio.sleep(_WATCH_S)
            self.look()

    def look(self) -> None:
        """Do what is due of it now."""
        now_ns = self._clock_ns()
        self.console.router.calls.expire(now_ns)
        for session, client in list(self._clients.items()):
            reason = self._why_cut(client, now_ns)
            if reason is not None:
                _logger.warning("%s %s and is cut", session.peer, reason)
                client.transport.abort()

    def _why_cut(self, client: _Client, now_ns: int) -> str | None:
        since_ns, patience_s = client.sending_since_ns, self._profile.stall_close_s
        if client.transport.is_open and since_ns is not None and now_ns - since_ns > patience_s * NS_PER_S:
            return f"took nothing for {patience_s:g} s"
        return client.transport.look(now_ns)


def serve(
    profile: BridgeProfile,
    read_snapshot: Callable[[], Snapshot | None],
    write_command: OnCommand,
    write_events: OnEvents,
    stop: Callable[[], bool],
    *,
    on_ready: Callable[[int], None] = lambda port: None,
    on_act: OnAct | None = None,
    on_counts: Callable[[dict[str, int]], None] = lambda counts: None,
    on_standing: Callable[[str], None] = lambda state: None,
    registry: Registry | None = None,
    folder: Path | None = None,
) -> None:
    """Run a bridge server until `stop()` says so; for a process of its own.

    Args:
        profile: names, rates, limits.
        read_snapshot: asked every millisecond; returns the newest snapshot, None when there is no newer one.
        write_command: gets each change of the command and its receipt on the monotonic clock in ns, at once.
        write_events: gets each mask of events, at once.
        stop: asked every millisecond.
        on_ready: gets the port when the server listens.
        on_act: gets each act of an operator, at once.
        on_counts: gets what was counted, once a second and at the end.
        on_standing: gets how the link stands, within 0.1 s of a change and once a second.
        registry: message types; without, the standard ones and those of the profile's folder.
        folder: where topics are recorded if the profile says so.

    Raises:
        BridgeError: the address cannot be listened on.
        ProfileError: as `ConsoleBridge`.
    """

    async def main() -> None:
        server = BridgeServer(
            profile,
            registry=registry,
            on_command=write_command,
            on_events=write_events,
            on_act=on_act,
            folder=folder,
        )
        await server.start()
        on_ready(server.port)
        next_count_s = next_look_s = 0.0
        told = ""
        try:
            while not stop():
                now_s = time.monotonic()
                if now_s >= next_count_s:
                    next_count_s = now_s + _COUNT_S
                    on_counts(server.console.counts())
                    told = ""
                if now_s >= next_look_s or not told:
                    next_look_s = now_s + _STANDING_S
                    state = server.standing()
                    if state != told:
                        told = state
                        on_standing(state)
                snapshot = read_snapshot()
                if snapshot is not None:
                    server.publish(snapshot)
                await asyncio.sleep(_POLL_S)
        finally:
            on_counts(server.console.counts())
            await server.close()

    asyncio.run(main())
