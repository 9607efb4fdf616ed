import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from simconsole.processes.lifetimes import close_pipe, spawn
from simconsole.processes.notices import Notice, NoticeReader
from simconsole.processes.shared_memory import Ring, make_run_folder
from simconsole.processes.supervisor import SupervisorHandle, SupervisorSpec
from simconsole.processes.worker import WorkerSpec
from simconsole.values.errors import WorkerError
from simconsole.values.state_vector import Snapshot
from tests import patience

Wait = Callable[[Callable[[], object]], None]
IsRunning = Callable[[int], bool]

PATIENCE_S = 0.3

CORE = """
import sys, time
from pathlib import Path
import msgspec
import numpy as np
from simconsole.processes import shared_memory
from simconsole.processes.supervisor import SupervisorHandle
from simconsole.processes.worker import WorkerSpec
base, specs = Path(sys.argv[1]), msgspec.json.decode(sys.argv[2], type=list[WorkerSpec])
shared_memory._base = lambda: base
folder = shared_memory.make_run_folder()
ring = shared_memory.Ring.create(folder / "snapshots", 8, 64)
supervisor = SupervisorHandle(folder, specs, patience_s=0.3)
supervisor.start()
print(folder, supervisor._process.pid, flush=True)
while True:
    ring.write(np.full(8, ring.newest + 1.0), ring.newest + 1)
    time.sleep(0.001)
"""


def said(folder: Path, name: str) -> dict[str, Any] | None:
    """What the worker of this name last said of itself."""
    try:
        found: dict[str, Any] = json.loads((folder / f"{name}.json").read_text())
    except FileNotFoundError:
        return None
    return found


def worker(programs: str, name: str, kind: str = "Beat", **fields: object) -> WorkerSpec:
    configuration = msgspec.Raw(msgspec.json.encode({"name": name, **fields}))
    return WorkerSpec(name=name, target=f"{programs}:{kind}", configuration=configuration)


@pytest.fixture
def start(run_base: Path) -> Iterator[Callable[..., SupervisorHandle]]:
    """Start workers in a run folder; ended with the test."""
    started: list[SupervisorHandle] = []

    def start(*specs: WorkerSpec, folder: Path | None = None, patience_s: float = PATIENCE_S) -> SupervisorHandle:
        started.append(SupervisorHandle(folder or make_run_folder(), specs, patience_s))
        started[-1].start()
        return started[-1]

    yield start
    for supervisor in started:
        supervisor.stop()
    assert list(run_base.iterdir()) == []


def test_workers_run_in_their_own_processes_and_end_in_order(
    start: Callable[..., SupervisorHandle], programs: str, tmp_path: Path, wait_until: Wait, is_running: IsRunning
) -> None:
    goodbye = tmp_path / "goodbye"
    specs = (worker(programs, "one", goodbye=str(goodbye)), worker(programs, "two", port=9090))
    supervisor = start(*specs, patience_s=patience.PATIENCE_S)
    wait_until(lambda: said(supervisor.folder, "one") and said(supervisor.folder, "two"))
    one, two = said(supervisor.folder, "one"), said(supervisor.folder, "two")
    assert one is not None
    assert two is not None
    assert len({one["pid"], two["pid"], os.getpid()}) == 3
    assert two["configuration"] == {"name": "two", "goodbye": None, "port": 9090}
    assert supervisor.alive()
    wait_until(lambda: len(supervisor.status()) == 2)
    assert supervisor.status()["one"].process_id == one["pid"]
    supervisor.stop()
    assert goodbye.read_text() == "ended in order"
    assert not is_running(one["pid"])
    assert not is_running(two["pid"])
    assert not supervisor.folder.exists()
    assert not supervisor.alive()
    assert supervisor.counters() == {"one": 0, "two": 0}  # still known for the summary
    supervisor.stop()


def test_ctrl_c_is_the_cores(start: Callable[..., SupervisorHandle], programs: str, wait_until: Wait) -> None:
    supervisor = start(worker(programs, "one"))
    wait_until(lambda: said(supervisor.folder, "one"))
    one = said(supervisor.folder, "one")
    assert one is not None
    assert one["interrupt_ignored"]
    assert one["group"] != os.getpgid(0)  # a terminal sends its Ctrl-C to the core's group only


def test_workers_have_the_environment_from_before_the_cores_own_settings(
    run_base: Path, programs: str, wait_until: Wait, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("SDL_VIDEODRIVER", raising=False)
    monkeypatch.setenv("EXTRA", "from the core")
    given = with_environment(worker(programs, "given"), {"SDL_VIDEODRIVER": "offscreen", "EXTRA": None})
    supervisor = SupervisorHandle(make_run_folder(), [worker(programs, "plain"), given])
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")  # as the core sets for its joysticks
    supervisor.start()
    try:
        wait_until(lambda: said(supervisor.folder, "plain") and said(supervisor.folder, "given"))
        found = {name: said(supervisor.folder, name) or {} for name in ("plain", "given")}
        assert (found["plain"]["sdl"], found["plain"]["extra"]) == (None, "from the core")
        assert (found["given"]["sdl"], found["given"]["extra"]) == ("offscreen", None)
    finally:
        supervisor.stop()


def with_environment(spec: WorkerSpec, environment: dict[str, str | None]) -> WorkerSpec:
    return msgspec.structs.replace(spec, environment=environment)


def test_nothing_is_imported_from_the_working_directory(
    start: Callable[..., SupervisorHandle],
    programs: str,
    tmp_path: Path,
    wait_until: Wait,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (tmp_path / "cwd").mkdir()
    (tmp_path / "cwd" / "msgspec.py").write_text("raise SystemExit('a file of the user was run')")
    monkeypatch.chdir(tmp_path / "cwd")
    supervisor = start(worker(programs, "one"))
    wait_until(lambda: said(supervisor.folder, "one"))
    assert supervisor.counters() == {"one": 0}


def test_a_killed_worker_is_restarted_while_the_core_goes_on(
    start: Callable[..., SupervisorHandle], programs: str, wait_until: Wait
) -> None:
    folder = make_run_folder()
    ring = Ring.create(folder / "snapshots", 8, 64)
    supervisor = start(worker(programs, "quiet"), worker(programs, "reader", "Follow"), folder=folder)

    def drive_until(condition: Callable[[], object]) -> None:
        def tick() -> object:
            ring.write(np.full(8, float(ring.newest + 1)), ring.newest + 1)
            supervisor.publish(Snapshot(ring.newest, 250, np.empty(0)))
            return condition()

        wait_until(tick)

    drive_until(lambda: said(supervisor.folder, "reader") and said(supervisor.folder, "quiet"))
    quiet = said(supervisor.folder, "quiet")
    for _ in range(2):
        before = said(supervisor.folder, "reader")
        assert before is not None
        os.kill(before["pid"], signal.SIGKILL)
        drive_until(lambda: (said(supervisor.folder, "reader") or before)["pid"] != before["pid"])  # noqa: B023
    drive_until(lambda: supervisor.counters().get("reader", 0) >= 2)
    assert said(supervisor.folder, "quiet") == quiet
    assert supervisor.counters()["quiet"] == 0
    assert supervisor.supervisor_restarts == 0
    assert not (supervisor.folder / "torn").exists()


def test_a_worker_that_keeps_failing_is_counted_and_holds_up_nobody(
    start: Callable[..., SupervisorHandle], programs: str, wait_until: Wait, capfd: pytest.CaptureFixture[str]
) -> None:
    missing = worker(programs, "missing", "NoSuchWorker")
    supervisor = start(worker(programs, "crash", "Crash"), missing, worker(programs, "good"))
    wait_until(lambda: supervisor.counters().get("crash", 0) >= 2 and supervisor.counters().get("missing", 0) >= 2)
    wait_until(lambda: said(supervisor.folder, "good"))
    assert supervisor.counters()["good"] == 0
    supervisor.stop()
    errors = capfd.readouterr().err
    assert "simconsole worker: worker missing: worker_test_programs:NoSuchWorker cannot be loaded" in errors
    assert "RuntimeError: as asked" in errors
    assert "Fatal Python error" not in errors


def test_a_killed_supervisor_is_replaced_and_nothing_of_it_stays(
    start: Callable[..., SupervisorHandle], programs: str, wait_until: Wait, is_running: IsRunning
) -> None:
    supervisor = start(worker(programs, "one"), worker(programs, "stuck", "Stuck"))
    wait_until(lambda: said(supervisor.folder, "one") and said(supervisor.folder, "stuck"))
    before = [(said(supervisor.folder, name) or {})["pid"] for name in ("one", "stuck")]
    supervise = supervisor._process
    assert supervise is not None
    supervise.kill()
    wait_until(lambda: not supervisor.alive())
    supervisor.look()
    assert supervisor.alive()
    assert supervisor.supervisor_restarts == 1
    wait_until(lambda: not any(is_running(process_id) for process_id in before))
    wait_until(lambda: (said(supervisor.folder, "one") or {})["pid"] not in before)


def test_a_supervisor_that_cannot_be_started_again_does_not_end_the_drive(
    start: Callable[..., SupervisorHandle], programs: str, wait_until: Wait, monkeypatch: pytest.MonkeyPatch
) -> None:
    supervisor = start(worker(programs, "one"))
    assert supervisor._process is not None
    supervisor._process.kill()
    wait_until(lambda: not supervisor.alive())
    with monkeypatch.context() as patch:
        patch.setattr(sys, "executable", "/nowhere/python")
        supervisor.look()
        assert not supervisor.alive()
    supervisor.look()
    assert supervisor.alive()


def test_a_worker_that_will_not_end_is_killed(
    start: Callable[..., SupervisorHandle], programs: str, wait_until: Wait, is_running: IsRunning
) -> None:
    supervisor = start(worker(programs, "stuck", "Stuck"), worker(programs, "stopped"))
    wait_until(lambda: said(supervisor.folder, "stuck") and said(supervisor.folder, "stopped"))
    pids = [(said(supervisor.folder, name) or {})["pid"] for name in ("stuck", "stopped")]
    os.kill(pids[1], signal.SIGSTOP)
    supervisor.stop()
    assert not any(is_running(process_id) for process_id in pids)


def test_an_interpreter_that_is_not_there_is_one_line(run_base: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    supervisor = SupervisorHandle(make_run_folder(), [])
    with pytest.raises(WorkerError, match="supervisor: cannot be started: No such file"):
        supervisor.start()


@pytest.mark.parametrize("kind", ["Beat", "Follow", "Stuck"])
def test_killing_the_core_leaves_no_process_mapping_or_file(
    run_base: Path, programs: str, wait_until: Wait, is_running: IsRunning, kind: str
) -> None:
    specs = [worker(programs, name, kind) for name in ("one", "two")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    core = subprocess.Popen(
        [sys.executable, "-c", CORE, str(run_base), msgspec.json.encode(specs).decode()],
        stdout=subprocess.PIPE,
        env=environment,
    )
    assert core.stdout is not None
    try:
        folder_name, supervise = core.stdout.readline().decode().rsplit(" ", 1)
        folder = Path(folder_name)
        wait_until(lambda: said(folder, "one") and said(folder, "two"))
        processes = [int(supervise), *((said(folder, name) or {})["pid"] for name in ("one", "two"))]
        assert all(is_running(process_id) for process_id in processes)
    finally:
        core.kill()
        core.wait()
        core.stdout.close()
    wait_until(lambda: not any(is_running(process_id) for process_id in processes))
    assert list(run_base.iterdir()) == []
    assert mappings_of(folder) == []


BUSY = """
import threading
from simconsole.processes import supervisor
supervisor.end = lambda *arguments: threading.Event().wait()  # a machine so busy that it does not come to the end
supervisor.main()
"""


def test_a_supervisor_that_runs_out_of_time_removes_the_run_folder(run_base: Path) -> None:
    folder = make_run_folder()
    (folder / "file").write_text("shared")
    told = msgspec.json.encode(SupervisorSpec(folder=str(folder), workers=[], patience_s=0.3)) + b"\n"
    process = spawn(["-c", BUSY], told=told)
    close_pipe(process)
    assert process.wait(patience.PATIENCE_S) == 1
    assert list(run_base.iterdir()) == []


def test_killing_core_and_supervisor_at_once_leaves_no_process_and_the_next_start_no_file(
    run_base: Path, programs: str, wait_until: Wait, is_running: IsRunning
) -> None:
    specs = [worker(programs, "one", "Stuck")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    core = subprocess.Popen(
        [sys.executable, "-c", CORE, str(run_base), msgspec.json.encode(specs).decode()],
        stdout=subprocess.PIPE,
        env=environment,
    )
    assert core.stdout is not None
    try:
        folder_name, supervise = core.stdout.readline().decode().rsplit(" ", 1)
        wait_until(lambda: said(Path(folder_name), "one"))
        one = (said(Path(folder_name), "one") or {})["pid"]
    finally:
        os.kill(int(supervise), signal.SIGKILL)
        core.kill()
        core.wait()
        core.stdout.close()
    wait_until(lambda: not is_running(one) and not is_running(int(supervise)))
    own = make_run_folder()
    assert list(run_base.iterdir()) == [own]
    own.rmdir()


def mappings_of(folder: Path) -> list[str]:
    """Processes that still map a file of `folder`."""
    found = []
    for maps in Path("/proc").glob("[0-9]*/maps"):
        try:
            if str(folder) in maps.read_text():
                found.append(str(maps))
        except OSError:
            continue
    return found


def test_that_a_worker_was_started_again_is_told_with_how_it_ended(
    start: Callable[..., SupervisorHandle], programs: str, wait_until: Wait
) -> None:
    supervisor = start(worker(programs, "one"))
    wait_until(lambda: said(supervisor.folder, "one"))
    reader = NoticeReader(supervisor.folder)
    assert reader.take() == []
    os.kill((said(supervisor.folder, "one") or {})["pid"], signal.SIGKILL)
    told: list[Notice] = []

    def heard() -> bool:
        told.extend(reader.take())
        return bool(told)

    wait_until(heard)
    assert told == [Notice("WARN", "supervisor: the one worker has ended (signal 9) and is started again")]
