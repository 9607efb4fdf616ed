"""Progress: on a terminal, or by -v."""

import io
import os
import pty
import subprocess
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from simconsole.cli.progress import TICKS_BETWEEN_LOOKS, Progress
from simconsole.cli.terminal.talk import Talk, talking
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from tests.drives.console import environment, words
from tests.patience import PATIENCE_S


def test_on_a_terminal_progress_is_shown_and_wiped(plain: Path, tmp_path: Path, script: Path) -> None:
    terminal, theirs = pty.openpty()
    drive = words("drive", plain, "--driver", f"script:{script}", "--for", 20, "--out", tmp_path / "bundle")
    with subprocess.Popen(drive, stdout=subprocess.DEVNULL, stderr=theirs, env=environment()) as process:
        os.close(theirs)
        shown = b""
        while True:
            try:
                part = os.read(terminal, 4096)
            except OSError:  # the other end is closed
                break
            if not part:
                break
            shown += part
        assert process.wait(PATIENCE_S) == 0
    os.close(terminal)
    assert b"\r\x1b[Kdriving ..." in shown
    assert b" km/h " in shown
    assert shown.endswith(b"\r\x1b[K"), "nothing of it stays"


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def snapshot(tick: int, **arbitration: float) -> Snapshot:
    row = np.zeros(PLATFORM_AT)
    row[LAYOUT.vehicle.at("vx_mps")] = 10.0
    row[LAYOUT.vehicle.at("distance_m")] = 120.0
    for name, value in arbitration.items():
        row[LAYOUT.arbitration.at(name)] = value
    return Snapshot(tick, 250, row)


def test_a_line_tells_way_speed_and_mode(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    now_s = iter((100.0, 110.0, 110.0))
    monkeypatch.setattr("simconsole.cli.progress.time", SimpleNamespace(monotonic=lambda: next(now_s)))
    with Progress("driving", 3000.0) as progress:
        progress.show(snapshot(TICKS_BETWEEN_LOOKS - 1, mode=float(Mode.MANUAL)))
        assert terminal.getvalue() == "\r\x1b[Kdriving ..."
        progress.show(snapshot(TICKS_BETWEEN_LOOKS * 125, mode=float(Mode.MANUAL)))
    shown = terminal.getvalue().split("\r\x1b[K")[2:]
    mode = mode_label(float(Mode.MANUAL))
    assert shown[0] == f"driving:    32.0 s    120.0 m of 3000 m   36.0 km/h  {mode}  4%, 4:00 left"
    assert shown[-1] == ""


def test_a_drive_that_ends_before_its_route_is_measured_by_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    now_s = iter((100.0, 110.0, 110.0))
    monkeypatch.setattr("simconsole.cli.progress.time", SimpleNamespace(monotonic=lambda: next(now_s)))
    with Progress("driving", 3000.0, 64.0) as progress:
        progress.show(snapshot(TICKS_BETWEEN_LOOKS * 125, mode=float(Mode.MANUAL)))
    assert terminal.getvalue().split("\r\x1b[K")[2].endswith("  50%, 0:10 left")


def test_a_line_tells_how_much_of_each_thing_is_done(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    now_s = iter((0.0, 20.0, 4000.0, 4000.1))
    monkeypatch.setattr("simconsole.cli.progress.time", SimpleNamespace(monotonic=lambda: next(now_s)))
    monkeypatch.setattr(Progress, "_is_due", lambda self: True)
    with Progress("writing") as progress:
        progress.done("scene", 0.25)
        progress.done("report", 0.5)
    assert terminal.getvalue().split("\r\x1b[K")[2:] == [
        "writing: scene 25%, 1:00 left",
        "writing: report 50%, scene 25%, 3:20:00 left",
        "",
    ]


def test_with_v_a_pipe_gets_each_step_and_its_time_and_with_quiet_a_terminal_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now_s = iter((0.0, 2.5, 3.0))
    monkeypatch.setattr("simconsole.cli.progress.time", SimpleNamespace(monotonic=lambda: next(now_s)))
    pipe, terminal = io.StringIO(), Terminal()
    monkeypatch.setattr("sys.stderr", pipe)
    with talking(Talk.VERBOSE), Progress("packing"):
        pass
    assert pipe.getvalue() == "simconsole: packing ...\nsimconsole: packing: 2.5 s\n"
    monkeypatch.setattr("sys.stderr", terminal)
    with talking(Talk.QUIET), Progress("packing") as progress:
        progress.done("log", 0.5)
    assert terminal.getvalue() == ""


def test_on_a_pipe_there_is_nothing_and_a_closed_terminal_ends_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    pipe = io.StringIO()
    monkeypatch.setattr("sys.stderr", pipe)
    with Progress("driving") as progress:
        progress.show(snapshot(TICKS_BETWEEN_LOOKS))
    assert pipe.getvalue() == ""

    def closed(text: str) -> int:
        raise OSError("terminal is gone")

    terminal = Terminal()
    monkeypatch.setattr(terminal, "write", closed)
    monkeypatch.setattr("sys.stderr", terminal)
    with Progress("driving") as progress:
        progress.show(snapshot(TICKS_BETWEEN_LOOKS))


def test_ticks_are_counted_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    with Progress("exporting") as progress:
        progress.count(300, 1000)
        progress.count(600, 1000)  # too soon after the last
    assert "exporting: 300 ticks of 1000" in terminal.getvalue()
    assert "600" not in terminal.getvalue()
    with Progress("importing") as progress:
        progress.count(7)
    assert terminal.getvalue().endswith("importing: 7 ticks\r\x1b[K")


def test_a_line_that_stays_takes_the_place_of_the_one_that_is_written_over(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    with Progress("sweep") as progress:
        progress.say("it waits")
    assert terminal.getvalue() == "\r\x1b[Ksweep ...\r\x1b[Ksimconsole: it waits\n\r\x1b[K"
