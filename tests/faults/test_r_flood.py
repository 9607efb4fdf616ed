"""R09 over a socket: as many commands as a client can write, into a server in a process of its own."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from tests.bridge.networks import TEXT, Raw, frame
from tests.samples import Measured, Sample

CONTROL = "/control/command/control_cmd"
MIB = 1 << 20
LIMIT_HZ = 500

# Answers each line of its input with what it has counted of its first client, on the clock that it limits by.
SERVER = """
import asyncio, json, sys, time
from simconsole.bridge.server import BridgeServer
from simconsole.profiles.bridge import BridgeProfile

async def main():
    server = BridgeServer(BridgeProfile(port=0, transport=sys.argv[1], lease_ms=10_000.0))
    await server.start()
    print(server.port, flush=True)
    began_s = time.monotonic()
    while await asyncio.to_thread(sys.stdin.readline):
        command, session = server.console.inputs.command, server.console.router.sessions[0]
        counts = {"taken": command.sequence, "refused": command.refused, "passed_over": session.throttled,
                  "queued": session.outgoing.bytes, "angle": command.road_wheel_rad,
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
            assert process.wait(60.0) == 0


def settle(client: Raw) -> list[dict[str, Any]]:
    """Return what the server has said when everything sent before has been read."""
    client.say(op="no_such", id="settle")
    heard: list[dict[str, Any]] = []
    while not heard or heard[-1].get("id") != "settle":
        received = client.receive()
        assert received is not None
        heard.append(json.loads(received[1]))
    return heard


@pytest.mark.fault("R09")
@pytest.mark.parametrize("transport", ["websockets", "picows"])
@pytest.mark.timeout(1200)
def test_r09_flood_over_a_socket_is_counted_whole_and_takes_no_memory(
    transport: str, sample: Sample, measured: Measured, control: Callable[..., Any]
) -> None:
    """600,000 commands, as of 10 kHz for a minute, or a tenth; written in pieces of a hundred, never waiting."""
    pieces = sample.of(600, 6000)
    text = json.dumps({"op": "publish", "topic": CONTROL, "msg": control(0.1)}).encode()
    piece = frame(TEXT, text) * 100
    with serving_apart(transport) as server, Raw(server.port) as flooder:
        flooder.say(op="set_level", level="error")
        flooder.sock.settimeout(None)  # the server's pace is the kernel's to keep
        heard, resident = 0, 0
        for number in range(pieces):
            flooder.sock.sendall(piece)
            if number % 100 == 99:  # or its remarks would fill the connection
                heard += len(settle(flooder)) - 1
                resident = resident or server.resident_bytes()
        grown = server.resident_bytes() - resident
        counts = server.counts()
        flooder.say(op="publish", topic="/console/request", msg={"data": "estop"})
        flooder.say(op="publish", topic=CONTROL, msg=control(0.2))
        settle(flooder)
    assert counts["taken"] + counts["passed_over"] == 100 * pieces
    assert (counts["refused"], counts["queued"], counts["angle"]) == (0, 0, 0.1)
    assert counts["taken"] <= LIMIT_HZ * (counts["elapsed_s"] + 1.0)
    assert counts["passed_over"] > 0.0
    assert heard <= counts["elapsed_s"] + 2.0, "told once a second"
    per_s = 100 * pieces / counts["elapsed_s"]
    seen = f"{counts['taken']:.0f} of {100 * pieces} taken at {per_s:.0f} a second, the others passed over and told"
    measured("R09", f"flood over a socket, {transport}", seen, "every one accounted for, 500 a second taken")
    measured("R09", f"resident memory after it, {transport}", f"{grown / MIB:+.2f} MiB", "at most 1 MiB")
    assert grown <= MIB
