"""What a check does with a scenario's golden: writes it anew, or compares the drive with it."""

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Self, TextIO

from simconsole.evaluation.checks import golden
from simconsole.profiles.scenario import Tolerance
from simconsole.recording.framing import START_OF_CHAIN
from simconsole.values.host.files import replaced
from simconsole.values.kernels import Row


class Accepting:
    """Writes the drive as the new golden, which replaces the old one at the end.

    Attributes:
        exact: true: what is driven is what is accepted.
    """

    exact = True

    def __init__(
        self, path: Path, tick_hz: int, columns: tuple[str, ...], tolerances: Sequence[Tolerance] = ()
    ) -> None:
        self._path, self._tick_hz, self._columns = path, tick_hz, columns
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        """Open the draft of the golden."""
        self._path.parent.mkdir(exist_ok=True)
        draft = self._stack.enter_context(replaced(self._path))
        self._file = self._stack.enter_context(draft.open("w", encoding="utf-8", newline="\n"))
        self._file.write(self._head(START_OF_CHAIN.hex()))
        return self

    def __exit__(self, *error: Any) -> None:
        """Replace the golden by the draft, or remove the draft after an error."""
        self._stack.__exit__(*error)

    def see(self, tick: int, vector: Row) -> None:
        """Write one sample."""
        self._file.write(golden.line(tick, vector))

    def end(self, digest: str) -> list[str]:
        """Write the hash of the drive into the golden's head; return no differences, for the drive is accepted."""
        self._file.seek(0)
        self._file.write(self._head(digest))
        return []

    def _head(self, digest: str) -> str:
        return golden.head(digest, self._tick_hz, self._columns)


class Comparing:
    """Compares the drive with its golden.

    Attributes:
        exact: whether the finished drive is the golden's to the bit.
    """

    def __init__(
        self, path: Path, tick_hz: int, columns: tuple[str, ...], tolerances: Sequence[Tolerance] = ()
    ) -> None:
        self._path, self._columns, self._tolerances, self._tick_hz = path, columns, tolerances, tick_hz
        self._file: TextIO | None = None
        self.exact = False

    def __enter__(self) -> Self:
        """Open the golden, if there is one.

        Raises:
            ProfileError: it is no golden of this version.
        """
        if self._path.is_file():
            with ExitStack() as opening:
                self._file = opening.enter_context(self._path.open(encoding="utf-8", newline=""))
                self._golden = golden.Golden(self._file, str(self._path))
                self._comparison = golden.Comparison(self._golden, self._columns, self._tolerances)
                opening.pop_all()
        return self

    def __exit__(self, *error: Any) -> None:
        """Close it."""
        if self._file is not None:
            self._file.close()

    def see(self, tick: int, vector: Row) -> None:
        """Compare one sample."""
        if self._file is not None:
            self._comparison.see(tick, vector)

    def end(self, digest: str) -> list[str]:
        """Return how the finished drive differs from the golden, one line or none."""
        if self._file is None:
            return [f"{self._path}: no golden; accept one with --update-golden (of pytest: --simconsole-update-golden)"]
        if self._golden.tick_hz != self._tick_hz:
            return [f"{self._path}: tick_hz {self._tick_hz}, accepted {self._golden.tick_hz}"]
        difference = self._comparison.first_difference()
        if (self._golden.hash, self._golden.columns) == (digest, self._columns):
            self.exact = True
            return []
        if difference is None:
            return self._unseen(digest)
        first = (
            f"{self._path}: tick {difference.tick}: {difference.column}: "
            f"driven {difference.driven!r}, accepted {difference.accepted!r}"
        )
        return [first, *golden.readable(self._comparison.differences(), self._tick_hz)]

    def _unseen(self, digest: str) -> list[str]:
        """Return what is wrong with a drive of another hash where all samples of both are alike."""
        gone = [name for name in self._golden.columns if name not in self._columns]
        if not self._tolerances or gone:
            return [f"{self._path}: hash {digest}, accepted {self._golden.hash}; no sampled value differs"]
        if self._comparison.unaccepted is not None:
            return [f"{self._path}: tick {self._comparison.unaccepted}: driven, and no sample of it was accepted"]
        if not self._comparison.compared:
            return [
                f"{self._path}: hash {digest}, accepted {self._golden.hash}; no sample to hold the tolerances against"
            ]
        return []
