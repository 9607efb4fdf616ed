"""`dask scheduler` and `dask worker` as docs/sweeps.md starts them, each a program of its own as in a cluster."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

from simconsole.processes.lifetimes import end_with_parent_thread
from tests.paths import ROOT
from tests.patience import wait_until
from tests.ports import free_port

DASK = dict(re.findall(r"(DASK_\w+)=(\w+)", (ROOT / "docs" / "sweeps.md").read_text("utf-8")))
"""What the page says to export."""


class Cluster(NamedTuple):
    """Its address, its scheduler and its workers."""

    url: str
    scheduler: "subprocess.Popen[bytes]"
    workers: "list[subprocess.Popen[bytes]]"


@contextmanager
def program(folder: Path, name: str, *words: str) -> "Iterator[subprocess.Popen[bytes]]":
    with (folder / f"{name}.log").open("wb") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", "distributed.cli." + name.partition("-")[0], *words, "--no-dashboard"],
            stdout=log,
            stderr=log,
            cwd=folder,
            env={**os.environ, **DASK},
            # A signal that ends the tests at once lets none of them clean up.
            preexec_fn=end_with_parent_thread if sys.platform == "linux" else None,
        )
    try:
        yield process
    finally:
        process.kill()
        process.wait()


@contextmanager
def cluster(folder: Path, workers: int) -> Iterator[Cluster]:
    """Start a scheduler and so many workers of one thread each."""
    url = f"tcp://127.0.0.1:{free_port()}"
    with ExitStack() as stack:
        scheduler = stack.enter_context(program(folder, "dask_scheduler", "--host", url))
        options = (url, "--nthreads", "1", "--no-nanny", "--local-directory", str(folder))
        begun = [stack.enter_context(program(folder, f"dask_worker-{n}", *options)) for n in range(workers)]
        for number in range(workers):
            log = folder / f"dask_worker-{number}.log"
            wait_until(lambda log=log: b"Registered to" in log.read_bytes(), "a worker")  # type: ignore[misc]
        yield Cluster(url, scheduler, begun)


def pool_workers_of(pid: int) -> list[int]:
    """The processes that drive for a process: the first, then its copies."""
    children = [child for task in Path(f"/proc/{pid}/task").glob("*") for child in read(task / "children").split()]
    found = [
        int(child) for child in children if b"evaluation.sweep.worker" in read(Path(f"/proc/{int(child)}/cmdline"))
    ]
    return [*found, *(copy for one in found for copy in pool_workers_of(one))]


def read(path: Path) -> bytes:
    """What stands in a file of /proc; nothing of a thread or process that has ended meanwhile."""
    try:
        return path.read_bytes()
    except (FileNotFoundError, ProcessLookupError):
        return b""


def kill(pid: int) -> None:
    os.kill(pid, signal.SIGKILL)
