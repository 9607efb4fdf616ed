"""Progress, on a terminal only."""

import os
import pty
import subprocess
from pathlib import Path

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
