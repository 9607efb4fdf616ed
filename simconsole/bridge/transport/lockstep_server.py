"""The bridge on the core's own sockets: a headless drive waits for its controller, once per control period.

No thread and no event loop: waking another would cost more than everything else together (measured: a third of the
round trips with the bridge in a thread). Between two calls nothing happens; the system's buffers hold what arrives.
"""

import logging
import selectors
import socket
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Final, Self

import msgspec

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.input_slots import Question
from simconsole.bridge.console.surroundings import NOWHERE, Surroundings
from simconsole.bridge.console.topics import ODOMETRY
from simconsole.bridge.messages import Registry
from simconsole.bridge.protocol.access import Access
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.handshake import Admission, Places, places
from simconsole.bridge.transport import sockets
from simconsole.bridge.transport.client_log import log_departure, log_outcome
from simconsole.bridge.transport.credentials import load_access, load_tls
from simconsole.bridge.transport.lockstep_connection import LockstepConnection
from simconsole.bridge.transport.message_files import load_registry
from simconsole.bridge.transport.sockets import RECEIVE_BYTES, address_url, listen
from simconsole.bridge.transport.topic_recorder import open_recorder
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError
from simconsole.values.signals import EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot

if TYPE_CHECKING:
    from simconsole.bridge.ros2.node import Ros2Link

_COMMANDS_PER_ODOMETRY: Final = 4.0
"""Commands a controller may send for each odometry, at least: the rate limit must never refuse an answer."""
_CLOSE_S: Final = 0.5
_CHECK_S: Final = 0.25
_logger = logging.getLogger("simconsole.bridge.transport.lockstep_server")


def in_lockstep(profile: BridgeProfile, odometry_hz: float) -> BridgeProfile:
    """Return the profile with another rate of /odom."""
    return msgspec.structs.replace(profile, rates_hz={**profile.rates_hz, ODOMETRY: odometry_hz})


def listeners(console: ConsoleBridge) -> int:
    """Return how many clients hear a platform's odometry: those that may answer it."""
    topic = console.router.topic(console.names[ODOMETRY])
    return 0 if topic is None else len(topic.subscribers)


def acts_of(console: ConsoleBridge) -> list[bytes]:
    """Return what operators have done with a platform since the last call, each as JSON."""
    return [msgspec.json.encode(act) for act in console.take_acts()]


class LockstepBridge:
    """A rosbridge server that lives inside the tick loop. Its clock is the simulated time of the last snapshot."""

    def __init__(
        self,
        profile: BridgeProfile,
        *,
        registry: Registry | None = None,
        odometry_hz: float | None = None,
        folder: Path | None = None,
        drive: str | None = None,
        around: Surroundings = NOWHERE,
        platforms: int = 1,
    ) -> None:
        """Listen on the profile's host and port.

        Args:
            profile: names, rates, limits.
            registry: message types; without, the standard ones and those of the profile's folder.
            folder: where topics are recorded if the profile says so.
            drive: the nonce of the drive whose bridge it is.
            around: what there is to tell of beside the state vector.
            odometry_hz: rate of /odom in place of the profile's: the control rate, so that every answer is waited for.
            platforms: how many one client may command.

        Raises:
            BridgeError: the address cannot be listened on.
            ProfileError: as `ConsoleBridge`, or its certificate or tokens cannot be used.
        """
        if odometry_hz is not None:
            commands_hz = max(profile.limits.commands_hz, _COMMANDS_PER_ODOMETRY * odometry_hz) * platforms
            limits = msgspec.structs.replace(profile.limits, commands_hz=commands_hz)
            profile = msgspec.structs.replace(in_lockstep(profile, odometry_hz), limits=limits)
        registry = load_registry(profile) if registry is None else registry
        self.console = ConsoleBridge(
            profile,
            registry,
            around=around,
        )
        self.console.router.access = load_access(profile)
        if profile.upstream is not None:
            raise ProfileError("outputs.bridge.upstream: a drive in lockstep waits for its own clients only")
        self.drive = drive
        self._tls = load_tls(profile)
        self._profile = profile
        self._now_ns = 0
        self._closing = False
        self._next_check_s = 0.0
        self._connections: dict[LockstepConnection, float] = {}
        """Each with when it was accepted, in s."""
        self._sending: dict[LockstepConnection, None] = {}
        """Those that have something to send, now or when its time comes, in the order in which it came."""
        self._listener = listen(profile.host, profile.port)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ, None)
        self._recorder = open_recorder(self.console, profile, folder)
        self._ros2: Ros2Link | None = None
        self._wake_sockets: tuple[socket.socket, ...] = ()
        if profile.ros2 is not None:
            self._join_ros2()

    def __enter__(self) -> Self:
        """Return the bridge; it is closed at the end of the block."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close everything."""
        self.close()

    @property
    def port(self) -> int:
        """The port listened on."""
        return int(self._listener.getsockname()[1])

    @property
    def url(self) -> str:
        """Where clients connect."""
        return address_url(self._profile.host, self.port, self._tls is not None)

    @property
    def clients(self) -> int:
        """How many clients are connected."""
        return len(self.console.router.sessions)

    def take_acts(self) -> list[bytes]:
        """Return what operators have done since the last call, each as JSON."""
        return acts_of(self.console)

    def wait_for_client(self, timeout_s: float, of: Sequence[ConsoleBridge] = ()) -> bool:
        """Serve until clients have subscribed to the odometry of the platforms `of`, that of the first without.

        False when they did not in time (wall time).
        """
        deadline = time.monotonic() + timeout_s
        while not all(listeners(console) for console in of or (self.console,)):
            left_s = deadline - time.monotonic()
            if left_s <= 0.0:
                return False
            self._serve(left_s)
        return True

    def publish(self, snapshot: Snapshot, of: ConsoleBridge | None = None) -> None:
        """Send what is due of a snapshot and serve what has arrived, without waiting; `of` as of `exchange`."""
        console = of or self.console
        self._now_ns = snapshot.t_ns
        console.inputs.tick = snapshot.tick
        self._serve(0.0)
        self._record()
        console.publish(snapshot, self._now_ns)
        self._pump_ros2()
        self._flush()

    def stand(self, timeout_s: float) -> None:
        """Serve what arrives within `timeout_s`, while simulated time stands; nothing new is published."""
        self._serve(timeout_s)
        self._pump_ros2()
        self._flush()

    def ask(self, snapshot: Snapshot, of: ConsoleBridge | None = None) -> Question:
        """Publish a snapshot, odometry in any case; return what answers it, for `hear`, which sends what waits.

        So a client that commands several platforms gets all of theirs at once. `of` as of `exchange`.
        """
        console = of or self.console
        self._now_ns = snapshot.t_ns
        console.inputs.tick = snapshot.tick
        self._record()
        sequence = console.inputs.command.sequence
        question = Question(console.inputs, sequence, console.publish(snapshot, self._now_ns, odometry=True))
        self._pump_ros2()
        return question

    def hear(
        self, asked: Sequence[Question], timeout_s: float = 2.0, stop: Callable[[], bool] = lambda: False
    ) -> list[bool]:
        """Wait for the answers to questions, in whatever order they come; return of each whether it has one.

        None is waited for longer than `timeout_s` of wall time or until `stop`, nor of a commander who is gone while no
        other has spoken.
        """
        self._flush()
        deadline = time.monotonic() + timeout_s
        awaited = [question for question in asked if not question.is_settled]
        if not awaited:
            self._serve(0.0)
        while awaited and (left_s := deadline - time.monotonic()) > 0.0 and not stop() and self.clients:
            self._serve(min(left_s, _CHECK_S))
            awaited = [question for question in awaited if not question.is_settled]
        return [question.is_answered for question in asked]

    def exchange(
        self,
        snapshot: Snapshot,
        timeout_s: float = 2.0,
        stop: Callable[[], bool] = lambda: False,
        of: ConsoleBridge | None = None,
    ) -> bool:
        """Send a snapshot, odometry in any case, and wait for the command that answers it.

        That is the first accepted command whose stamp equals the odometry's; a command of a type without a stamp
        answers by arriving. Whatever arrives before it is applied too. Over a link with errors the odometry may be an
        earlier one; one that is lost is not waited for. `of` is the platform whose snapshot it is, unless it is that of
        the first.

        Returns:
            False when no answer came within `timeout_s` of wall time or until `stop`, or the commander is gone and no
            other has spoken.
        """
        return self.hear((self.ask(snapshot, of),), timeout_s, stop)[0]

    def counts(self) -> dict[str, int]:
        """Return how many messages went to and from all clients."""
        return self.console.counts()

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command with its age for the coming `tick`, and all edges since the last call."""
        return self.console.inputs.take(tick)

    def close(self) -> None:
        """Close all clients, give them half a second to answer, stop listening; harmless when closed."""
        if self._listener.fileno() < 0:
            return
        self._closing = True
        if self._ros2 is not None:
            self._ros2.close()
            self._ros2 = None
        deadline = time.monotonic() + _CLOSE_S
        for connection in list(self._connections):
            connection.start_closing()
            if connection.closed:
                self._remove(connection)
        while self._connections and (left_s := deadline - time.monotonic()) > 0.0:
            self._serve(left_s)
        for connection in list(self._connections):
            connection.close()
            self._remove(connection)
        self._selector.close()
        self._listener.close()
        if self._recorder is not None:
            self._recorder.close()
        for end in self._wake_sockets:
            end.close()

    @property
    def access(self) -> Access:
        """Roles by token (`ConnectionOwner`)."""
        return self.console.router.access

    @property
    def places(self) -> Places:
        """What room there is (`ConnectionOwner`)."""
        sessions = [connection.session for connection in self._connections]
        return places((session for session in sessions if session is not None), self._profile.limits)

    def connected(self, peer: str, admission: Admission, wake: Callable[[], None]) -> ClientSession:
        """Add a client (`ConnectionOwner`)."""
        _logger.info("%s connected", peer)
        session = self.console.router.connect(peer, wake, dialect=admission.dialect, role=admission.role)
        session.has_token = admission.has_token
        return session

    def has_something(self, connection: LockstepConnection) -> None:
        """Note that there is something to send on a connection (`ConnectionOwner`)."""
        self._sending[connection] = None

    def received(self, session: ClientSession, text: bytes) -> None:
        """Apply a text of a client (`ConnectionOwner`)."""
        log_outcome(_logger, session, self.console.receive(session, text, self._now_ns))

    def _serve(self, timeout_s: float) -> None:
        """Wait at most `timeout_s` for sockets and serve each that is ready once."""
        for key, mask in self._selector.select(timeout_s):
            if key.data is None:
                self._accept()
                continue
            if isinstance(key.data, socket.socket):
                self._pump_ros2(key.data)
                continue
            connection: LockstepConnection = key.data
            has_something = mask & selectors.EVENT_READ and connection.read()
            if has_something or mask & selectors.EVENT_WRITE:
                self._send_waiting(connection)
        for connection in list(self._sending):  # a message that one client published may wait for another client
            self._send_waiting(connection)

    def _record(self) -> None:
        if self._recorder is not None:
            self._recorder.update(self._now_ns)

    def _join_ros2(self) -> None:
        from simconsole.bridge.ros2.node import Ros2Link

        # rclpy's thread writes a byte, so that a wait for sockets ends for the graph too; one unread byte is enough.
        receiver, sender = socket.socketpair()
        receiver.setblocking(False)
        sender.setblocking(False)

        def wake() -> None:
            """End the wait for sockets, from whatever thread."""
            with suppress(OSError):
                sender.send(b"!")

        self._selector.register(receiver, selectors.EVENT_READ, receiver)
        self._wake_sockets = (receiver, sender)
        self._ros2 = Ros2Link(self.console, self._profile, wake)

    def _pump_ros2(self, receiver: socket.socket | None = None) -> None:
        if receiver is not None:
            receiver.recv(RECEIVE_BYTES)
        if self._ros2 is not None:
            self._ros2.check()
            self._ros2.pump(self._now_ns)

    def _accept(self) -> None:
        try:
            sock, address = self._listener.accept()
        except OSError:
            return  # the client was gone before it was accepted
        if self._tls is not None:
            # Its handshake happens with the first bytes read; it must not make the tick loop wait.
            sock.setblocking(False)
            sock = self._tls.wrap_socket(sock, server_side=True, do_handshake_on_connect=False)
        now_s = time.monotonic()
        self._close_stale(now_s)
        limits = self._profile.limits
        if len(self._connections) >= limits.clients + limits.tokenless_clients:
            sock.close()
            return
        connection = LockstepConnection(self, sock, f"{address[0]}:{address[1]}", self._profile)
        self._connections[connection] = now_s
        connection.selected = selectors.EVENT_READ
        self._selector.register(sock, connection.selected, connection)

    def _close_stale(self, now_s: float) -> None:
        """Close connections that have not become, or no longer are, WebSockets after a while (N12)."""
        for connection, since_s in list(self._connections.items()):
            if not connection.is_open and now_s - since_s > sockets.HANDSHAKE_S:
                connection.close()
                self._remove(connection)

    def _flush(self) -> None:
        now_s = time.monotonic()
        checking = now_s >= self._next_check_s
        if checking:
            self._next_check_s = now_s + _CHECK_S
            for connection in list(self._connections):
                connection.check()
                self._send_waiting(connection)
        for connection in list(self._sending):
            self._send_waiting(connection)

    def _remove(self, connection: LockstepConnection) -> None:
        self._sending.pop(connection, None)
        if self._connections.pop(connection, None) is None:
            return
        self._selector.unregister(connection.socket)
        session, connection.session = connection.session, None
        if session is not None:
            commanded = self.console.disconnect(session, self._now_ns)
            log_departure(_logger, connection.peer, commanded and not self._closing)

    def _send_waiting(self, connection: LockstepConnection) -> None:
        """Send what waits for a client and ask to be woken for writing only while the system takes no more."""
        connection.flush(self._now_ns)
        if connection.closed:
            self._remove(connection)
            return
        wanted = selectors.EVENT_READ | (selectors.EVENT_WRITE if connection.waits_to_write else 0)
        if connection.selected != wanted:
            connection.selected = wanted
            self._selector.modify(connection.socket, wanted, connection)
        if not connection.waits_to_send:
            self._sending.pop(connection, None)
