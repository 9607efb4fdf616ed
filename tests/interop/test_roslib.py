"""Stock roslib 2.1.0 from npm, under Node, uses every kind of operation and drives the car."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader

from simconsole.cli.main import main
from tests.interop.programs import HERE, environment, npm_packages, program, wait_for_port
from tests.interop.sessions import lockstep_session
from tests.patience import PATIENCE_S
from tests.ports import free_port
from tests.samples import Sample

VERSION = "2.1.0"
TOKEN = "a-token-of-enough-letters"
PROGRAM = str(HERE / "roslib_program.mjs")
NODE = shutil.which("node")

pytestmark = pytest.mark.skipif(NODE is None or shutil.which("npm") is None, reason="no Node.js with npm")


@pytest.fixture(scope="module")
def node() -> Callable[..., tuple[str, ...]]:
    """The words of a Node program with roslib, which npm fetches once."""
    library = npm_packages(f"roslib-{VERSION}", "roslib", f"roslib@{VERSION}") / "roslib"
    assert json.loads((library / "package.json").read_text())["version"] == VERSION
    return lambda *words: (str(NODE), PROGRAM, str(library / "dist/RosLib.js"), *words)


def told(process: "subprocess.Popen[str]") -> dict[str, Any]:
    """The next line a program says."""
    assert process.stdout is not None
    line = process.stdout.readline()
    assert line, "the program ended"
    seen: dict[str, Any] = json.loads(line)
    return seen


@pytest.mark.parametrize("library", ["websockets", "picows"])
def test_every_kind_of_operation_and_a_restart(
    node: Callable[..., tuple[str, ...]], tmp_path: Path, library: str
) -> None:
    port, tokens = free_port(), tmp_path / "tokens"
    tokens.write_text(f"control {TOKEN}\n")
    serve = [sys.executable, "-m", "simconsole", "bridge", "serve", "--port", str(port), "--tokens", str(tokens)]
    serve += ["--transport", library]
    with program(environment(), *serve) as first:
        wait_for_port(port)
        with program(dict(os.environ), *node("talk", f"ws://127.0.0.1:{port}", TOKEN)) as talker:
            assert told(talker) == {
                "stranger": "turned away",
                "none": ["odom", 36, "Array"],
                "png": ["odom", 36, "Array"],
                "cbor": ["odom", 36, "Float64Array"],
                "chatter": "hello",
                "sum": 5,
                "failed": "/none: nobody provides it",
                "feedback": [[0, 1]],
                "result": {"sequence": [0, 1, 1, 2]},
                "cancelled": 'GoalError: Action was canceled: {"sequence":[0]}',
                "param": 0.8,
                "topics": True,
                "type": "nav_msgs/msg/Odometry",
            }
            first.terminate()
            first.wait(PATIENCE_S)
            with program(environment(), *serve):
                assert told(talker) == {"returned": "odometry is back"}


def test_roslib_drives(
    node: Callable[..., tuple[str, ...]],
    tmp_path: Path,
    sample: Sample,
    record_property: Callable[[str, object], None],
) -> None:
    seconds = sample.of(15, 60)
    port, bundle = free_port(), tmp_path / "bundle"
    words = ["-m", "simconsole", "drive", lockstep_session(tmp_path, port, seconds), "--out", str(bundle), "--json"]
    words.append("--no-pack")
    with program(environment(), sys.executable, *words) as drive:
        wait_for_port(port)
        with program(dict(os.environ), *node("drive", f"ws://127.0.0.1:{port}", str(seconds))) as driver:
            seen = told(driver)
            output, complaint = drive.communicate(timeout=PATIENCE_S)
    assert drive.returncode == 0, complaint
    results = json.loads(output.splitlines()[-1])
    assert (results["unanswered"], results["exchanges"], seen["answers"]) == (0, 50 * seconds, 50 * seconds)
    assert results["distance_m"] > 8.0 * seconds - 80.0  # at 8 m/s, but for the start
    assert 2.5 < seen["y_m"] < 3.5  # it steered to 3, from 0
    with (bundle / "topics.mcap").open("rb") as file:
        recorded = make_reader(file).get_summary()
    assert recorded is not None
    assert recorded.statistics is not None
    assert recorded.statistics.message_count == 50 * seconds
    assert main(["verify", str(bundle)]) == 0
    assert main(["replay", str(bundle)]) == 0
    record_property("roslib in lockstep", f"{seconds} s driven in {seen['wall_s']:.1f} s, 50 Hz control from Node")
