"""Runs simconsole as people do: as a program, from the command line; or without a program."""

import contextlib
import io
import json
import logging
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from simconsole.cli.main import main
from tests.patience import PATIENCE_S


def words(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "simconsole", *map(str, arguments)]


def environment(**changes: str) -> dict[str, str]:
    """The environment of a machine with no display."""
    kept = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return {**kept, "SDL_VIDEODRIVER": "dummy", **changes}


def simconsole(*arguments: object, **changes: str) -> "subprocess.CompletedProcess[str]":
    """Run one command to its end, with pipes for its output."""
    return patient(PATIENCE_S, *arguments, **changes)


def patient(patience_s: float, *arguments: object, **changes: str) -> "subprocess.CompletedProcess[str]":
    """The same of a command that has much to do."""
    return subprocess.run(
        words(*arguments), capture_output=True, text=True, timeout=patience_s, env=environment(**changes), check=False
    )


def within(*arguments: object) -> "subprocess.CompletedProcess[str]":
    """Run one command in this process, for what it refuses at once: no program has to start, and load all libraries.

    What is logged goes where a program's goes. A wrong command line raises `SystemExit`.
    """
    out, err = io.StringIO(), io.StringIO()
    texts, root = [*map(str, arguments)], logging.getLogger()
    handlers, root.handlers[:] = root.handlers[:], [logging.StreamHandler(err)]
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main(texts)
    finally:
        root.handlers[:] = handlers
    return subprocess.CompletedProcess(texts, code, out.getvalue(), err.getvalue())


def results(done: "subprocess.CompletedProcess[str]") -> dict[str, Any]:
    """What `--json` printed: nothing else is on standard output."""
    found = json.loads(done.stdout)
    assert isinstance(found, dict)
    return found


def complaint(done: "subprocess.CompletedProcess[str]") -> str:
    """The one line of a command that refused: code 2, nothing but that line, no traceback."""
    assert done.returncode == 2, done.stdout + done.stderr
    assert done.stdout == ""
    lines = done.stderr.splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("simconsole ")
    return lines[0]


class Running:
    """A command that runs meanwhile, in a process group of its own; its output goes to files."""

    def __init__(self, folder: Path, *arguments: object, **changes: str) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.out, self.err = folder / "stdout", folder / "stderr"
        with self.out.open("wb") as out, self.err.open("wb") as err:
            self.process = subprocess.Popen(
                words(*arguments), stdout=out, stderr=err, env=environment(**changes), process_group=0
            )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def interrupt_group(self) -> None:
        """What a terminal does at Ctrl-C."""
        os.killpg(self.process.pid, signal.SIGINT)

    def said(self, text: str) -> bool:
        """Whether it has said so; one that has ended without is no longer waited for."""
        running = self.process.poll() is None
        found = text in self.out.read_text("utf-8") + self.err.read_text("utf-8")
        assert found or running, self.err.read_text("utf-8")
        return found

    def end(self) -> "subprocess.CompletedProcess[str]":
        """Wait for its end and return it as `simconsole` does."""
        code = self.process.wait(PATIENCE_S)
        return subprocess.CompletedProcess(
            self.process.args, code, self.out.read_text("utf-8"), self.err.read_text("utf-8")
        )
