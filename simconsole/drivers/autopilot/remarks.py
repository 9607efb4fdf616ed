"""What the console says about the autopilot's commands: refusals with the limit that was broken. Pure."""

from collections.abc import Callable, Sequence
from typing import Final

from simconsole.bridge.protocol.operations import Status

_TOLD: Final = 10
_TOLD_EVERY: Final = 1000


class Remarks:
    """Tells a server's remarks, the first ones each and later ones now and then."""

    def __init__(self, say: Callable[[str], None]) -> None:
        """Tell them by `say`."""
        self._say = say
        self._newest: Status | None = None
        self._count = 0

    def tell(self, statuses: Sequence[Status]) -> None:
        """Tell what is new among the client's remarks, of which the newest is the last."""
        if not statuses or statuses[-1] is self._newest:
            return
        new = []
        for status in reversed(statuses):
            if status is self._newest:
                break
            new.append(status)
        self._newest = statuses[-1]
        for status in reversed(new):
            self._count += 1
            if self._count <= _TOLD or self._count % _TOLD_EVERY == 0:
                self._say(f"the console says ({self._count}): {status.level}: {status.msg}")
