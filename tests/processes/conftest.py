from collections.abc import Callable
from pathlib import Path

import pytest

from tests import patience

PROGRAMS = '''
import json, os, signal, time
from pathlib import Path


def beat(folder, arguments, stop):
    """Say who runs, then live until told to end."""
    part = folder / f"{arguments['name']}.part"
    part.write_text(json.dumps({
        "pid": os.getpid(), "parent": os.getppid(), "arguments": arguments,
        "sdl": os.environ.get("SDL_VIDEODRIVER"), "extra": os.environ.get("EXTRA"),
        "interrupt_ignored": signal.getsignal(signal.SIGINT) == signal.SIG_IGN,
        "group": os.getpgid(0),
    }))
    part.replace(folder / f"{arguments['name']}.json")
    while not stop():
        time.sleep(0.01)
    if "goodbye" in arguments:
        Path(arguments["goodbye"]).write_text("ended in order")


def stuck(folder, arguments, stop):
    """Never look at stop again."""
    beat(folder, arguments, lambda: True)
    while True:
        time.sleep(60.0)


def crash(folder, arguments, stop):
    beat(folder, arguments, lambda: True)
    raise RuntimeError("as asked")


def follow(folder, arguments, stop):
    """Read a ring until told to end; write how far and how whole."""
    from simconsole.processes.shared_memory import Ring
    ring = Ring.open(folder / "snapshots")
    beat(folder, arguments, lambda: True)
    while not stop():
        record = ring.latest()
        if record is not None and (record.values != record.number).any():
            (folder / "torn").write_text(str(record))
        time.sleep(0.001)
'''


@pytest.fixture
def programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Name of a module of worker functions that workers of this test can import."""
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
