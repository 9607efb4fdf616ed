"""One clock for several platforms: each tick is waited for once, and what came of it all are told."""

from typing import Any

from simconsole.session.fleet.shared_pace import SharedPace
from simconsole.session.pacing import Pacer
from simconsole.values.signals import Event

STALL = int(Event.LOOP_STALL)


class Clock(Pacer):
    """A pace that takes no time; it stalls in the waits of these numbers."""

    def __init__(self, *stalls: int) -> None:
        super().__init__(100)
        self.waits = 0
        self._stalls = stalls

    def wait(self) -> int:
        self.waits += 1
        return STALL if self.waits in self._stalls else 0

    def summary(self) -> dict[str, Any]:
        return {"waits": self.waits}


def test_each_tick_is_waited_for_once() -> None:
    clock = Clock()
    shared = SharedPace(clock, 3)
    platforms = [shared.of(number) for number in range(3)]
    for tick in range(1, 6):
        assert [platform.wait() for platform in platforms] == [0, 0, 0]
        assert clock.waits == tick
    assert platforms[2].summary() == {"waits": 5}


def test_all_are_told_of_a_stall_in_the_same_tick_and_once() -> None:
    shared = SharedPace(Clock(2), 3)
    platforms = [shared.of(number) for number in range(3)]
    told = [[platform.wait() for platform in platforms] for _ in range(4)]
    assert told == [[0, 0, 0], [STALL] * 3, [0, 0, 0], [0, 0, 0]]


def test_who_stands_waits_alone_and_no_tick_is_late_afterwards() -> None:
    clock = Clock()
    shared = SharedPace(clock, 3)
    platforms = [shared.of(number) for number in range(3)]
    platforms[0].wait()
    for _ in range(1000):  # time stands for the second one
        platforms[1].wait()
    assert clock.waits == 1000
    platforms[2].wait()
    for tick in range(1, 6):
        for platform in platforms:
            platform.wait()
        assert clock.waits == 1000 + tick
