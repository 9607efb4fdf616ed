"""Viewers of a scene's server, as far as a test needs them: rerun's own client, which saves what it is served."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from simconsole.scene.viewer.scene_server import quiet_environment, rerun_program
from tests.ports import free_port
from tests.scene.viewer.test_export import rerun_rrd


class Viewer:
    """A client that joined."""

    def __init__(self, process: "subprocess.Popen[bytes]", path: Path) -> None:
        self.process = process
        self.path = path
        self._printed: tuple[int, str] = 0, ""
        """The size that what was saved had when it was last printed, and that print."""

    def sees(self, entity: str) -> int:
        """How many pieces of an entity have come; what is still being written does not count."""
        if not self.path.exists():
            return 0
        content = self.path.read_bytes()
        if len(content) != self._printed[0]:
            copy = self.path.with_suffix(".copy.rrd")
            copy.write_bytes(content)
            self._printed = len(content), rerun_rrd("print", str(copy)).stdout
        return self._printed[1].count(f" - {entity} - ")


@contextmanager
def viewer(address: str, path: Path) -> Iterator[Viewer]:
    """Join a server as a viewer does, over gRPC."""
    words = [str(rerun_program()), "--bind", "127.0.0.1", "--port", str(free_port()), "--save", str(path), address]
    process = subprocess.Popen(
        words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=quiet_environment()
    )
    try:
        yield Viewer(process, path)
    finally:
        process.kill()
        process.wait()


def listening_hosts(process_id: int) -> dict[int, set[str]]:
    """The addresses, as the kernel writes them, on which a process listens, by port."""
    own: set[str] = set()
    for descriptor in Path(f"/proc/{process_id}/fd").iterdir():
        with suppress(FileNotFoundError):  # it was closed just now
            own.add(str(descriptor.readlink()))
    found: dict[int, set[str]] = {}
    for table in ("tcp", "tcp6"):
        for line in Path(f"/proc/{process_id}/net/{table}").read_text().splitlines()[1:]:
            fields = line.split()
            if fields[3] == "0A" and f"socket:[{fields[9]}]" in own:
                host, _, port = fields[1].partition(":")
                found.setdefault(int(port, 16), set()).add(host)
    return found


LIVE = """
import sys
from pathlib import Path
import numpy as np
from simconsole.values.state_vector import Snapshot
from simconsole.scene.viewer.follow import Ports, follow
from tests.scene.drives import job as make_job, rows

path, count = Path(sys.argv[1]), int(sys.argv[2])
job, table, given = make_job(), rows(7500), 0
def new_ticks():
    global given
    start, given = given, min(given + 250, count)
    return [Snapshot(i + 1, job.tick_hz, table[i % len(table)]) for i in range(start, given)]
follow(Ports(new_ticks, lambda: given >= count), job._replace(profile=job.profile.__class__(chunk_s=1e-6)), path)
"""


def live_scene(path: Path, seconds: int, root: Path) -> None:
    """Append a drive of so many seconds to a live scene, as fast as it goes."""
    words = [sys.executable, "-c", LIVE, str(path), str(250 * seconds)]
    done = subprocess.run(words, capture_output=True, text=True, check=False, cwd=root)
    assert done.returncode == 0, done.stderr
