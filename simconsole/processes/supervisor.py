"""Workers: the processes around the core, and the supervisor that keeps them.

The core starts one process, the supervisor. The supervisor starts every worker and restarts those that die. When the
core tells it to end, or is gone, however it ended (lifetimes.py), it ends them all and removes the run folder. So a
restart never costs the tick loop a fork, and nothing outlives the core: a worker whose supervisor is gone ends by
itself.

::

    core ──stdin──> supervisor ──stdin──> bridge, hud, scene

Run as `python -m simconsole.processes supervisor`, with a `SupervisorSpec` as one line of JSON on standard input.
"""

import os
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final

import msgspec

from simconsole.processes.lifetimes import ORPHAN_S, close_pipe, end, follow_parent, spawn, undone
from simconsole.processes.notices import NoticeWriter
from simconsole.processes.shared_memory import remove_run_folder
from simconsole.processes.worker import WorkerCall, WorkerSpec, run_child
from simconsole.values.errors import WorkerError
from simconsole.values.host.files import write_atomically
from simconsole.values.state_vector import Snapshot

POLL_S: Final = 0.05
BACK_OFF_S: Final = (0.05, 0.2, 1.0, 5.0)
"""Wait before a restart, by how many came before it within HEALTHY_S; the last one goes on."""
HEALTHY_S: Final = 10.0
PATIENCE_S: Final = 3.0
"""How long a worker may take to end before it is killed; a scene has a file to finish."""
SUPERVISOR_END_S: Final = 2.5 * ORPHAN_S
"""How long a supervisor whose core is gone may take to end its workers and to remove the run folder."""
LOOKS_PER_S: Final = 5
STATUS: Final = "workers.json"


class SupervisorSpec(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What the supervisor looks after."""

    folder: str
    workers: list[WorkerSpec]
    patience_s: float


class WorkerStatus(msgspec.Struct, frozen=True, kw_only=True):
    """What the supervisor says of one worker."""

    process_id: int
    restarts: int


class SupervisorHandle:
    """The core's side: starts the supervisor, looks after it without ever waiting, ends it."""

    def __init__(self, folder: Path, workers: Sequence[WorkerSpec], patience_s: float = PATIENCE_S) -> None:
        self.folder = folder
        self._spec = SupervisorSpec(folder=str(folder), workers=list(workers), patience_s=patience_s)
        # Taken now: SDL's settings for the core, made later, are not the workers'.
        self._environment = dict(os.environ)
        self._process: subprocess.Popen[bytes] | None = None
        self._last_status: dict[str, WorkerStatus] = {}
        self.supervisor_restarts = 0

    def start(self) -> None:
        """Start the supervisor, which starts the workers.

        Raises:
            WorkerError: it cannot be started.
        """
        self._process = _spawn("supervisor", self._spec, self._environment)

    def publish(self, snapshot: Snapshot) -> None:
        """As a reader of snapshots: a few times a second, see that the supervisor lives, or start another."""
        if snapshot.tick % max(1, snapshot.tick_hz // LOOKS_PER_S) == 0:
            self.look()

    def look(self) -> None:
        """Start another supervisor if this one died. Its workers have ended by themselves."""
        if self._process is None or self._process.poll() is None:
            return
        self.supervisor_restarts += 1
        close_pipe(self._process)
        try:
            self.start()
        except WorkerError:
            return  # the next look tries again: a drive does not end for its spectators

    def alive(self) -> bool:
        """Return whether the supervisor runs."""
        return self._process is not None and self._process.poll() is None

    def status(self) -> dict[str, WorkerStatus]:
        """Return what the supervisor last said of the workers, by name; empty before it has. Good after `stop` too."""
        try:
            return msgspec.json.decode((self.folder / STATUS).read_bytes(), type=dict[str, WorkerStatus])
        except (OSError, msgspec.DecodeError):
            return self._last_status

    def counters(self) -> dict[str, int]:
        """Return how often each worker was restarted, for the summary."""
        return {name: status.restarts for name, status in self.status().items()}

    def stop(self, at_once: Callable[[], bool] = lambda: False) -> None:
        """End supervisor and workers; afterwards the run folder is gone. Twice is harmless.

        Where `at_once()` says so they have nothing to finish, and ORPHAN_S instead of their patience.
        """
        process, self._process = self._process, None
        if process is None:
            return
        self._last_status = self.status()
        end([process], self._spec.patience_s * 2, at_once, SUPERVISOR_END_S)
        remove_run_folder(self.folder)


class _KeptWorker:
    """One worker as the supervisor sees it."""

    def __init__(self, spec: WorkerSpec, supervisor: SupervisorSpec, notices: NoticeWriter) -> None:
        self.spec = spec
        self._notices = notices
        self._call = WorkerCall(folder=supervisor.folder, worker=spec, patience_s=supervisor.patience_s)
        self.process: subprocess.Popen[bytes] | None = None
        self.restarts = 0
        self._failures = 0
        self._started_s = 0.0
        self._next_s = 0.0

    def look(self, now_s: float) -> bool:
        """Start the worker if it should run and does not; return whether something changed."""
        if self.process is None:
            if now_s < self._next_s:
                return False
            environment = _laid_over(os.environ, self.spec.environment)
            self._started_s = now_s
            try:
                self.process = _spawn("worker", self._call, environment)
            except WorkerError:
                self._back_off(now_s)
            return True
        if (code := self.process.poll()) is None:
            return False
        how = f"signal {-code}" if code < 0 else f"exit code {code}"
        self._notices.tell("WARN", f"the {self.spec.name} worker has ended ({how}) and is started again")
        close_pipe(self.process)
        self.process = None
        self._back_off(now_s)
        return True

    def _back_off(self, now_s: float) -> None:
        if now_s - self._started_s > HEALTHY_S:
            self._failures = 0
        self._next_s = now_s + BACK_OFF_S[min(self._failures, len(BACK_OFF_S) - 1)]
        self._failures += 1
        self.restarts += 1


def supervise(spec: SupervisorSpec, stop: Callable[[], bool], hurry: Callable[[], bool]) -> None:
    """Keep the workers of `spec` running until `stop`; then end them, soon with `hurry`, and remove the run folder."""
    notices = NoticeWriter(Path(spec.folder), "supervisor")
    kept = [_KeptWorker(worker, spec, notices) for worker in spec.workers]
    try:
        while not stop():
            changed = [worker.look(time.monotonic()) for worker in kept]
            if any(changed):
                _write_status(Path(spec.folder), kept)
            time.sleep(POLL_S)
    finally:
        end([worker.process for worker in kept if worker.process is not None], spec.patience_s, hurry)
        if stop():  # else this supervisor broke, and the core's next one needs the folder
            remove_run_folder(Path(spec.folder))


def _write_status(folder: Path, kept: list[_KeptWorker]) -> None:
    status = {
        worker.spec.name: WorkerStatus(
            process_id=0 if worker.process is None else worker.process.pid, restarts=worker.restarts
        )
        for worker in kept
    }
    try:
        write_atomically(folder / STATUS, msgspec.json.encode(status), durable=False)
    except OSError:
        return  # the folder is gone: the core has ended and the pipe will say so


def _spawn(role: str, spec: object, environment: Mapping[str, str]) -> "subprocess.Popen[bytes]":
    try:
        told = msgspec.json.encode(spec) + b"\n"
        return spawn(["-m", "simconsole.processes", role], told=told, environment=environment)
    except OSError as error:
        raise WorkerError(f"{role}: cannot be started: {error.strerror}") from None


def _laid_over(environment: Mapping[str, str], changes: Mapping[str, str | None]) -> dict[str, str]:
    merged = {**environment, **{name: value for name, value in changes.items() if value is not None}}
    for name, value in changes.items():
        if value is None:
            merged.pop(name, None)
    return merged


def _run(line: bytes) -> None:
    spec = msgspec.json.decode(line, type=SupervisorSpec)
    with undone(lambda: remove_run_folder(Path(spec.folder))):  # on a busy machine its time may be too short
        core = follow_parent(None, SUPERVISOR_END_S)
        supervise(spec, core.wants_end, core.is_gone)


def main() -> int:
    """Be the supervisor; return the exit code."""
    return run_child("supervisor", _run)
