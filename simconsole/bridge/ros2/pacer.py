"""Answers to nodes, one by one where there are many: rclpy's queue there holds ten and loses what comes beyond."""

from collections import deque
from collections.abc import Callable
from typing import Any, Final

SERVICE_AT_ONCE: Final = 8
SERVICE_PERIOD_S: Final = 0.005
ACTION_AT_ONCE: Final = 4
ACTION_PERIOD_S: Final = 0.01
"""An action's client reads one answer a turn, beside feedback and status: it is given more time."""


class Pacer:
    """Does things at once while few are open, else one a period."""

    def __init__(self, node: Any, group: Any, at_once: int, period_s: float) -> None:
        """Begin with nothing to do; there is a timer only while something waits."""
        self._node = node
        self._group = group
        self._at_once = at_once
        self._period_s = period_s
        self._waiting: deque[Callable[[], None]] = deque()
        self._timer: Any = None

    def do(self, count_open: int, action: Callable[[], None]) -> None:
        """Do it now, or when those that wait already have had their turn."""
        if count_open <= self._at_once and not self._waiting:
            action()
            return
        self._waiting.append(action)
        if self._timer is None:
            self._timer = self._node.create_timer(self._period_s, self._turn, callback_group=self._group)

    def _turn(self) -> None:
        if self._waiting:
            self._waiting.popleft()()
        elif self._timer is not None:
            self._node.destroy_timer(self._timer)
            self._timer = None
