"""How long the last frames took, in words. Pure: whoever draws tells the times."""

from collections import deque
from statistics import median
from typing import Final

KEPT: Final = 240
TOLD_S: Final = 0.5
"""The words change this often: digits that change every frame cannot be read."""


class FrameTimes:
    """Remembers the newest frames."""

    def __init__(self, drawer: str) -> None:
        """Take the name of what draws."""
        self._drawer = "".join(sign if " " <= sign <= "~" else "?" for sign in drawer)
        self._frames: deque[tuple[float, float]] = deque(maxlen=KEPT)
        self._since_told_s = TOLD_S
        self._lines: tuple[str, ...] = ()

    def add(self, frame_s: float, drawing_s: float) -> None:
        """Note one frame: from the end of the last to its own, and the part that its drawing took."""
        self._frames.append((frame_s, drawing_s))
        self._since_told_s += frame_s

    def lines(self, age_s: float | None) -> tuple[str, ...]:
        """Return what to show; `age_s` is that of the newest tick, None where no tick is known."""
        if not self._frames or self._since_told_s < TOLD_S:
            return self._lines
        self._since_told_s = 0.0
        frames, drawing = (sorted(values) for values in zip(*self._frames, strict=True))
        late = int(0.99 * (len(frames) - 1))
        whole_s = sum(frames)
        self._lines = (
            f"{len(frames) / whole_s if whole_s > 0.0 else 0.0:.0f} frames/s",
            f"frame {1e3 * median(frames):.1f} ms, 99 %: {1e3 * frames[late]:.1f} ms",
            f"drawing {1e3 * median(drawing):.1f} ms, 99 %: {1e3 * drawing[late]:.1f} ms",
            "no data" if age_s is None else f"data {1e3 * age_s:.0f} ms old",
            self._drawer,
        )
        return self._lines
