"""The console as a client of another rosbridge server: what it sends there, and which answers it accepts.

To the router the other server is a client like any other, which hears every output and may command; rosbridge's
publish is the same operation both ways. It is trusted with commands and nothing else: no call, no subscription.
"""

from collections.abc import Callable

import orjson

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.messages.definition_text import two_parts
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.message_decoding import decode
from simconsole.bridge.protocol.operations import Publish, Status, read_operation
from simconsole.bridge.protocol.server_protocol import Outcome
from simconsole.profiles.bridge import UpstreamProfile
from simconsole.values.errors import BridgeError


class Upstream:
    """One console's link to another server. It has a session while it is connected."""

    def __init__(self, console: ConsoleBridge, profile: UpstreamProfile, wake: Callable[[], None]) -> None:
        """Join `console`; `wake` is called when there may be something to send."""
        self._console = console
        self._profile = profile
        self._wake = wake
        self.session: ClientSession | None = None

    def connected(self, now_ns: int) -> list[bytes]:
        """Begin a new connection; return the texts that advertise and subscribe the console's topics."""
        router = self._console.router
        session = self.session = router.connect(
            f"upstream {self._profile.url}", self._wake, self._profile.dialect, Role.CONTROL
        )
        session.set_level("none")  # rosbridge_suite does not know the operation
        registrations = []
        for name, topic in router.topics.items():
            if not topic.owned:
                continue
            fields = {"topic": name, "type": two_parts(topic.type)}
            if topic.command is None:
                registrations.append(orjson.dumps({"op": "advertise", **fields, "latch": topic.latch}))
                router.receive(session, orjson.dumps({"op": "subscribe", "topic": name}), now_ns)
            else:
                registrations.append(orjson.dumps({"op": "subscribe", **fields, "queue_length": 1}))
        return registrations

    def receive(self, text: bytes, now_ns: int) -> Outcome:
        """Apply a message of the other server if it is a command; ignore any other, and return what became of it."""
        assert self.session is not None
        try:
            operation = read_operation(decode(text).fields)
        except BridgeError as error:
            return Outcome("refused", "", str(error))
        if isinstance(operation, Status):
            return Outcome("remark", "", f"{operation.level}: {operation.msg[:1000]}")
        if not isinstance(operation, Publish):
            return Outcome("done", "", "")
        topic = self._console.router.topic(operation.topic)
        if topic is None or topic.command is None:
            return Outcome("done", operation.topic, "")
        return self._console.receive(self.session, text, now_ns)

    def lost(self, now_ns: int) -> bool:
        """Note the end of a connection; return whether it was commanding. Harmless without one."""
        session, self.session = self.session, None
        return session is not None and self._console.disconnect(session, now_ns)
