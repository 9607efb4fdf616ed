"""A CAN bus over UDP multicast that stays on this machine and does not hear itself.

It sends from a socket of its own, so that its frames are known by their source port: the kernel drops them before
any process wakes up (Linux), or they are dropped here unread. On the wire it is python-can's `udp_multicast`, whose
messages it packs and unpacks with functions that the caller gives.
"""

import contextlib
import ctypes
import select
import socket
import struct
import sys
import time
from collections.abc import Callable
from typing import Any, Final

_LOOPBACK: Final = "127.0.0.1"
_IP_MULTICAST_ALL: Final = 49  # linux/in.h
_SO_ATTACH_FILTER: Final = 26  # asm-generic/socket.h
_MAX_BYTES: Final = 4096

_Pack = Callable[[Any], bytes]
_Unpack = Callable[[bytes, float], Any]


class LoopbackBus:
    """One open bus, in the form of a `can.BusABC` as far as the port uses it."""

    def __init__(self, group: str, port: int, pack: _Pack, unpack: _Unpack) -> None:
        """Join the group on the loopback interface only; frames neither leave this machine nor come from another.

        Args:
            group: IPv4 multicast address.
            port: UDP port.
            pack: a message as bytes.
            unpack: bytes and the time in s as a message; anything it raises means that these were none.

        Raises:
            OSError: no such group, or the network refuses.
        """
        self._address = (group, port)
        self._pack = pack
        self._unpack = unpack
        self._out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._in = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._open()
        except BaseException:
            self.shutdown()
            raise

    def send(self, message: Any, timeout: float | None = None) -> None:
        """Send a message; a full queue raises OSError like any other fault. `timeout` is python-can's: never waits."""
        self._out.send(self._pack(message))

    def recv(self, timeout: float | None = None) -> Any | None:
        """Return the next message of another sender, None when none came within `timeout` s."""
        deadline_s = None if timeout is None else time.monotonic() + timeout
        while True:
            wait_s = None if deadline_s is None else max(0.0, deadline_s - time.monotonic())
            if not select.select([self._in], [], [], wait_s)[0]:
                return None
            data, sender = self._in.recvfrom(_MAX_BYTES)
            if sender[1] == self._own_port:
                continue
            with contextlib.suppress(Exception):  # anything else that is sent to this port is ignored
                return self._unpack(data, time.time())

    def fileno(self) -> int:
        """Return the receiving socket's descriptor."""
        return self._in.fileno()

    def shutdown(self) -> None:
        """Close both sockets; twice is harmless."""
        self._in.close()
        self._out.close()

    def _open(self) -> None:
        group, port = self._address
        loopback = socket.inet_aton(_LOOPBACK)
        self._out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self._out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, loopback)
        self._out.bind((_LOOPBACK, 0))
        self._out.connect(self._address)  # one route lookup for all frames
        self._out.setblocking(False)
        self._own_port = self._out.getsockname()[1]
        self._in.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if hasattr(socket, "SO_REUSEPORT"):
            self._in.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        drop_from(self._in, self._own_port)
        if sys.platform == "linux":  # other systems deliver only groups that this socket has joined
            self._in.setsockopt(socket.IPPROTO_IP, _IP_MULTICAST_ALL, 0)
        self._in.bind(("", port))
        self._in.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + loopback)
        self._in.setblocking(False)


def drop_from(receiver: socket.socket, port: int) -> bool:
    """Let the kernel drop UDP datagrams from this source port; return whether it will (only Linux does).

    A classic BPF program of four instructions: the source port is the first word of the UDP header.
    """
    program = ((0x28, 0, 0, 0), (0x15, 0, 1, port), (0x06, 0, 0, 0), (0x06, 0, 0, _MAX_BYTES))
    if sys.platform != "linux":
        return False
    code = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *step) for step in program))
    try:
        receiver.setsockopt(
            socket.SOL_SOCKET, _SO_ATTACH_FILTER, struct.pack("HP", len(program), ctypes.addressof(code))
        )
    except OSError:
        return False
    return True
