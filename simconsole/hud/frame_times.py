"""How long the last frames took, in words. Pure: whoever draws tells the times."""

from collections import deque
from statistics import median
from typing import Final

from simconsole.hud.language import number, say
from simconsole.profiles.view import ENGLISH, LanguageProfile

KEPT: Final = 240
TOLD_S: Final = 0.5
"""The words change this often: digits that change every frame cannot be read."""


RATE: Final = "{rate} frames/s"
FRAME: Final = "frame {median} ms, 99 %: {late} ms"
DRAWING: Final = "drawing {median} ms, 99 %: {late} ms"
DATA_AGE: Final = "data {age} ms old"
NO_DATA_YET: Final = "no data"


class FrameTimes:
    """Remembers the newest frames."""

    def __init__(self, drawer: str, language: LanguageProfile = ENGLISH) -> None:
        """Take the name of what draws."""
        self._language = language
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
            say(self._language, RATE, rate=f"{len(frames) / whole_s if whole_s > 0.0 else 0.0:.0f}"),
            self._line(FRAME, median(frames), frames[late]),
            self._line(DRAWING, median(drawing), drawing[late]),
            say(self._language, NO_DATA_YET)
            if age_s is None
            else say(self._language, DATA_AGE, age=f"{1e3 * age_s:.0f}"),
            self._drawer,
        )
        return self._lines

    def _line(self, phrase: str, median_s: float, late_s: float) -> str:
        middle, late = (number(self._language, 1e3 * time_s, 1) for time_s in (median_s, late_s))
        return say(self._language, phrase, median=middle, late=late)
