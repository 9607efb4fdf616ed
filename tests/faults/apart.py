"""A bridge server in a process of its own, whose resident memory is its own."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.bridge.networks import Raw
from tests.patience import PATIENCE_S

# Answers each line of its input with what it has counted of its first client, on the clock that it limits by.
SERVER = """
import asyncio, json, sys, time
from simconsole.bridge.transport.server import BridgeServer
from simconsole.profiles.bridge import BridgeProfile

async def main():
    server = BridgeServer(BridgeProfile(port=0, transport=sys.argv[1], lease_ms=10_000.0))
    await server.start()
    print(server.port, flush=True)
    began_s = time.monotonic()
    while await asyncio.to_thread(sys.stdin.readline):
        command, session = server.console.inputs.command, server.console.router.sessions[0]
        counts = {"taken": command.sequence, "refused": command.refused, "passed_over": session.throttled,
                  "queued": session.send_queue.bytes, "angle": command.road_wheel_rad,
                  "elapsed_s": time.monotonic() - began_s}
        print(json.dumps(counts), flush=True)
    await server.close()

asyncio.run(main())
"""


class Server:
    """The server's process."""

    def __init__(self, process: "subprocess.Popen[str]") -> None:
        self._process = process
        self.port = int(self._read())

    def _read(self) -> str:
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        assert line, "the server has ended"
        return line

    def counts(self) -> dict[str, float]:
        assert self._process.stdin is not None
        self._process.stdin.write("\n")
        self._process.stdin.flush()
        found: dict[str, float] = json.loads(self._read())
        return found

    def resident_bytes(self) -> int:
        pages = Path(f"/proc/{self._process.pid}/statm").read_text().split()[1]
        return int(pages) * os.sysconf("SC_PAGE_SIZE")


@contextmanager
def serving_apart(transport: str) -> Iterator[Server]:
    command = [sys.executable, "-c", SERVER, transport]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield Server(process)
        finally:
            assert process.stdin is not None
            process.stdin.close()
            assert process.wait(PATIENCE_S) == 0


def settle(client: Raw) -> list[dict[str, Any]]:
    """Return what the server has said when everything sent before has been read."""
    client.say(op="no_such", id="settle")
    heard: list[dict[str, Any]] = []
    while not heard or heard[-1].get("id") != "settle":
        received = client.receive()
        assert received is not None
        heard.append(json.loads(received[1]))
    return heard
