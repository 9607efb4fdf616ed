"""Ports for servers of tests: no connection that goes out takes one, and no test beside gets the same."""

import itertools
import os
import socket
from typing import Final

_FIRST: Final = 10_000
_SHARES: Final = 16
_SHARE: Final = 1_400
"""Each of the processes that run tests beside each other has so many, all below those that the kernel takes for
connections that go out (from 32,768): one that began between the look and a server's start would have its port. There
are more shares than processes because one that takes the place of another has a new number."""
_numbers: Final = itertools.count(37 * os.getpid())


def free_port() -> int:
    """Return a port of TCP that nobody listens on now; each call another one."""
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw")) % _SHARES
    while True:
        port = _FIRST + _SHARE * worker + next(_numbers) % _SHARE
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
        return port
