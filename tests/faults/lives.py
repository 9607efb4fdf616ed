"""Drives as programs, for tests of what outlives them: every process of one knows its mark, whoever its parent is."""

import os
import random
import re
import shutil
import signal
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from tests.drives.console import Running
from tests.patience import pause, wait_until

MARK: Final = "SIMCONSOLE_TEST_MARK"
TAKEN: Final = 1 << 14  # SIGTERM in a mask of /proc/PID/status
LEFT: Final = "simconsole-*"

DRIVEN = """schema: 1
title: "{title}"
environment: {{world: urban}}
scenario: {{vehicle: hatchback}}
features: {{autopilot: {autopilot}}}
outputs:
  bridge: {{port: {port}}}
  hud: {hud}
  scene: {scene}
  report: {report}
devices: {{driver: "script:asks.yaml"}}
mode: {{pacing: {pacing}, tick_hz: 250}}
"""
ASKS = "points:\n  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}\n" + "".join(
    f"  - {{time_s: {0.5 * half}, press: [autonomous]}}\n" for half in range(1, 240)
)
HUD, SCENE = "{width_px: 320, height_px: 240, rate_hz: 10}", "{rate_hz: 5, flush_s: 0.2}"


def write_session(
    folder: Path,
    port: int,
    *,
    autopilot: bool = True,
    pacing: str = "realtime",
    workers: bool = True,
    report: bool = True,
) -> Path:
    """A drive whose person asks for autonomy twice a second."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "asks.yaml").write_text(ASKS)
    text = DRIVEN.format(
        title=folder.name,
        autopilot="urban" if autopilot else "null",
        port=port,
        hud=HUD if workers and pacing == "realtime" else "null",
        scene=SCENE if workers else "null",
        report=str(report).lower(),
        pacing=pacing,
    )
    path = folder / "session.yaml"
    path.write_text(text)
    return path


def marked(mark: str) -> dict[int, str]:
    """Every living process with this mark in its environment, and its words."""
    found = {}
    for path in Path("/proc").glob("[0-9]*"):
        try:
            if f"{MARK}={mark}".encode() not in (path / "environ").read_bytes().split(b"\0"):
                continue
            state = (path / "stat").read_text().rpartition(")")[2].split()[0]
            words = (path / "cmdline").read_bytes().replace(b"\0", b" ").decode()
        except OSError:
            continue  # ended meanwhile, or somebody else's
        if state not in "ZX":
            found[int(path.name)] = words
    return found


def takes_signals(process: int) -> bool:
    """Whether a program has told the system what it does at SIGTERM: Python starts up before that."""
    try:
        status = Path(f"/proc/{process}/status").read_text()
    except OSError:
        return False
    caught = re.search(r"^SigCgt:\s*([0-9a-f]+)$", status, re.MULTILINE)
    return caught is not None and bool(int(caught[1], 16) & TAKEN)


def standard_input(process: int) -> str:
    """What a process reads: `pipe:[NUMBER]` for a pipe."""
    return str(Path(f"/proc/{process}/fd/0").readlink())


def holders(pipe: str) -> set[int]:
    """Every process that could write into a pipe."""
    found = set()
    for path in Path("/proc").glob("[0-9]*/fd/*"):
        try:
            if str(path.readlink()) == pipe and path.lstat().st_mode & 0o200:
                found.add(int(path.parts[2]))
        except OSError:
            continue
    return found


def with_temporary(temporary: Path) -> dict[str, str]:
    """The environment of a program whose temporary folder this is, for it alone.

    The library of the sound server makes a folder there, and leaves it, where nothing else is said and the one that
    this user has made before is gone: with that of another test, say.
    """
    return {"TMPDIR": str(temporary), "PULSE_RUNTIME_PATH": f"{temporary}-of-sound"}


class Life:
    """A drive with a temporary folder of its own, whose processes can be told from all others'."""

    def __init__(self, folder: Path, mark: str, temporary: Path, *words: object) -> None:
        temporary.mkdir(parents=True, exist_ok=True)
        self.mark = f"{mark}-{os.getpid()}"
        self.temporary = temporary
        # Whoever runs the tests may ignore hang-ups (nohup), and a program inherits that.
        before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
        self.running = Running(folder, *words, **{MARK: self.mark, **with_temporary(temporary)})
        signal.signal(signal.SIGHUP, before)
        self.core = self.running.process.pid

    def family(self) -> dict[int, str]:
        return marked(self.mark)

    def left(self) -> list[Path]:
        """What lies in the run and the temporary folder of this drive."""
        return [*Path("/dev/shm").glob(f"simconsole-{self.core}-*"), *self.temporary.iterdir()]

    def wait_for(self, word: str) -> int:
        """Wait until a process of this drive with `word` in its arguments runs; return it."""

        def find() -> int | None:
            code = self.running.process.poll()
            assert code is None, f"ended with {code}: {self.running.err.read_text()}"
            return next((pid for pid, words in self.family().items() if word in words), None)

        wait_until(find, word)
        found = find()
        assert found is not None
        return found

    def wait_for_nobody(self) -> None:
        """Wait until none of its processes lives."""
        wait_until(lambda: not self.family(), f"the end of {self.family()}")

    def close(self) -> None:
        for process in self.family():
            with_process(process)
        shutil.rmtree(self.temporary, ignore_errors=True)


def with_process(process: int) -> None:
    """Kill a process that a test has started, if it still lives."""
    try:
        os.kill(process, 9)
    except ProcessLookupError:
        return


@contextmanager
def living(folder: Path, mark: str, *words: object) -> Iterator[Life]:
    """Run a command; whatever of it still lives at the end is killed."""
    life = Life(folder, mark, folder / "tmp", *words)
    try:
        with life.running:
            yield life
    finally:
        life.close()


def wait_for_port(port: int) -> None:
    """Wait until nobody listens there."""

    def is_free() -> bool:
        with socket.socket() as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                return False
            return True

    wait_until(is_free, f"port {port}")


def random_pause(chance: random.Random, most_s: float) -> float:
    """Do nothing for a while that nobody knows beforehand; return how long."""
    length_s = chance.uniform(0.0, most_s)
    pause(length_s)
    return length_s
