"""Answers one by one."""

from collections.abc import Callable
from typing import Any

from simconsole.bridge.ros2.pacer import Pacer


class Node:
    """A node with at most one timer."""

    def __init__(self) -> None:
        self.tick: Callable[[], None] | None = None
        self.period_s = 0.0

    def create_timer(self, period_s: float, tick: Callable[[], None], **_: Any) -> str:
        assert self.tick is None
        self.tick, self.period_s = tick, period_s
        return "timer"

    def turn(self) -> None:
        assert self.tick is not None
        self.tick()

    def destroy_timer(self, timer: str) -> None:
        assert timer == "timer"
        self.tick = None


def test_a_burst_is_spread() -> None:
    node, done = Node(), list[int]()
    pacer = Pacer(node, None, 2, 0.5)
    for number in range(5):
        pacer.do(number + 1, lambda number=number: done.append(number))  # type: ignore[misc]  # mypy sees no default
    assert (done, node.period_s) == ([0, 1], 0.5)
    pacer.do(1, lambda: done.append(5))  # those before come first
    for count in range(3, 7):
        node.turn()
        assert done == list(range(count))
    node.turn()
    assert node.tick is None, "it does not tick for nothing"
    pacer.do(1, lambda: done.append(6))
    assert done[-1] == 6
