"""roslibpy's own live tests, out of its source distribution, against our server: on both transports.

Usage: python tests/interop/roslibpy_suite.py [FOLDER]. Without the folder of an unpacked sdist it is fetched from the
package index and checked. The nodes that roslibpy's tests expect to find (an action server, a tf republisher, /rosout)
are stood in for below; only the port in the tests is replaced, and how long roslibpy waits (roslibpy_patience.py).
"""

import asyncio
import hashlib
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import threading
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from msgspec import convert
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from simconsole.bridge.messages import Registry, standard_registry
from simconsole.bridge.transport.server import BridgeServer
from simconsole.profiles.bridge import BridgeProfile

PATIENCE_S = 600.0  # of tests/patience.py, which this program cannot import: it ends only what hangs

PLUGIN = "roslibpy_patience"
"""Beside this file."""

VERSION = "2.1.0"
SHA256 = "05d2ec196dd2ff89c864418f7afeac4b01bff5679034c997a6b4d0c54775f352"
TRANSPORTS = ("twisted", "asyncio")
MESSAGES = """
MSG: actionlib_msgs/GoalID
time stamp
string id
===
MSG: actionlib_msgs/GoalStatus
GoalID goal_id
uint8 status
string text
===
MSG: actionlib_msgs/GoalStatusArray
Header header
GoalStatus[] status_list
===
MSG: actionlib/TestGoal
int32 goal
===
MSG: actionlib/TestResult
int32 result
===
MSG: actionlib/TestFeedback
int32 feedback
===
MSG: actionlib/TestActionGoal
Header header
actionlib_msgs/GoalID goal_id
TestGoal goal
===
MSG: actionlib/TestActionResult
Header header
actionlib_msgs/GoalStatus status
TestResult result
===
MSG: actionlib/TestActionFeedback
Header header
actionlib_msgs/GoalStatus status
TestFeedback feedback
===
MSG: tf2_web_republisher/TFArray
geometry_msgs/TransformStamped[] transforms
"""
REPUBLISH = """
string[] source_frames
string target_frame
float32 angular_thres
float32 trans_thres
float32 rate
duration timeout
---
string topic_name
"""
SUCCEEDED, CANCELED = 4, 5


def registry() -> Registry:
    known = standard_registry()
    known.add_all(MESSAGES)
    known.add_service("tf2_web_republisher/RepublishTFs", REPUBLISH)
    known.add_service("rospy_tutorials/AddTwoInts", "int64 a\nint64 b\n---\nint64 sum\n")
    return known


class Server:
    """Our server on a thread of its own."""

    def __init__(self, dialect: str, library: str) -> None:
        self._profile = convert({"port": 0, "dialect": dialect, "transport": library}, BridgeProfile)
        self.port = 0
        self._ready = threading.Event()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=lambda: asyncio.run(self._serve()))
        self._thread.start()
        assert self._ready.wait(PATIENCE_S)

    async def _serve(self) -> None:
        server = BridgeServer(self._profile, registry=registry())
        await server.start()
        self.port = server.port
        self._ready.set()
        while not self._stop.is_set():
            await asyncio.sleep(0.02)
        await server.close()

    def stop(self) -> None:
        self._stop.set()
        self._thread.join(10.0)


class Nodes:
    """The other programs of a ROS graph, as one client."""

    def __init__(self, port: int) -> None:
        self._open = ExitStack()
        self._peer: ClientConnection = self._open.enter_context(connect(f"ws://127.0.0.1:{port}"))
        self._cancelled: set[str] = set()
        self._send(op="advertise", topic="/rosout", type="std_msgs/String")
        self._send(op="advertise", topic="/tf_repub/first", type="tf2_web_republisher/TFArray", latch=True)
        self._send(op="advertise_service", service="/republish_tfs", type="tf2_web_republisher/RepublishTFs")
        self._send(op="advertise_action", action="/fibonacci", type="example_interfaces/action/Fibonacci")
        threading.Thread(target=self._listen, daemon=True).start()

    def _send(self, **operation: Any) -> None:
        self._peer.send(json.dumps(operation))

    def _listen(self) -> None:
        try:
            for text in self._peer:
                operation = json.loads(text)
                if operation["op"] == "call_service":
                    self._republish(operation)
                elif operation["op"] == "send_action_goal":
                    threading.Thread(target=self._pursue, args=(operation,), daemon=True).start()
                elif operation["op"] == "cancel_action_goal":
                    self._cancelled.add(operation["id"])
        except ConnectionClosed:
            pass

    def _republish(self, call: dict[str, Any]) -> None:
        fixed = call["args"]["target_frame"]
        transforms = [{"header": {"frame_id": fixed}, "child_frame_id": name} for name in call["args"]["source_frames"]]
        self._send(op="publish", topic="/tf_repub/first", msg={"transforms": transforms}, latch=True)
        values = {"topic_name": "/tf_repub/first"}
        self._send(op="service_response", service=call["service"], id=call["id"], values=values, result=True)

    def _pursue(self, goal: dict[str, Any]) -> None:
        told = {"action": goal["action"], "id": goal["id"]}
        sequence, pause = [0, 1], threading.Event()
        status = SUCCEEDED
        while len(sequence) <= goal["args"]["order"]:
            if goal["id"] in self._cancelled:
                status = CANCELED
                break
            sequence.append(sequence[-1] + sequence[-2])
            self._send(op="action_feedback", values={"sequence": sequence}, **told)
            pause.wait(0.5)
        self._send(op="action_result", values={"sequence": sequence}, status=status, result=True, **told)

    def close(self) -> None:
        self._open.close()


def fetch(folder: Path) -> Path:
    """Return the unpacked source distribution."""
    name = f"roslibpy=={VERSION}"
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--no-binary", ":all:", name]
    subprocess.run([*command, "--dest", str(folder)], check=True, stderr=subprocess.DEVNULL)
    archive = folder / f"roslibpy-{VERSION}.tar.gz"
    if hashlib.sha256(archive.read_bytes()).hexdigest() != SHA256:
        raise SystemExit(f"{archive.name} is not the archive known here")
    with tarfile.open(archive) as packed:
        packed.extraction_filter = getattr(tarfile, "data_filter", None)  # came with Python 3.11.4
        packed.extractall(folder)
    return folder / f"roslibpy-{VERSION}"


def run(tests: Path, transport: str, dialect: str, library: str) -> str:
    """Run the live tests of one dialect; return the last line of pytest's summary."""
    server = Server(dialect, library)
    nodes = Nodes(server.port)
    try:
        for path in tests.rglob("test_*.py"):
            path.write_text(re.sub(r"\b9090\b", str(server.port), path.read_text("utf-8")), "utf-8")
        environment = {**os.environ, "ROSLIBPY_TRANSPORT": transport}
        shutil.copy(Path(__file__).with_name(f"{PLUGIN}.py"), tests)  # -m makes modules of the folder importable
        words = ["-m", "pytest", "-q", f"--timeout={PATIENCE_S:.0f}", "-p", "no:cacheprovider", "-p", PLUGIN]
        more = ["--import-mode=importlib", f"--rootdir={tests}", "-c", "/dev/null", dialect]
        command = [sys.executable, *words, *more]
        done = subprocess.run(command, cwd=tests, env=environment, capture_output=True, text=True)
        if done.returncode:
            print(done.stdout[-6000:])
        summary = [
            line for line in done.stdout.splitlines() if " in " in line and ("passed" in line or "failed" in line)
        ]
        return summary[-1].strip("= ") if summary else f"pytest ended with {done.returncode}"
    finally:
        nodes.close()
        server.stop()


CASES = tuple(itertools.product(TRANSPORTS, ("ros1", "ros2"), ("websockets", "picows")))
"""Its transport, the dialect, and the library of our transport."""
EACH = (CASES[0], CASES[-1])
"""Two of them, with each of these in one."""


def run_all(source: Path, scratch: Path, cases: Sequence[tuple[str, str, str]] = CASES) -> dict[str, str]:
    """Run the live tests for both dialects over both its transports and both of ours; return each one's summary."""

    def one(transport: str, dialect: str, library: str) -> str:
        tests = scratch / f"tests-{transport}-{dialect}-{library}"
        shutil.copytree(source / "tests", tests)
        return run(tests, transport, dialect, library)

    with ThreadPoolExecutor(len(cases)) as beside:  # they wait more than they work
        summaries = list(beside.map(lambda case: one(*case), cases))
    names = [f"{dialect} {transport}, our server on {library}" for transport, dialect, library in cases]
    return dict(zip(names, summaries, strict=True))


def main() -> int:
    with tempfile.TemporaryDirectory(prefix="simconsole-roslibpy-") as folder:
        scratch = Path(folder)
        source = Path(sys.argv[1]) if len(sys.argv) > 1 else fetch(scratch)
        summaries = run_all(source, scratch)
    for case, summary in summaries.items():
        print(f"roslibpy {VERSION} {case}: {summary}")
    return 0 if all(is_good(summary) for summary in summaries.values()) else 1


def is_good(summary: str) -> bool:
    """Return whether pytest's last line tells of tests that all passed."""
    return "passed" in summary and not any(word in summary for word in ("failed", "error", "skipped"))


if __name__ == "__main__":
    sys.exit(main())
