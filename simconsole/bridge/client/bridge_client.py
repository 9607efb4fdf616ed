"""A rosbridge client for programs: one socket, no thread, no event loop, and everything there again after a restart.

Example:
    with BridgeClient("ws://127.0.0.1:9090") as client:
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.advertise("/cmd_vel", "geometry_msgs/Twist")
        client.connect()
        while True:
            received = client.receive(timeout_s=1.0)
            if received is not None:
                client.publish("/cmd_vel", {"linear": {"x": 1.0}})
"""

import logging
import random
import time
from collections import deque
from collections.abc import Callable
from types import TracebackType
from typing import Any, Final, Literal, Self

import msgspec

from simconsole.bridge.client.client_connection import ABNORMAL, ClientConnection
from simconsole.bridge.messages import Registry
from simconsole.bridge.protocol.backoff import CAP_S, DEAD_AFTER_S, FIRST_S, HUNG_AFTER_S, Backoff, Liveness
from simconsole.bridge.protocol.client_protocol import (
    Answer,
    Callback,
    ClientProtocol,
    Feedback,
    Goal,
    Handler,
    Received,
)
from simconsole.bridge.protocol.operations import Status
from simconsole.values.errors import BridgeError, OtherDriveError

State = Literal["connecting", "connected"]
GOOD_BYES: Final = (1000, 1001)
"""WebSocket close codes of a server that ends in order."""
_RETRY_S: Final = 0.05

_logger = logging.getLogger("simconsole.bridge.client.bridge_client")


class BridgeClient:
    """A client of a rosbridge server. Not safe to share between threads.

    What the program advertised, subscribed and provides is one table in `protocol`, repeated on each new connection.
    Callbacks and handlers run within `receive`.
    """

    def __init__(
        self,
        url: str,
        *,
        registry: Registry | None = None,
        token: str | None = None,
        certificate: str | None = None,
        drive: str | None = None,
        timeout_s: float = 2.0,
        comes_back: bool = True,
        until_good_bye: bool = False,
        on_state: Callable[[State], None] = lambda state: None,
        first_s: float = FIRST_S,
        cap_s: float = CAP_S,
        dead_after_s: float = DEAD_AFTER_S,
        answers_together: bool = False,
    ) -> None:
        """Remember where to connect.

        Args:
            url: ws://HOST:PORT or wss://HOST:PORT.
            registry: message types, the standard ones without.
            token: shown to the server at once.
            certificate: a PEM file that a wss:// server is checked against, in place of the system's authorities.
            drive: the nonce of the drive that has started this program, if one has; shown to the server, too.
            timeout_s: how long one attempt to connect may take.
            comes_back: connect again by itself, whenever `receive` or `publish` is called; without, the end of a
                connection is a BridgeError.
            until_good_bye: take a server that closes in order (a drive that has ended) for the end, not for a restart.
            on_state: called with each change of the connection's state.
            first_s: the first pause between two attempts.
            cap_s: the longest, without its scatter.
            dead_after_s: how long the server may be silent before it counts as gone; on Linux for HUNG_AFTER_S while
                its system acknowledges what it is sent. Infinite where whoever uses this client learns of its end in
                another way.
            answers_together: what is published while messages that came together are returned goes together, with the
                last of them or in the next `receive`: for who answers several topics of one sender.

        Raises:
            BridgeError: `url` is not such an address, or the certificate cannot be read.
        """
        self.protocol = ClientProtocol(registry)
        self._connection = ClientConnection(url, timeout_s, token, certificate, drive)
        self._comes_back = comes_back
        self._until_good_bye = until_good_bye
        self._on_state = on_state
        self._backoff = Backoff(first_s, cap_s)
        self._liveness = Liveness(dead_after_s=dead_after_s)
        self._hung_after_s = max(HUNG_AFTER_S, dead_after_s)
        self._chance = random.Random()
        self._next_attempt_s = 0.0
        self._received: deque[Received] = deque()
        self._answers_together = answers_together
        self._held: list[bytes] = []
        self.state: State = "connecting"
        self.connections = 0
        """How often the connection was made."""
        self.failure = ""
        """Why there is, or was last, no connection."""

    def __enter__(self) -> Self:
        """Return the client; it is closed at the end of the block."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the connection."""
        self.disconnect()

    @property
    def url(self) -> str:
        """Where this client connects."""
        return self._connection.url

    @property
    def connected(self) -> bool:
        """Whether the connection is open as far as this side knows."""
        return self._connection.is_open

    @property
    def registry(self) -> Registry:
        """The message types of this client: `client.registry.struct(name)` makes a typed message."""
        return self.protocol.registry

    @property
    def statuses(self) -> list[Status]:
        """The server's remarks (refusals with their reason), newest last."""
        return self.protocol.statuses

    def connect(self, patience_s: float = 0.0) -> None:
        """Open the connection now and repeat every registration; try again for `patience_s` where it fails.

        Raises:
            BridgeError: nobody listens there, the server refused, or it did not answer in time.
            OtherDriveError: the server belongs to another drive; it is not asked again.
        """
        self.disconnect()
        deadline_s = time.monotonic() + patience_s
        while True:
            try:
                return self._open()
            except BridgeError as error:
                self._lost(error)
                if isinstance(error, OtherDriveError) or time.monotonic() >= deadline_s:
                    raise
            time.sleep(_RETRY_S)

    def disconnect(self) -> None:
        """Close the connection; harmless when not connected."""
        self._connection.close()
        self._change("connecting")

    def advertise(self, topic: str, type_name: str, latch: bool = False) -> None:
        """Announce that this client publishes `topic`. Arguments and errors as `ClientProtocol.advertise`."""
        self._register(self.protocol.advertise(topic, type_name, latch))

    def unadvertise(self, topic: str) -> None:
        """Withdraw a publisher."""
        self._register(self.protocol.unadvertise(topic))

    def publish(self, topic: str, message: Any) -> bool:
        """Send one message, a dict or an instance of the topic's type; False when there is no connection.

        A message is never kept for later: an old command must not be sent when the server is back.

        Raises:
            LocalProtocolError: not advertised, or the message does not fit its type.
            BridgeError: there is no connection, and this client does not come back.
        """
        text = self.protocol.publish(topic, message)
        if not self._connect():
            return False
        if self._answers_together and self._received:
            self._held.append(text)
            return True
        return self._send(text)

    def subscribe(
        self,
        topic: str,
        type_name: str,
        callback: Callback | None = None,
        throttle_rate: int = 0,
        queue_length: int = 0,
        reads: type[msgspec.Struct] | None = None,
    ) -> None:
        """Ask for a topic; arguments as `ClientProtocol.subscribe`."""
        self._register(self.protocol.subscribe(topic, type_name, callback, throttle_rate, queue_length, reads))

    def unsubscribe(self, topic: str) -> None:
        """End a subscription."""
        self._register(self.protocol.unsubscribe(topic))

    def advertise_service(self, service: str, type_name: str, handler: Handler) -> None:
        """Answer the requests of a service; `handler` gets the arguments and returns the values."""
        self._register(self.protocol.advertise_service(service, type_name, handler))

    def unadvertise_service(self, service: str) -> None:
        """Answer no more."""
        self._register(self.protocol.unadvertise_service(service))

    def call_service(self, service: str, args: Any, on_answer: Answer) -> bool:
        """Ask a service; `on_answer` gets (values, result), also when the connection ends first. False: not sent."""
        return self._ask(lambda: self.protocol.call_service(service, args, on_answer))

    def advertise_action(self, action: str, type_name: str, pursue: Callable[[Goal], None]) -> None:
        """Take the goals of an action; `pursue` gets each and may keep it to send feedback and the result later."""
        self._register(self.protocol.advertise_action(action, type_name, pursue))

    def unadvertise_action(self, action: str) -> None:
        """Take no more goals."""
        self._register(self.protocol.unadvertise_action(action))

    def send_goal(
        self, action: str, type_name: str, args: Any, on_result: Answer, on_feedback: Feedback | None = None
    ) -> bool:
        """Send a goal; `on_result` gets (values, result), also when the connection ends first. False: not sent."""
        return self._ask(lambda: self.protocol.send_goal(action, type_name, args, on_result, on_feedback))

    def receive(self, timeout_s: float) -> Received | None:
        """Return the next message (topic, message) without a callback, or None after `timeout_s`.

        Callbacks of messages that come before it run inside this call.

        Raises:
            BridgeError: the connection has ended, and this client does not come back.
            OtherDriveError: another drive's server has taken its place.
        """
        deadline_s = time.monotonic() + timeout_s
        if self._held and not self._received:
            self._send()
        while not self._received:
            now_s = time.monotonic()
            left_s = max(0.0, deadline_s - now_s)
            if self._connect():
                self._read(min(left_s, self._liveness.patience_s(now_s)))
            else:
                time.sleep(min(left_s, max(0.0, self._next_attempt_s - time.monotonic())))
            if not self._received and time.monotonic() >= deadline_s:
                return None
        return self._received.popleft()

    def _open(self) -> None:
        self._received.clear()
        self._held.clear()
        self._connection.open()
        for text in self.protocol.registrations():
            self._connection.send(text)
        self.connections += 1
        self._backoff.reset()
        self._liveness.begin(time.monotonic())
        self._change("connected")

    def _connect(self) -> bool:
        """Return whether there is a connection, made now if it is time for an attempt."""
        if self._connection.is_open:
            return True
        if self.state == "connected":
            code = self._connection.close_code or ABNORMAL
            self._lost_or_raise(BridgeError(f"{self.url}: connection closed by the server ({code})"))
        if not self._comes_back:
            raise BridgeError(f"{self.url}: not connected")
        if time.monotonic() < self._next_attempt_s:
            return False
        try:
            self._open()
        except BridgeError as error:
            self._lost(error)
            if isinstance(error, OtherDriveError):
                raise
            return False
        return True

    def _register(self, text: bytes) -> None:
        """Send a registration now if connected; otherwise `connect` sends it."""
        if self._connection.is_open:
            self._send(text)

    def _ask(self, make: Callable[[], bytes]) -> bool:
        return self._connect() and self._send(make())

    def _send(self, *texts: bytes) -> bool:
        held, self._held = self._held, []
        try:
            self._connection.send(*held, *texts)
        except BridgeError as error:
            return self._lost_or_raise(error)
        return True

    def _read(self, timeout_s: float) -> None:
        self._liveness.listen(time.monotonic())
        try:
            messages = self._connection.read(timeout_s)
        except BridgeError as error:
            self._lost_or_raise(error)
            return
        self._liveness.look(time.monotonic())
        for text in messages or ():
            received = self.protocol.receive(text, time.monotonic_ns())
            if received is not None:
                self._received.append(received)
        if self._connection.is_open:
            self._answer(messages is None)

    def _is_gone(self, now_s: float) -> bool:
        """Return whether a silent server is gone, and does not wait for others as it does in lockstep.

        The machine of one that waits acknowledges; so does that of one that hangs, and what stands between, a tunnel
        say, for one that is gone.
        """
        if self._liveness.silence_s(now_s) >= self._hung_after_s:
            return True
        return self._liveness.is_dead(now_s) and self._connection.is_unacknowledged

    def _answer(self, is_silent: bool) -> None:
        """Send the replies to what was received, and check that the server is alive."""
        try:
            while self.protocol.replies:
                self._connection.send(self.protocol.replies.popleft())
            now_s = time.monotonic()
            self._liveness.heard(self._connection.heard_s)
            if is_silent and self._is_gone(now_s):
                raise BridgeError(f"{self.url}: the server has been silent for too long")
            if self._liveness.ping_due(now_s):
                self._connection.ping()
        except BridgeError as error:
            self._lost_or_raise(error)

    def _lost_or_raise(self, error: BridgeError) -> bool:
        """Note the end of a connection; return False, or raise where it is not to be made again."""
        self._lost(error)
        if self._until_good_bye and self._connection.close_code in GOOD_BYES:
            self._comes_back = False
        if not self._comes_back:
            raise error
        return False

    def _lost(self, error: BridgeError) -> None:
        self.failure = str(error)
        self._connection.abort()
        self._next_attempt_s = time.monotonic() + self._backoff.pause_s(self._chance.random())
        self._change("connecting")

    def _change(self, state: State) -> None:
        if state == self.state:
            return
        self.state = state
        if state == "connecting":
            self.protocol.end_calls()
        _logger.info("%s: %s %s", self.url, state, self.failure if state == "connecting" else "")
        self._on_state(state)
