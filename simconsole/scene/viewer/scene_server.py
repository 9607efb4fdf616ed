"""A running drive's scene for viewers, native and in the browser: rerun's own server, fed with the scene's file.

The file is the history: whoever joins late is served what was written before. The server is a process of rerun that
reads its standard input, so that a viewer who does not read holds up this server at most, never the drive: that only
ever appends to the file. Its memory is bounded; what no longer fits is forgotten, the oldest first.
"""

import contextlib
import os
import select
import socket
import subprocess
import sys
import time
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Final, NamedTuple
from urllib.parse import quote

from simconsole.processes.lifetimes import end_with_parent_thread
from simconsole.values.errors import WorkerError

HOST: Final = "127.0.0.1"
"""rerun's servers know neither token nor TLS: they are for this machine only."""
MEMORY: Final = "1GiB"
START_S: Final = 20.0
LOOK_S: Final = 0.05
NICE: Final = 10
BATCH_BYTES: Final = 1 << 20


class Addresses(NamedTuple):
    """Where viewers find a scene."""

    native: str
    """For `rerun --connect`."""
    browser: str


class Ports(NamedTuple):
    """Ports of this machine; 0: any that is free."""

    grpc: int = 0
    web: int = 0


ANY_PORTS: Final = Ports()


def rerun_program() -> Path:
    """Return rerun's command-line tool.

    Raises:
        WorkerError: it is not installed.
    """
    found = find_spec("rerun_cli")
    if found is None or found.origin is None:
        raise WorkerError("rerun_cli: not installed; it comes with rerun-sdk")
    return Path(found.origin).with_name("rerun.exe" if sys.platform == "win32" else "rerun")


def quiet_environment() -> Mapping[str, str]:
    """Return an environment in which rerun's tool neither counts its users nor reports its every step."""
    return {"RUST_LOG": "error", **os.environ, "CI": "1"}


class SceneServer:
    """rerun's server and what feeds it. `pump` is called again and again; `close` ends the server."""

    def __init__(self, path: Path, ports: Ports = ANY_PORTS, memory: str = MEMORY) -> None:
        """Start the server and wait until it listens.

        Args:
            path: the scene's file; it may still have to come.
            ports: where to listen.
            memory: what the server keeps for viewers who join late, as rerun takes it: `1GiB`, `25%`.

        Raises:
            WorkerError: it does not start, or does not listen in time.
        """
        self._path = path
        grpc, web = (port or _free_port() for port in ports)
        command = [
            str(rerun_program()), "--serve-web", "--bind", HOST, "--port", str(grpc), "--web-viewer-port", str(web),
            "--server-memory-limit", memory, "-",
        ]  # fmt: skip
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                env=quiet_environment(),
                preexec_fn=_as_spectator if sys.platform == "linux" else None,
                process_group=0,
            )
        except OSError as problem:
            raise WorkerError(f"{command[0]}: cannot be started: {problem.strerror}") from None
        assert self._process.stdin is not None
        self._feed = self._process.stdin.fileno()
        if sys.platform != "win32":  # there a server that reads nothing holds its feeder up, and nobody else
            os.set_blocking(self._feed, False)
        self._at, self._rest = 0, b""
        url = f"rerun+http://{HOST}:{grpc}/proxy"
        self.addresses = Addresses(url, f"http://{HOST}:{web}/?url={quote(url, safe='')}")
        try:
            self._await(grpc, web)
        except WorkerError:
            self.close()
            raise

    @property
    def runs(self) -> bool:
        """Whether the server runs."""
        return self._process.poll() is None

    @property
    def process_id(self) -> int:
        """The server's."""
        return self._process.pid

    def pump(self) -> int:
        """Pass on what is new in the file, as far as the server takes it; return how many bytes it took.

        Raises:
            WorkerError: the server has ended.
        """
        taken = 0
        while self._rest or self._read():
            try:
                count = os.write(self._feed, self._rest)
            except BlockingIOError:
                if select.select((), (self._feed,), (), LOOK_S)[1]:
                    continue  # it is only busy: a long drive's history goes through a small pipe
                break
            except OSError:
                raise WorkerError("rerun's server has ended") from None
            self._rest = self._rest[count:]
            taken += count
        return taken

    def close(self) -> None:
        """End the server."""
        with contextlib.suppress(OSError):
            self._process.kill()
        self._process.wait()
        if self._process.stdin is not None:
            with contextlib.suppress(OSError):
                self._process.stdin.close()

    def _await(self, *ports: int) -> None:
        """Feed the server until it listens: it does not before it has read something."""
        deadline_s = time.monotonic() + START_S
        for port in ports:
            while True:
                if not self.runs:
                    raise WorkerError(f"rerun's server has ended; is one of the ports {ports} taken?")
                with contextlib.suppress(WorkerError):  # the next turn says it with more
                    self.pump()
                with contextlib.suppress(OSError), socket.create_connection((HOST, port), timeout=LOOK_S):
                    break
                if time.monotonic() > deadline_s:
                    raise WorkerError(f"{HOST}:{port}: rerun's server does not listen within {START_S:g} s")
                time.sleep(LOOK_S)

    def _read(self) -> bool:
        """Read on in the file; return whether there was something."""
        try:
            with self._path.open("rb") as file:
                file.seek(self._at)
                self._rest = file.read(BATCH_BYTES)
        except OSError:  # not made yet, or another scene has taken its place: that one is for `view BUNDLE`
            return False
        self._at += len(self._rest)
        return bool(self._rest)


def _as_spectator() -> None:
    """Between fork and exec of the server: end with who feeds it, and let the drive come first."""
    end_with_parent_thread()
    if sys.platform != "win32":
        os.nice(NICE)


def open_native(what: str) -> "subprocess.Popen[bytes]":
    """Open a server's address or a file in rerun's own viewer, in a process that stays open when this one ends."""
    command = [str(rerun_program()), "--bind", HOST, "--port", "auto", what]
    return subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, env=quiet_environment(), process_group=0
    )


def _free_port() -> int:
    with socket.socket() as listener:
        listener.bind((HOST, 0))
        return int(listener.getsockname()[1])


def open_browser(address: str) -> None:
    """Open the browser at a server's address."""
    import webbrowser

    webbrowser.open(address)
