"""`simconsole bridge serve`: a rosbridge server to try programs on, with no cockpit and nobody seated."""

import json
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from tests.drives.console import Running, complaint, results, simconsole, within
from tests.drives.controllers import Controller, command
from tests.paths import ROOT
from tests.patience import PATIENCE_S, wait_until
from tests.ports import free_port


def test_a_controller_reads_and_commands_a_standing_car(tmp_path: Path) -> None:
    port = free_port()
    with Running(tmp_path, "bridge", "serve", "--port", port, "--json") as server:
        controller = Controller(port, lambda count, stamp: [json.dumps(command(stamp))])
        controller.start()
        wait_until(lambda: controller.odometry > 125, "odometry of more than two seconds")
        server.process.send_signal(signal.SIGINT)
        done = server.end()
        controller.join(PATIENCE_S)
    assert done.returncode == 130
    assert results(done)["interrupted"] is True
    counts = results(done)["bridge"]
    assert counts["connections"] == 1
    # As of the last second.
    assert counts["received"] > 50
    assert counts["sent"] > 50
    assert controller.failure is None
    assert not [status for status in controller.statuses if status["level"] == "error"]
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.glob("bundle*"))


@contextmanager
def copied_example(folder: Path) -> Iterator[tuple[subprocess.Popen[bytes], Callable[[], tuple[float, str]]]]:
    """The documentation's first controller drives the car of a server; yields it and what reads speed (m/s), mode."""
    port = free_port()
    example = re.findall(r"```python\n(.*?)```", (ROOT / "docs/rosbridge.md").read_text(), re.DOTALL)[0]
    program = folder / "controller.py"
    program.write_text(example.replace("9090", str(port)))
    driving: list[subprocess.Popen[bytes]] = []
    with Running(folder, "bridge", "serve", "--port", port, "--json") as server:
        watcher = Controller(port, lambda count, stamp: [json.dumps(command(stamp))] if not driving else [])
        watcher.start()
        wait_until(lambda: server.said("parked: nobody has asked for autonomy"), "the notice")
        driving.append(subprocess.Popen([sys.executable, str(program)]))
        try:
            with connect(f"ws://127.0.0.1:{port}") as viewer:
                yield driving[0], seen_by(viewer, driving[0])
        finally:
            driving[0].kill()
            driving[0].wait()
        server.process.send_signal(signal.SIGINT)
        server.end()
        watcher.join(PATIENCE_S)


def seen_by(viewer: ClientConnection, program: subprocess.Popen[bytes]) -> Callable[[], tuple[float, str]]:
    """Return what reads the next message, and returns the speed (m/s) and the mode that were said last."""
    for topic in ("/odom", "/console/mode"):
        viewer.send(json.dumps({"op": "subscribe", "topic": topic}))
    said: dict[str, Any] = {}

    def see() -> tuple[float, str]:
        assert program.poll() is None, "the example has ended"
        message = json.loads(viewer.recv(timeout=PATIENCE_S))
        said[message.get("topic", "")] = message.get("msg")
        odometry, mode = said.get("/odom"), said.get("/console/mode")
        return odometry["twist"]["twist"]["linear"]["x"] if odometry else 0.0, mode["data"] if mode else ""

    return see


def test_a_copied_example_drives_at_once_and_drives_on_after_it_was_held_up(tmp_path: Path) -> None:
    """The console has stopped the car then: it stands, but its speed is hardly ever 0 to the last digit again."""
    with copied_example(tmp_path) as (program, see):
        while see()[0] < 1.0:
            pass
        program.send_signal(signal.SIGSTOP)
        while see()[1] != "STOPPED":
            pass
        program.send_signal(signal.SIGCONT)
        while see()[0] < 1.0:
            pass


def test_port_of_the_system_s_choice_is_said_and_our_own_server_passes_the_check(tmp_path: Path) -> None:
    with Running(tmp_path, "bridge", "serve", "--port", 0, "--json") as server:
        wait_until(lambda: server.said("rosbridge at"), "the address")
        port = int(server.err.read_text().split("rosbridge at ws://127.0.0.1:")[1].split()[0])
        controller = Controller(port, lambda count, stamp: [])
        controller.start()
        wait_until(lambda: controller.odometry > 0, "odometry")
        assert controller.statuses == []
        checked = within("bridge", "check", f"ws://127.0.0.1:{port}", "--json")
        server.process.send_signal(signal.SIGINT)
        done = server.end()
        controller.join(PATIENCE_S)
    assert controller.failure is None
    assert (done.returncode, results(done)["interrupted"]) == (130, True)
    assert checked.returncode == 0, checked.stderr
    assert results(checked)["passed"] == len(results(checked)["rows"])
    assert "DEVIATION" not in checked.stderr


def test_a_port_that_is_none_is_one_line() -> None:
    assert "outputs.bridge.port: value 70000" in complaint(within("bridge", "serve", "--port", 70000))


@pytest.mark.parametrize(
    ("option", "value", "told"),
    [
        ("--limit", "message_bytes", "--limit: 'message_bytes' is not NAME=NUMBER"),
        ("--limit", "message_bytes=many", "--limit: 'message_bytes=many' is not NAME=NUMBER"),
        ("--limit", "message_bytes=7", "outputs.bridge.limits.message_bytes: value 7"),
        ("--limit", "mesage_bytes=7000", "did you mean message_bytes?"),
        ("--origin", "ftp://x", "outputs.bridge.allowed_origins[0]: "),
    ],
)
def test_limits_and_origins_are_options_that_are_checked(option: str, value: str, told: str) -> None:
    assert told in complaint(within("bridge", "serve", option, value))


def test_it_is_not_open_to_other_machines_by_accident() -> None:
    refused = complaint(within("bridge", "serve", "--host", "0.0.0.0", "--port", free_port()))
    assert "set tokens and certificate" in refused


def test_it_serves_others_with_a_certificate_and_a_token_and_ends_by_itself_when_told_so(tmp_path: Path) -> None:
    made = results(within("bridge", "cert", "--host", "0.0.0.0", "--out", tmp_path, "--json"))
    options = ("--tokens", made["tokens"], "--certificate", made["certificate"])
    done = simconsole("bridge", "serve", "--host", "0.0.0.0", "--port", free_port(), "--for", 0.5, *options, "--json")
    assert done.returncode == 0, done.stderr
    assert "rosbridge at wss://0.0.0.0" in done.stderr
    assert results(done)["interrupted"] is False


def test_check_of_a_server_that_is_not_there() -> None:
    assert "ws://127.0.0.1" in complaint(within("bridge", "check", f"ws://127.0.0.1:{free_port()}"))


def test_limits_and_origins_are_those_of_the_options(tmp_path: Path) -> None:
    port = free_port()
    options = ("--origin", "null", "--limit", "message_bytes=2000", "--limit", "clients=3")
    with Running(tmp_path, "bridge", "serve", "--port", port, *options) as server:
        wait_until(lambda: server.said("rosbridge at"), "the address")
        url = f"ws://127.0.0.1:{port}"
        with pytest.raises(InvalidStatus):
            connect(url, origin=Origin("file://"))
        with connect(url, origin=Origin("null")) as page:
            page.send("x" * 2001)
            with pytest.raises(ConnectionClosed) as closed:
                page.recv(timeout=PATIENCE_S)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1009
        server.process.send_signal(signal.SIGINT)
        server.end()
