"""A real X server without a screen (Xvfb), and a person's hands on its keyboard (xdotool)."""

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from tests.patience import PATIENCE_S

SIZE: Final = (1366, 768)


@contextmanager
def x_server(size: tuple[int, int] = SIZE) -> Iterator[str]:
    """Run a server with one display of this size; yield its name for DISPLAY."""
    reading, writing = os.pipe()
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", f"{size[0]}x{size[1]}x24", "-nolisten", "tcp"]
    command += ["-noreset"]  # a desktop stays when its last window closes; a reset would refuse one that just opens
    server = subprocess.Popen(command, pass_fds=[writing], stderr=subprocess.DEVNULL)
    os.close(writing)
    try:
        with os.fdopen(reading) as file:
            number = file.readline().strip()
        assert number, "Xvfb did not start"
        yield f":{number}"
    finally:
        server.terminate()
        server.wait(PATIENCE_S)


def hands(display: str, *words: str, sure: bool = True) -> str:
    """Do something at the keyboard, as xdotool calls it; return what it prints; unless `sure`, it may fail."""
    environment = {**os.environ, "DISPLAY": display}
    return subprocess.run(
        ["xdotool", *words], env=environment, capture_output=True, text=True, check=sure, timeout=PATIENCE_S
    ).stdout
