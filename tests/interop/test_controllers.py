"""examples/controllers: with roslibpy, with rclpy, and with roslib in a page, each follows the route."""

import json
import shutil
import sys
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from tests.drives.console import environment as headless
from tests.interop.browser import CHROMIUM, browse
from tests.interop.programs import environment, npm_packages, program, wait_for_port
from tests.interop.ros2 import PYTHON, domain, needs_ros2
from tests.paths import ROOT
from tests.patience import PATIENCE_S, wait_until
from tests.ports import free_port

EXAMPLE = ROOT / "examples" / "controllers"
NPM = shutil.which("npm")
ROSLIB = "1.4.1"
BRIEF = "duration_s: 10, start: {x_m: 262.0, y_m: 0.0, yaw_deg: 0.0}"


def copied(folder: Path, port: int = 9090) -> Path:
    """The example with a port of its own; its drive is half as long, into the first bend, and nobody reads a report."""
    shutil.copytree(EXAMPLE, folder)
    for session in folder.glob("session*.yaml"):
        text = session.read_text().replace("9090", str(port)).replace("duration_s: 20", BRIEF)
        session.write_text(text.replace("scene: null", "scene: null\n  report: false"))
    return folder


def judged(output: str) -> None:
    """Look at what the drive's `--json` said: every tick answered, and on the route."""
    results = json.loads(output.splitlines()[-1])
    assert (results["exchanges"], results["unanswered"]) == (500, 0)
    assert results["autonomous"]["distance_m"] > 40.0
    assert results["autonomous"]["lateral_max_m"] < 0.2


def test_with_roslibpy(tmp_path: Path) -> None:
    port = free_port()
    folder = copied(tmp_path / "controllers", port)
    words = (sys.executable, "-m", "simconsole", "drive", str(folder / "session.yaml"), "--json", "--no-pack")
    around = headless(PYTHONPATH=str(ROOT))
    with program(around, *words, "--out", str(tmp_path / "out")) as drive:
        command = (sys.executable, str(folder / "with_roslibpy.py"), str(port))
        with program(environment(), *command) as client:
            output, complaint = drive.communicate(timeout=PATIENCE_S)
            assert drive.returncode == 0, complaint
            assert client.communicate(timeout=PATIENCE_S)[0] == "the drive has ended after 500 answers\n"
    judged(output)


@needs_ros2
def test_with_rclpy(tmp_path: Path) -> None:
    around, folder = domain(), copied(tmp_path / "controllers")
    words = (PYTHON, "-m", "simconsole", "drive", str(folder / "session_ros2.yaml"), "--json", "--no-pack")
    with (
        program(around, *words, "--out", str(tmp_path / "out")) as drive,
        program(around, PYTHON, str(folder / "with_rclpy.py")) as node,
    ):
        output, complaint = drive.communicate(timeout=PATIENCE_S)
        assert drive.returncode == 0, complaint
        assert node.communicate(timeout=PATIENCE_S)[0] == "the drive has ended after 500 answers\n"
    judged(output)


@pytest.fixture(scope="module")
def roslib() -> Path:
    """The folder that the README's npm command makes; fetched once."""
    return npm_packages(f"roslib-{ROSLIB}", "roslib/build", f"roslib@{ROSLIB}")


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        pass


@pytest.mark.skipif(NPM is None, reason="no npm: system-packages.txt")
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: system-packages.txt")
def test_with_roslib_in_a_page(tmp_path: Path, roslib: Path) -> None:
    port = free_port()
    folder = copied(tmp_path / "controllers", port)
    (folder / "node_modules").symlink_to(roslib)
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        words = (sys.executable, "-m", "simconsole", "drive", str(folder / "session.yaml"), "--json", "--no-pack")
        with program(headless(PYTHONPATH=str(ROOT)), *words, "--out", str(tmp_path / "out")) as drive:
            wait_for_port(port)
            (tmp_path / "browser").mkdir()
            page_url = f"http://127.0.0.1:{server.server_port}/with_roslib.html?{port}"
            with browse(page_url, tmp_path / "browser", 400, 300) as page:
                said = "document.getElementById('said')?.textContent"
                wait_until(lambda: "has ended" in str(page.value(said)), "the end of the drive")
                assert page.value(said) == "the drive has ended after 500 answers"
            output, complaint = drive.communicate(timeout=PATIENCE_S)
            assert drive.returncode == 0, complaint
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
    judged(output)
