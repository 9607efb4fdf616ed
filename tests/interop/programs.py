"""Programs beside a test: a console that serves rosbridge, a client of it, and whatever else takes part."""

import json
import os
import socket
import subprocess
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

from tests.paths import ROOT
from tests.patience import PATIENCE_S, wait_until
from tests.ports import free_port

HERE = Path(__file__).parent
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "simconsole-tests"
"""What was fetched once from a package index."""


def environment(**more: str) -> dict[str, str]:
    """This one, with the package of this tree."""
    return {**os.environ, "PYTHONPATH": str(ROOT), **more}


@contextmanager
def program(around: Mapping[str, str], *words: str) -> Iterator["subprocess.Popen[str]"]:
    """A program; its end is the test's at the latest."""
    with subprocess.Popen(
        words, env=around, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            yield process
        finally:
            process.kill()
            print(process.communicate()[1])  # pytest shows it where a test fails


def npm_packages(name: str, made: str, *packages: str) -> Path:
    """The folder of npm packages (`NAME@VERSION`), fetched once into `name` of the cache.

    `made` is a file or folder in it that is there once it is whole.
    """
    folder = CACHE / name / "node_modules"
    if not (folder / made).exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        words = ["npm", "install", "--prefix", str(folder.parent), "--no-save", "--no-package-lock", "--ignore-scripts"]
        done = subprocess.run([*words, "--no-audit", "--no-fund", *packages], capture_output=True, text=True)
        assert done.returncode == 0, f"npm cannot fetch {', '.join(packages)}: {done.stderr[-300:]}"
    return folder


def wait_for_port(port: int) -> None:
    """Wait until somebody listens there."""

    def listens() -> bool:
        with socket.socket() as probe:
            return not probe.connect_ex(("127.0.0.1", port))

    wait_until(listens, f"somebody who listens on port {port}")


@contextmanager
def console(python: str, around: Mapping[str, str], *options: str) -> Iterator[str]:
    """`simconsole bridge serve`: where it listens."""
    port = free_port()
    with program(around, python, "-m", "simconsole", "bridge", "serve", "--port", str(port), *options):
        wait_for_port(port)
        yield f"ws://127.0.0.1:{port}"


class Client:
    """A rosbridge client, one text at a time."""

    def __init__(self, web: ClientConnection) -> None:
        self.web = web

    def say(self, **operation: Any) -> None:
        self.web.send(json.dumps(operation))

    def hear(self, wanted: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
        """The next operation that is wanted."""
        while True:
            heard: dict[str, Any] = json.loads(self.web.recv(timeout=PATIENCE_S))
            assert heard["op"] != "status", heard
            if wanted(heard):
                return heard

    def status(self) -> dict[str, Any]:
        """The next status."""
        while True:
            heard: dict[str, Any] = json.loads(self.web.recv(timeout=PATIENCE_S))
            if heard["op"] == "status":
                return heard

    def answers(self, count: int) -> dict[int, dict[str, Any]]:
        """Values of the answers to calls 0 to `count` - 1, in whatever order they come."""
        found: dict[int, dict[str, Any]] = {}
        while len(found) < count:
            heard = self.hear(lambda said: said["op"] == "service_response")
            found[heard["id"]] = heard["values"]
        return found

    def message(self, topic: str) -> Any:
        return self.hear(lambda heard: heard.get("topic") == topic)["msg"]


@contextmanager
def client(url: str) -> Iterator[Client]:
    with connect(
        url, close_timeout=0.1, max_size=None
    ) as web:  # it may have stopped reading, and the server then waits to say bye
        yield Client(web)
