"""Bad networks and bad clients, without privileges: the kernel drops what arrives at one of our own sockets."""

import ctypes
import json
import math
import os
import socket
import struct
import threading
from collections import deque
from pathlib import Path
from typing import Any, Self

from tests.patience import PATIENCE_S, pause, stamp_ns

_SO_ATTACH_FILTER = 26
_LOAD_RANDOM = (0x20, 0, 0, 0xFFFFF038)  # ld [SKF_AD_OFF + SKF_AD_RANDOM]
_DROP = (0x06, 0, 0, 0)
_TAKE = (0x06, 0, 0, 0xFFFFFFFF)


def _attach(sock: socket.socket, program: list[tuple[int, int, int, int]]) -> None:
    """Give a socket a classic BPF program that says of each packet how much of it is kept (Linux: filter.txt)."""
    code = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *step) for step in program))
    sock.setsockopt(socket.SOL_SOCKET, _SO_ATTACH_FILTER, struct.pack("@HP", len(program), ctypes.addressof(code)))


def go_deaf(sock: socket.socket) -> None:
    """Let nothing more arrive at a socket, not even what its kernel would acknowledge: the far half of half-open."""
    _attach(sock, [_DROP])


def lose(sock: socket.socket, share: float) -> None:
    """Let a random share of the packets to a socket be lost."""
    _attach(sock, [_LOAD_RANDOM, (0x35, 0, 1, int(share * 0xFFFFFFFF)), _TAKE, _DROP])


def far_end(sock: socket.socket) -> socket.socket:
    """The other side's socket of a connection within this process, as another handle on it."""
    for path in Path("/proc/self/fd").iterdir():
        try:
            other = socket.socket(fileno=os.dup(int(path.name)))
        except OSError:  # no socket, or closed meanwhile
            continue
        try:
            if other.getpeername() == sock.getsockname():
                return other
        except OSError:  # not connected
            pass
        other.close()
    raise LookupError("the other side is not in this process")


class Chaos:
    """A wire that takes its time: everything is passed on after a delay, and not faster than a rate.

    It listens on every address of its machine, and carries one connection to a port of `host`.
    """

    def __init__(
        self, port: int, delay_s: float, bytes_per_s: float = math.inf, *, host: str = "127.0.0.1", at: str = ""
    ) -> None:
        self._delay_s, self._bytes_per_s = delay_s, bytes_per_s
        self._listener = socket.create_server((at, 0))
        self.port = int(self._listener.getsockname()[1])
        self._target = (host, port)
        self._ends: tuple[socket.socket, ...] = ()
        self._threads = [threading.Thread(target=self._accept)]
        self._threads[0].start()

    def _accept(self) -> None:
        while not self._ends:
            try:
                near, _ = self._listener.accept()
            except OSError:  # it is over
                return
            try:
                self._ends = (near, socket.create_connection(self._target))
            except OSError:  # nobody there yet: whoever wants to go there comes again
                near.close()
        for source, sink in (self._ends, self._ends[::-1]):
            waiting: deque[tuple[float, bytes]] = deque()
            arrived = threading.Semaphore(0)
            for work in (self._take, self._pass_on):
                thread = threading.Thread(target=work, args=(source, sink, waiting, arrived))
                self._threads.append(thread)
                thread.start()

    def _take(self, source: socket.socket, sink: socket.socket, waiting: Any, arrived: threading.Semaphore) -> None:
        data = b"x"
        while data:
            try:
                data = source.recv(1500)
            except OSError:
                data = b""
            waiting.append((stamp_ns() / 1e9 + self._delay_s, data))
            arrived.release()

    def _pass_on(self, source: socket.socket, sink: socket.socket, waiting: Any, arrived: threading.Semaphore) -> None:
        while True:
            arrived.acquire()
            due_s, data = waiting.popleft()
            pause(max(0.0, due_s - stamp_ns() / 1e9) + len(data) / self._bytes_per_s)
            if not data:
                sink.close()
                return
            try:
                sink.sendall(data)
            except OSError:
                return

    def stop(self) -> None:
        self._listener.shutdown(socket.SHUT_RDWR)  # which wakes who waits there
        self._listener.close()
        for thread in self._threads:
            thread.join(timeout=PATIENCE_S)
            assert not thread.is_alive()
        for end in self._ends:
            end.close()


TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


class Raw:
    """A WebSocket client that can do everything wrong: it writes frames as it is told to."""

    def __init__(self, port: int, *, receive_bytes: int | None = None, headers: str = "") -> None:
        """Connect and finish the handshake."""
        self.sock = socket.socket()
        if receive_bytes is not None:
            self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_bytes)
        self.sock.settimeout(PATIENCE_S)
        self.sock.connect(("127.0.0.1", port))
        self._buffer = b""
        self.sock.sendall(handshake(port, headers))
        while b"\r\n\r\n" not in self._buffer:
            self._buffer += self.sock.recv(4096)
        self.response, _, self._buffer = self._buffer.partition(b"\r\n\r\n")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.sock.close()

    def send(self, opcode: int, data: bytes = b"", *, fin: bool = True, masked: bool = True, rsv: int = 0) -> None:
        self.sock.sendall(frame(opcode, data, fin=fin, masked=masked, rsv=rsv))

    def say(self, **operation: Any) -> None:
        """Send one rosbridge operation."""
        self.send(TEXT, json.dumps(operation).encode())

    def receive(self) -> tuple[int, bytes] | None:
        """The next frame as (opcode, data), None at the end of the connection, orderly or not."""
        head = self._take(2)
        if head is None:
            return None
        length = head[1] & 0x7F
        if length > 125:
            more = self._take(2 if length == 126 else 8)
            if more is None:
                return None
            length = int.from_bytes(more)
        data = self._take(length)
        return None if data is None else (head[0] & 0x0F, data)

    def close_code(self) -> int | None:
        """The code with which the server closes, None if it just goes; what it says before is passed over."""
        while (received := self.receive()) is not None:
            if received[0] == CLOSE:
                return int.from_bytes(received[1][:2])
        return None

    def vanish(self) -> None:
        """Reset the connection."""
        self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.sock.close()

    def _take(self, count: int) -> bytes | None:
        while len(self._buffer) < count:
            try:
                data = self.sock.recv(65536)
            except ConnectionError:
                return None
            if not data:
                return None
            self._buffer += data
        taken, self._buffer = self._buffer[:count], self._buffer[count:]
        return taken


def handshake(port: int, headers: str = "") -> bytes:
    """The request that opens a WebSocket; `headers` come before its own and may replace Host."""
    host = "" if "Host:" in headers else f"Host: localhost:{port}\r\n"
    return (
        f"GET / HTTP/1.1\r\n{headers}{host}Upgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n"
    ).encode()


def frame(opcode: int, data: bytes = b"", *, fin: bool = True, masked: bool = True, rsv: int = 0) -> bytes:
    """One frame; its mask is zero, so that the data stands in it as it is."""
    head = bytes([(0x80 if fin else 0) | rsv << 4 | opcode])
    mask = 0x80 if masked else 0
    if len(data) < 126:
        head += bytes([mask | len(data)])
    elif len(data) < 65536:
        head += bytes([mask | 126]) + len(data).to_bytes(2)
    else:
        head += bytes([mask | 127]) + len(data).to_bytes(8)
    return head + (bytes(4) if masked else b"") + data
