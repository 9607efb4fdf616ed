"""Keys without Enter on a real terminal: a pseudo-terminal's other end types."""

import os
import pty
import sys
import termios

import pytest

from simconsole.devices.setup.key_watch import KeyWatch
from tests.patience import wait_until


def test_any_key_counts_and_the_terminal_is_as_before(monkeypatch: pytest.MonkeyPatch) -> None:
    typist, terminal = pty.openpty()
    with os.fdopen(terminal, "r", buffering=1) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        before = termios.tcgetattr(terminal)
        with KeyWatch() as keys:
            assert not keys.pressed()
            os.write(typist, b"x")
            wait_until(keys.pressed, "the key")
            assert not keys.pressed()
            assert not termios.tcgetattr(terminal)[3] & termios.ICANON
        assert termios.tcgetattr(terminal) == before
    os.close(typist)


def test_without_a_terminal_nothing_is_ever_pressed(monkeypatch: pytest.MonkeyPatch) -> None:
    with open(os.devnull) as nothing:  # noqa: PTH123
        monkeypatch.setattr(sys, "stdin", nothing)
        with KeyWatch() as keys:
            assert not keys.pressed()
