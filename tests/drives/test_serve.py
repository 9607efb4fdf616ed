"""`simconsole bridge serve`: a rosbridge server to try programs on, with no cockpit and nobody seated."""

import json
import signal
from pathlib import Path

from .console import Running, complaint, results, simconsole, wait_until
from .controllers import Controller, command, free_port


def test_a_controller_reads_and_commands_a_standing_car(tmp_path: Path) -> None:
    port = free_port()
    with Running(tmp_path, "bridge", "serve", "--port", port, "--json") as server:
        controller = Controller(port, lambda count, stamp: [json.dumps(command(stamp))])
        controller.start()
        wait_until(lambda: controller.odometry > 10, "odometry")
        server.process.send_signal(signal.SIGINT)
        done = server.end()
        controller.join(30.0)
    assert done.returncode == 130
    assert results(done)["interrupted"] is True
    assert controller.failure is None
    assert not [status for status in controller.statuses if status["level"] == "error"]
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.glob("bundle*"))


def test_it_ends_by_itself_when_told_so() -> None:
    done = simconsole("bridge", "serve", "--port", free_port(), "--for", 0.5, "--json")
    assert done.returncode == 0, done.stderr
    assert results(done)["interrupted"] is False


def test_a_port_that_is_none_is_one_line() -> None:
    assert "outputs.bridge.port: value 70000" in complaint(simconsole("bridge", "serve", "--port", 70000))
