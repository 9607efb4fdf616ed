"""A worker: one process beside the core, and the one typed configuration that it is started with.

Run as `python -m simconsole.processes worker`, with a `WorkerCall` as one line of JSON on standard input.
"""

import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, Self

import msgspec

from simconsole.processes.lifetimes import follow_parent, read_told
from simconsole.processes.notices import NoticeWriter, log_notices
from simconsole.values.errors import SimConsoleError, WorkerError, one_line
from simconsole.values.host.loading import loaded


class Worker(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of all workers. The fields of one are its configuration; they travel to its process as JSON."""

    def run(self, folder: Path, stop: Callable[[], bool]) -> None:
        """Work until `stop` says so.

        Args:
            folder: the run folder, with the memory that the core and its workers share.
            stop: whether to end, asked again and again.
        """
        raise NotImplementedError


class WorkerSpec(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A worker as its supervisor sees it: `target` is `module:class`, `configuration` the fields of that class."""

    name: str
    target: str
    configuration: msgspec.Raw
    environment: dict[str, str | None] = {}  # laid over the core's; None removes

    @classmethod
    def of(cls, name: str, worker: Worker) -> Self:
        """Return what starts `worker` in a process of its own."""
        kind = type(worker)
        configuration = msgspec.Raw(msgspec.json.encode(worker))
        return cls(name=name, target=f"{kind.__module__}:{kind.__qualname__}", configuration=configuration)


class WorkerCall(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What a worker's process is told."""

    folder: str
    worker: WorkerSpec
    patience_s: float


def load_worker(spec: WorkerSpec) -> Worker:
    """Return the worker that `spec` describes.

    Raises:
        WorkerError: there is no such class, or the configuration does not fit it.
    """
    module, _, kind = spec.target.partition(":")
    try:
        worker: Any = msgspec.json.decode(spec.configuration, type=getattr(loaded(module), kind))
    except (ImportError, AttributeError, msgspec.MsgspecError) as error:
        raise WorkerError(f"worker {spec.name}: {spec.target} cannot be loaded: {error}") from None
    if not isinstance(worker, Worker):
        raise WorkerError(f"worker {spec.name}: {spec.target} is not a worker")
    return worker


def run_child(role: str, run: Callable[[bytes], None]) -> int:
    """Be a child process: do what the parent told, in one line; return the exit code. Errors are one line."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the core's; the pipe tells when to end
    line = read_told()
    if not line:
        return 1
    try:
        run(line)
    except (SimConsoleError, OSError, MemoryError) as error:
        print(f"simconsole {role}: {one_line(error)}", file=sys.stderr)
        return SimConsoleError.exit_code
    return 0


def _run(line: bytes) -> None:
    call = msgspec.json.decode(line, type=WorkerCall)
    stop, folder = follow_parent(call.patience_s).wants_end, Path(call.folder)
    notices = NoticeWriter(folder, call.worker.name)
    log_notices(notices)
    try:
        load_worker(call.worker).run(folder, stop)
    except (SimConsoleError, OSError, MemoryError) as error:
        notices.tell("ERROR", one_line(error))
        raise


def main() -> int:
    """Be a worker; return the exit code."""
    return run_child("worker", _run)
