"""Whether a key was pressed in the terminal, without waiting for one; and questions that are answered by a line."""

import sys
from typing import Any, Self


class KeyWatch:
    """The terminal while something moves: any key counts, without Enter. Use as a context manager.

    Where standard input is no terminal no key is ever pressed.
    """

    def __init__(self) -> None:
        self._terminal = sys.stdin.isatty()
        self._before: list[Any] | None = None

    def __enter__(self) -> Self:
        self._key_mode()
        return self

    def __exit__(self, *error: object) -> None:
        self._line_mode()

    def ask(self, question: str) -> str:
        """Put a question and return the line that was typed."""
        self._line_mode()
        try:
            return input(question)
        finally:
            self._key_mode()

    @property
    def is_terminal(self) -> bool:
        """Whether somebody can press a key at all."""
        return self._terminal

    def pressed(self) -> bool:
        """Return whether a key was pressed since the last call or question."""
        return bool(self.typed())

    def typed(self) -> str:
        """Return the keys typed since the last call or question."""
        if not self._terminal:
            return ""
        if sys.platform == "win32":
            import msvcrt

            typed = ""
            while msvcrt.kbhit():
                typed += msvcrt.getwch()
            return typed
        import os
        import select

        if not select.select([sys.stdin], [], [], 0.0)[0]:
            return ""
        return os.read(sys.stdin.fileno(), 64).decode("utf-8", "replace")

    def _key_mode(self) -> None:
        if sys.platform == "win32" or not self._terminal:
            return
        import termios

        self._before = termios.tcgetattr(sys.stdin)
        keys = termios.tcgetattr(sys.stdin)
        keys[3] &= ~(termios.ICANON | termios.ECHO)
        termios.tcsetattr(sys.stdin, termios.TCSAFLUSH, keys)

    def _line_mode(self) -> None:
        if sys.platform != "win32" and self._before is not None:
            import termios

            termios.tcsetattr(sys.stdin, termios.TCSAFLUSH, self._before)
            self._before = None
