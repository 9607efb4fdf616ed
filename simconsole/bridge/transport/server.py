"""The bridge for a process or thread of its own: an asyncio server around the transport-free console bridge.

Messages are applied as they are read and queued for who wants them; each client's queues are emptied into its
connection while that takes more, so that a client that stops reading stops nobody else and costs a bounded memory.
"""

import asyncio
import logging
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simconsole.bridge.console.counters import link_state
from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.input_slots import OnCommand, OnEvents
from simconsole.bridge.console.operator_acts import OnAct
from simconsole.bridge.console.plan_input import OnPlan
from simconsole.bridge.console.surroundings import NOWHERE, Surroundings
from simconsole.bridge.messages import Registry
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.handshake import Admission, HandshakeRequest, Refusal, admit, places
from simconsole.bridge.transport.client_handler import ClientHandler, ClientTurns
from simconsole.bridge.transport.client_log import log_departure, log_refusal
from simconsole.bridge.transport.credentials import load_access, load_tls
from simconsole.bridge.transport.interface import Connection, ConnectionHandler, Listener
from simconsole.bridge.transport.message_files import load_registry
from simconsole.bridge.transport.sockets import CLOSE_S, address_url, listen
from simconsole.bridge.transport.topic_recorder import TopicRecorder, open_recorder
from simconsole.bridge.transport.transport_registry import load_transport
from simconsole.bridge.transport.upstream_client import UpstreamClient
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import NS_PER_S

if TYPE_CHECKING:
    from simconsole.bridge.ros2.node import Ros2Link

_CHECK_S: Final = 0.25
_POLL_S: Final = 0.001
_COUNT_S: Final = 1.0
_LINK_STATE_S: Final = 0.1

_logger = logging.getLogger("simconsole.bridge.transport.server")


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
        drive: str | None = None,
        around: Surroundings = NOWHERE,
        on_plan: OnPlan | None = None,
    ) -> None:
        """Build the bridge; `start` opens it.

        Arguments and errors as `ConsoleBridge`; `clock_ns` is its clock, `folder` where topics are recorded, `drive`
        the nonce of the drive whose bridge it is.
        """
        registry = load_registry(profile) if registry is None else registry
        self.console = ConsoleBridge(
            profile,
            registry,
            on_command=on_command,
            on_events=on_events,
            on_act=on_act,
            around=around,
            on_plan=on_plan,
        )
        self._folder = folder
        self._drive = drive
        self._recorder: TopicRecorder | None = None
        self._profile = profile
        self._access = self.console.router.access = load_access(profile)
        self._tls = load_tls(profile)
        self.clock_ns = clock_ns
        self.turns = ClientTurns(clock_ns)
        self._clients: set[ClientHandler] = set()
        self._listener: Listener | None = None
        self._checker: asyncio.Task[None] | None = None
        self._upstream_client: asyncio.Task[None] | None = None
        self._port = 0
        self._turned_away = 0
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

    def link_state(self) -> str:
        """Return the link's state, in a word of `simconsole.values.labels`."""
        return link_state(self.console.router, self.clock_ns())

    async def start(self) -> None:
        """Listen.

        Raises:
            BridgeError: the address cannot be listened on.
        """
        listener = listen(self._profile.host, self._profile.port)
        self._port = int(listener.getsockname()[1])
        start_listener = load_transport(self._profile)
        self._listener = await start_listener(self, listener, self._profile, self._tls, self.clock_ns)
        self._checker = asyncio.create_task(self._check_periodically())
        if self._profile.upstream is not None:
            upstream_client = UpstreamClient(self.console, self._profile.upstream, self.clock_ns)
            self._upstream_client = asyncio.create_task(upstream_client.run())
        self._recorder = open_recorder(self.console, self._profile, self._folder)
        if self._profile.ros2 is not None:
            self._join_ros2(asyncio.get_running_loop())

    def publish(self, snapshot: Snapshot) -> None:
        """Queue what is due of a snapshot; the clients' tasks send it."""
        now_ns = self.clock_ns()
        if self._recorder is not None:
            self._recorder.update(now_ns)
        self.console.publish(snapshot, now_ns)
        if self._ros2 is not None:
            self._ros2.check()

    async def close(self) -> None:
        """Close all clients and stop listening; harmless when closed."""
        if self._ros2 is not None:
            self._ros2.close()
            self._ros2 = None
        if self._recorder is not None:
            self._recorder.close()
        if self._checker is not None:
            self._checker.cancel()
            self._checker = None
        if self._upstream_client is not None:
            self._upstream_client.cancel()
            await asyncio.gather(self._upstream_client, return_exceptions=True)
            self._upstream_client = None
        listener, self._listener = self._listener, None
        if listener is not None:
            listener.close()
            try:
                async with asyncio.timeout(2.0 * CLOSE_S):
                    await listener.wait_closed()
            except TimeoutError:  # a client takes nothing, not even the close frame
                for client in self._clients:
                    client.connection.abort()
                await listener.wait_closed()

    def admit(self, request: HandshakeRequest) -> Admission | Refusal:
        """Decide on a client's opening handshake (`Acceptor`)."""
        room = places((client.session for client in self._clients), self._profile.limits)
        decision = admit(request, self._profile, self._access, room, self._drive)
        if isinstance(decision, Refusal):
            self._turned_away += 1
            log_refusal(_logger, self._turned_away, decision)
        return decision

    def accept(self, connection: Connection, peer: str, admission: Admission) -> ConnectionHandler:
        """Add a client (`Acceptor`)."""
        client = ClientHandler(self, connection, peer, admission)
        self._clients.add(client)
        _logger.info("%s connected", peer)
        return client

    def remove(self, client: ClientHandler) -> None:
        """Forget a client whose connection has ended."""
        self._clients.discard(client)
        commanded = self.console.disconnect(client.session, self.clock_ns())
        is_this_side = self._listener is None
        log_departure(_logger, client.session.peer, commanded and not is_this_side)

    def _join_ros2(self, loop: asyncio.AbstractEventLoop) -> None:
        from simconsole.bridge.ros2.node import Ros2Link

        here = threading.get_ident()

        def wake() -> None:
            """Have the graph pumped in the loop's next turn, from whatever thread."""
            if not self._ros2_woken:
                self._ros2_woken = True
                # From its own thread, as for each message of a client, the loop need not be roused through its socket.
                call = loop.call_soon if threading.get_ident() == here else loop.call_soon_threadsafe
                call(self._pump_ros2)

        self._ros2 = Ros2Link(self.console, self._profile, wake)

    def _pump_ros2(self) -> None:
        self._ros2_woken = False
        if self._ros2 is not None:
            self._ros2.pump(self.clock_ns())

    async def _check_periodically(self) -> None:
        """Check all clients, four times a second."""
        while True:
            await asyncio.sleep(_CHECK_S)
            self.check_clients()

    def check_clients(self) -> None:
        """Ping quiet clients; abort those that are gone and those that take nothing."""
        now_ns = self.clock_ns()
        self.console.router.calls.expire(now_ns)
        for client in list(self._clients):
            reason = self._abort_reason(client, now_ns)
            if reason is not None:
                _logger.warning("%s %s and is cut", client.session.peer, reason)
                client.connection.abort()

    def _abort_reason(self, client: ClientHandler, now_ns: int) -> str | None:
        since_ns, patience_s = client.stalled_since_ns, self._profile.stall_close_s
        if client.connection.is_open and since_ns is not None and now_ns - since_ns > patience_s * NS_PER_S:
            return f"took nothing for {patience_s:g} s"
        patience_s = self._profile.limits.tokenless_s
        if client.session.role is Role.NONE and now_ns - client.since_ns > patience_s * NS_PER_S:
            return f"has shown no token for {patience_s:g} s"
        return client.connection.check(now_ns)


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
    on_link_state: Callable[[str], None] = lambda state: None,
    registry: Registry | None = None,
    folder: Path | None = None,
    drive: str | None = None,
    around: Surroundings = NOWHERE,
    on_plan: OnPlan | None = None,
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
        on_counts: gets the counts, once a second and at the end.
        on_link_state: gets the link's state, within 0.1 s of a change and once a second.
        registry: message types; without, the standard ones and those of the profile's folder.
        folder: where topics are recorded if the profile says so.
        drive: the nonce of the drive whose bridge it is.
        around: what there is to tell of beside the state vector.
        on_plan: gets each plan of a controller, at once.

    Raises:
        BridgeError: the address cannot be listened on.
        ProfileError: as `ConsoleBridge`.
    """
    server = BridgeServer(
        profile,
        registry=registry,
        on_command=write_command,
        on_events=write_events,
        on_act=on_act,
        folder=folder,
        drive=drive,
        around=around,
        on_plan=on_plan,
    )
    reporter = _StatusReporter(server, on_counts, on_link_state)
    asyncio.run(_run(server, read_snapshot, stop, on_ready, reporter))


async def _run(
    server: BridgeServer,
    read_snapshot: Callable[[], Snapshot | None],
    stop: Callable[[], bool],
    on_ready: Callable[[int], None],
    reporter: "_StatusReporter",
) -> None:
    """Start; publish and report until told to stop; close."""
    await server.start()
    on_ready(server.port)
    try:
        while not stop():
            reporter.update(time.monotonic())
            snapshot = read_snapshot()
            if snapshot is not None:
                server.publish(snapshot)
            await asyncio.sleep(_POLL_S)
    finally:
        reporter.report_counts()
        await server.close()


class _StatusReporter:
    """Reports a running server's counts once a second, and with them and at each change the link's state."""

    def __init__(
        self, server: BridgeServer, on_counts: Callable[[dict[str, int]], None], on_link_state: Callable[[str], None]
    ) -> None:
        self._server = server
        self._on_counts = on_counts
        self._on_link_state = on_link_state
        self._next_count_s = self._next_state_s = 0.0
        self._reported = ""

    def update(self, now_s: float) -> None:
        """Report what is due at `now_s` of the monotonic clock."""
        if now_s >= self._next_count_s:
            self._next_count_s = now_s + _COUNT_S
            self.report_counts()
            self._reported = ""
        if now_s >= self._next_state_s or not self._reported:
            self._next_state_s = now_s + _LINK_STATE_S
            state = self._server.link_state()
            if state != self._reported:
                self._reported = state
                self._on_link_state(state)

    def report_counts(self) -> None:
        """Report the counts as they are now."""
        self._on_counts(self._server.console.counts())
