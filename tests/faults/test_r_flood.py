"""R09 over a socket: as many commands as a client can write, into a server in a process of its own."""

import json
from collections.abc import Callable
from typing import Any

import pytest

from tests.bridge.networks import TEXT, Raw, frame
from tests.faults.apart import serving_apart, settle
from tests.samples import Measured, Sample

CONTROL = "/control/command/control_cmd"
MIB = 1 << 20
LIMIT_HZ = 500


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
