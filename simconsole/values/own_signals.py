"""A lab's own signals, as its code says them while a drive runs; `recording/own_signals.py` reads them back."""

import math
import re
import struct
from typing import Final

from simconsole.values.errors import RecordingError

OWN: Final = "own"
"""The log's stream of them, and what their columns begin with: `own.lateral_m`."""
MOST_SIGNALS: Final = 256
_NAME: Final = re.compile(r"[a-z][a-z0-9_]{0,63}")


class OwnSignals:
    """Signals that code beside the drive says: it sets them, the drive records them.

    Attributes:
        names: of the signals, a unit at their end as everywhere (`lateral_m`), in the order of their columns.
    """

    def __init__(self, *names: str) -> None:
        """Declare the signals.

        Raises:
            RecordingError: no name, too many, one twice, or one that is no word of lower-case letters and digits.
        """
        wrong = [name for name in names if not _NAME.fullmatch(name)]
        if wrong:
            raise RecordingError(f"own signals: value {wrong[0]!r}: lower-case letters, digits and _, up to 64")
        if not 1 <= len(set(names)) == len(names) <= MOST_SIGNALS:
            raise RecordingError(f"own signals: {len(names)} names: 1 to {MOST_SIGNALS}, each another")
        self.names = names
        self._values = dict.fromkeys(names, math.nan)
        self._packed = struct.Struct(f"<{len(names)}d")
        self._fresh = False

    def set(self, **values: float) -> None:
        """Say the value of signals, in the unit of their names; those not named keep theirs.

        Raises:
            RecordingError: a signal that was not declared.
            TypeError: no number.
            ValueError: no number.
        """
        for name, value in values.items():
            if name not in self._values:
                raise RecordingError(f"own signals: value {name!r}: one of {', '.join(self.names)}")
            self._values[name] = float(value)
        self._fresh = True

    def forget(self) -> None:
        """Forget all values: a new drive begins, in which nothing was said yet."""
        self._values = dict.fromkeys(self.names, math.nan)
        self._fresh = False

    def take_messages(self, tick: int) -> list[tuple[str, bytes]]:
        """Return the values, if any was set since the last call."""
        fresh, self._fresh = self._fresh, False
        return [(OWN, self._packed.pack(*self._values.values()))] if fresh else []
