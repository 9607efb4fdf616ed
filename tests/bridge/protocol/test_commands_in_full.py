"""A command that is just what its message encodes to is read at once, and treated as one in any other form."""

from typing import Any

import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.server_protocol import Outcome, Router
from simconsole.profiles.bridge import BridgeLimits
from simconsole.values.errors import RemoteProtocolError


class Commanded:
    """A router with one command topic that takes numbers up to 10, and one request open to everyone."""

    def __init__(self) -> None:
        self.refused = 0
        self.plain: dict[str, Any] | None = {}
        self.taken: list[float] = []
        self.router = Router(standard_registry(), BridgeLimits(), 500_000_000, self.count)
        self.router.add_command("/cmd", "std_msgs/Float64", self.accept)
        self.router.add_command("/ask", "std_msgs/Float64", self.accept, leased=False)

    def count(self) -> None:
        self.refused += 1

    def accept(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        if message.data > 10.0:
            raise RemoteProtocolError("too much - at `$.data`")
        self.plain = plain
        self.taken.append(message.data)

    def send(self, session: Any, data: str, topic: str = "/cmd") -> Outcome:
        text = f'{{"op":"publish","topic":"{topic}","msg":{{"data":{data}}}}}'
        return self.router.receive(session, text.encode(), 0)


@pytest.mark.parametrize("space", ["", " "])
def test_both_forms_are_treated_alike(space: str) -> None:
    """With a space it is not what its message encodes to."""
    console = Commanded()
    first, second = console.router.connect("1"), console.router.connect("2")
    assert console.send(first, f"{space}2.5") == ("command", "/cmd", "")
    assert console.plain == (None if space == "" else {"data": 2.5})
    assert console.send(first, f"{space}11.0") == ("refused", "/cmd", "too much - at `$.data`")
    assert console.refused == 1
    assert console.send(second, f"{space}1.0") == ("refused", "/cmd", "another client commands the console")
    assert console.send(second, f"{space}1.0", "/ask").kind == "command"
    second.role = Role.PUBLISH
    assert "needs the role control" in console.send(second, f"{space}1.0", "/ask").text
    burst = [console.send(first, f"{space}1.0").kind for _ in range(round(BridgeLimits().commands_hz or 0.0) + 1)]
    assert (burst[0], burst[-1]) == ("command", "throttled")


@pytest.mark.parametrize("data", ['1.0,"data":1.0', "NaN", "1e999", '"1.0"', "[1.0]", "null", ""])
def test_what_is_no_command_is_refused(data: str) -> None:
    console = Commanded()
    assert console.send(console.router.connect("1"), data).kind == "refused"
    assert console.taken == []
