from collections.abc import Callable
from pathlib import Path

import pytest

from tests import patience

PROGRAMS = '''
import json, os, signal, time
from pathlib import Path

import msgspec

from simconsole.processes.worker import Worker


class Beat(Worker, frozen=True, kw_only=True):
    """Say who runs, then live until told to end."""

    name: str
    goodbye: str | None = None
    port: int | None = None

    def run(self, folder, stop):
        part = folder / f"{self.name}.part"
        part.write_text(json.dumps({
            "pid": os.getpid(), "parent": os.getppid(), "configuration": msgspec.to_builtins(self),
            "sdl": os.environ.get("SDL_VIDEODRIVER"), "extra": os.environ.get("EXTRA"),
            "interrupt_ignored": signal.getsignal(signal.SIGINT) == signal.SIG_IGN,
            "group": os.getpgid(0),
        }))
        part.replace(folder / f"{self.name}.json")
        while not stop():
            time.sleep(0.01)
        if self.goodbye is not None:
            Path(self.goodbye).write_text("ended in order")


class Stuck(Beat, frozen=True, kw_only=True):
    """Never look at stop again."""

    def run(self, folder, stop):
        super().run(folder, lambda: True)
        while True:
            time.sleep(60.0)


class Crash(Beat, frozen=True, kw_only=True):
    def run(self, folder, stop):
        super().run(folder, lambda: True)
        raise RuntimeError("as asked")


class Follow(Beat, frozen=True, kw_only=True):
    """Read a ring until told to end; write how far and how whole."""

    def run(self, folder, stop):
        from simconsole.processes.shared_memory import Ring
        ring = Ring.open(folder / "snapshots")
        super().run(folder, lambda: True)
        while not stop():
            record = ring.latest()
            if record is not None and (record.values != record.number).any():
                (folder / "torn").write_text(str(record))
            time.sleep(0.001)
'''


@pytest.fixture
def programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Name of a module with kinds of workers that processes of this test can import."""
    (tmp_path / "programs").mkdir()
    (tmp_path / "programs" / "worker_test_programs.py").write_text(PROGRAMS)
    monkeypatch.syspath_prepend(tmp_path / "programs")
    return "worker_test_programs"


@pytest.fixture
def wait_until() -> Callable[[Callable[[], object]], None]:
    """Poll until a condition holds."""

    def wait(condition: Callable[[], object]) -> None:
        patience.wait_until(condition, "what the test waits for")

    return wait


def running(process_id: int) -> bool:
    """Whether a process exists and is more than an unburied zombie."""
    try:
        stat = Path(f"/proc/{process_id}/stat").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False
    return stat.rpartition(")")[2].split()[0] not in {"Z", "X"}


@pytest.fixture
def is_running() -> Callable[[int], bool]:
    return running


@pytest.fixture
def run_base(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of this test's own in place of /dev/shm."""
    base = tmp_path / "shm"
    base.mkdir()
    monkeypatch.setattr("simconsole.processes.shared_memory._base", lambda: base)
    return base
