"""The console as a client of another rosbridge server: what it sends there, and which answers it accepts.

To the router the other server is a client like any other, which hears every output and may command; rosbridge's
publish is the same operation both ways. It is trusted with commands and nothing else: no call, no subscription. Types
that it may lack are published once it has said that it has them: rosbridge_suite complains of each message else.
"""

from collections.abc import Callable
from typing import Final

import orjson

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.messages.definition_text import two_parts
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.message_decoding import decode
from simconsole.bridge.protocol.operations import Publish, ServiceResponse, Status, read_operation
from simconsole.bridge.protocol.server_protocol import Outcome
from simconsole.bridge.protocol.topic_registry import Topic
from simconsole.profiles.bridge import UpstreamProfile
from simconsole.values.errors import BridgeError

STANDARD: Final = frozenset(
    {"diagnostic_msgs", "geometry_msgs", "nav_msgs", "rosgraph_msgs", "sensor_msgs", "std_msgs", "tf2_msgs"}
)
"""Packages of every ROS; of others the server is asked before anything is published, for it may lack them."""
_DETAILS: Final = "/rosapi/message_details"


class Upstream:
    """One console's link to another server. It has a session while it is connected."""

    def __init__(self, console: ConsoleBridge, profile: UpstreamProfile, wake: Callable[[], None]) -> None:
        """Join `console`; `wake` is called when there may be something to send."""
        self._console = console
        self._profile = profile
        self._wake = wake
        self.session: ClientSession | None = None
        self._offered: set[str] = set()
        self._asked: set[str] = set()
        """Types that the server has not yet said whether it has them."""
        self._lacking: set[str] = set()
        self._can_be_asked = False
        self._said = ""

    def connected(self, now_ns: int) -> list[bytes]:
        """Begin a new connection; return the texts that advertise and subscribe the console's topics."""
        router = self._console.router
        session = self.session = router.connect(
            f"upstream {self._profile.url}", self._wake, self._profile.dialect, Role.CONTROL
        )
        session.set_level("none")  # rosbridge_suite does not know the operation
        self._offered, self._lacking, self._can_be_asked = set(), set(), False
        self._asked = {topic.type for topic in self._outputs().values()}
        texts = []
        for kind in sorted(self._asked):
            args = {"type": two_parts(kind)}
            texts.append(orjson.dumps({"op": "call_service", "service": _DETAILS, "id": kind, "args": args}))
            if kind.partition("/")[0] in STANDARD:
                texts += self._offer(kind, now_ns)
        for name, topic in router.topics.items():
            if topic.command is not None:
                fields = {"topic": name, "type": two_parts(topic.type), "queue_length": 1}
                texts.append(orjson.dumps({"op": "subscribe", **fields}))
        return texts

    def _outputs(self) -> dict[str, Topic]:
        topics = self._console.router.topics.items()
        return {name: topic for name, topic in topics if topic.owned and topic.command is None}

    def _offer(self, kind: str, now_ns: int) -> list[bytes]:
        """Begin to publish the outputs of a type; return the texts that advertise them."""
        assert self.session is not None
        texts = []
        for name, topic in self._outputs().items():
            if topic.type == kind:
                fields = {"topic": name, "type": two_parts(kind), "latch": topic.latch}
                texts.append(orjson.dumps({"op": "advertise", **fields}))
                self._console.router.receive(self.session, orjson.dumps({"op": "subscribe", "topic": name}), now_ns)
        self._offered.add(kind)
        return texts

    def _withdraw(self, kind: str, now_ns: int) -> None:
        assert self.session is not None
        for name, topic in self._outputs().items():
            if topic.type == kind:
                self._console.router.receive(self.session, orjson.dumps({"op": "unsubscribe", "topic": name}), now_ns)
        self._offered.discard(kind)

    def _learn(self, answer: ServiceResponse, now_ns: int) -> Outcome:
        """Take the server's answer whether it has a type; one that knows no type at all has no rosapi."""
        assert self.session is not None
        kind = str(answer.id)
        self._asked.discard(kind)
        if answer.result and isinstance(answer.values, dict) and answer.values.get("typedefs"):
            self._can_be_asked = True
            if kind not in self._offered:
                for text in self._offer(kind, now_ns):
                    self.session.answer(text)
        else:
            self._lacking.add(kind)
        if self._asked:
            return Outcome("done", "", "")
        if self._can_be_asked:
            for lacking in self._lacking & self._offered:
                self._withdraw(lacking, now_ns)
        withheld = [
            f"{name} ({topic.type})" for name, topic in self._outputs().items() if topic.type not in self._offered
        ]
        why = "it has no such types" if self._can_be_asked else "it has no rosapi to ask whether it has their types"
        said = f"not published there, because {why}: {', '.join(withheld)}" if withheld else ""
        if said == self._said:
            return Outcome("done", "", "")
        self._said = said
        return Outcome("remark", "", said)

    def receive(self, text: bytes, now_ns: int) -> Outcome:
        """Apply a message of the other server if it is a command; ignore any other, and return what became of it."""
        assert self.session is not None
        try:
            operation = read_operation(decode(text).fields)
        except BridgeError as error:
            return Outcome("refused", "", str(error))
        if isinstance(operation, Status):
            return Outcome("remark", "", f"{operation.level}: {operation.msg[:1000]}")
        if isinstance(operation, ServiceResponse) and operation.id in self._asked:
            return self._learn(operation, now_ns)
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
