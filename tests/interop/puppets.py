"""The two sides of a relay in a test: nodes that do what they are told, and a console whose complaints are read."""

import json
import queue
import subprocess
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from tests.interop.programs import HERE, program, wait_for_port
from tests.interop.ros2 import PYTHON
from tests.patience import PATIENCE_S
from tests.ports import free_port


class Puppet:
    """A node (`rclpy_puppet.py`) and what it has said."""

    def __init__(self, process: "subprocess.Popen[str]") -> None:
        self.process = process
        self._said: queue.Queue[dict[str, Any]] = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def do(self, what: str, **order: Any) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps({"do": what, **order}) + "\n")
        self.process.stdin.flush()

    def hear(self, wanted: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
        """The next remark that is wanted."""
        while True:
            said = self._said.get(timeout=PATIENCE_S)
            if wanted(said):
                return said

    def heard(self) -> dict[str, Any] | None:
        """The next remark if there is one within a moment."""
        try:
            return self._said.get(timeout=0.05)
        except queue.Empty:
            return None

    def hears(self, wanted: Callable[[dict[str, Any]], Any], within_s: float = 1.0) -> bool:
        """Whether a remark that is wanted comes within a while after the last."""
        try:
            while not wanted(self._said.get(timeout=within_s)):
                pass
        except queue.Empty:
            return False
        return True

    def answers(self, word: str, name: str, count: int) -> dict[int, dict[str, Any]]:
        """The `count` remarks on calls or goals of one name, by number."""
        found: dict[int, dict[str, Any]] = {}
        while len(found) < count:
            said = self.hear(lambda said: said.get(word) == name)
            found[said["number"]] = said
        return found

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._said.put(json.loads(line))


@contextmanager
def puppet(around: Mapping[str, str], name: str = "puppet") -> Iterator[Puppet]:
    with program(around, PYTHON, str(HERE / "rclpy_puppet.py"), name) as process:
        made = Puppet(process)
        made.hear(lambda said: "ready" in said)
        yield made


class Served:
    """A console with a graph: where it listens, and all that it has complained of."""

    def __init__(self, process: "subprocess.Popen[str]", url: str) -> None:
        self.process = process
        self.url = url
        self.complaints: list[str] = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def text(self) -> str:
        return "".join(self.complaints)

    def _read(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            self.complaints.append(line)


@contextmanager
def served(around: Mapping[str, str], *options: str) -> Iterator[Served]:
    """`simconsole bridge serve --ros2`, which must not have broken down by the end."""
    port = free_port()
    words = [PYTHON, "-m", "simconsole", "bridge", "serve", "--ros2", "--port", str(port), *options]
    with subprocess.Popen(
        words, env=dict(around), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    ) as process:
        made = Served(process, f"ws://127.0.0.1:{port}")
        try:
            wait_for_port(port)
            yield made
            assert process.poll() is None
        finally:
            process.terminate()
            process.wait(PATIENCE_S)
            print(made.text)
    assert "Traceback" not in made.text
    assert "has failed" not in made.text
