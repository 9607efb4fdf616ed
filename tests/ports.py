"""Ports for servers of tests: no connection that goes out takes one, and no test beside gets the same."""

import itertools
import os
import socket
from typing import Final

_FIRST: Final = 10_000
_SHARE: Final = 5_000
"""Each of at most four processes that run tests beside each other has so many, all below those that the kernel takes
for connections that go out (from 32,768): one that began between the look and a server's start would have its port."""
_numbers: Final = itertools.count(37 * os.getpid())


def free_port() -> int:
    """Return a port of TCP that nobody listens on now; each call another one."""
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw")) % 4
    while True:
        port = _FIRST + _SHARE * worker + next(_numbers) % _SHARE
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
        return port
