"""A plugin of pytest for the tests of cores: whoever makes a socket fails."""

import socket
from typing import Any, NoReturn


class _NoSocket(socket.socket):
    def __init__(self, *arguments: Any, **options: Any) -> NoReturn:
        raise AssertionError("the test of a core makes a socket")


socket.socket = _NoSocket  # type: ignore[misc, assignment]  # for the whole run, which is a process of its own
