"""A part of a drive that raises falls silent; the others go on, and it is told once."""

from typing import NoReturn

import pytest

from simconsole.drive import Cast
from simconsole.isolation import isolated
from simconsole.pacing import UnpacedPacer
from simconsole.rows import Snapshot
from simconsole.signals import NO_COMMAND, NO_SAMPLE, Event


class Broken:
    def __init__(self) -> None:
        self.calls = 0

    def _fail(self) -> NoReturn:
        self.calls += 1
        raise RuntimeError("broken")

    def poll(self, tick: int) -> NoReturn:
        self._fail()

    def take(self, tick: int) -> NoReturn:
        self._fail()

    def publish(self, snapshot: Snapshot) -> NoReturn:
        self._fail()

    def write(self, snapshot: Snapshot) -> int:
        return 0

    def close(self) -> None:
        self.calls = -1


def test_each_part_is_kept_from_the_others(capsys: pytest.CaptureFixture[str]) -> None:
    devices, ros, can, station = Broken(), Broken(), Broken(), Broken()
    cast = isolated(Cast(devices, ros, Broken(), [station], UnpacedPacer(), ecu=can))
    taken = []
    for tick in (1, 2, 3):
        assert cast.devices.poll(tick) == NO_SAMPLE
        taken.append((cast.commands.take(tick), cast.ecu.take(tick)))
        cast.stations[0].publish(Snapshot(tick, 250, NO_SAMPLE))  # type: ignore[arg-type]  # nobody looks at it
    assert [command for pair in taken for command, _ in pair] == [NO_COMMAND] * 6
    assert [events.events for pair in taken for _, events in pair] == [float(Event.COMMANDER_LOST)] * 2 + [0.0] * 4
    assert (devices.calls, ros.calls, can.calls, station.calls) == (3, 1, 1, 1), "devices may come back"
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 4
    assert told[0] == "simconsole: the cockpit failed: RuntimeError: broken"
    cast.devices.close()
    assert devices.calls == -1


def test_an_interrupt_is_no_failure() -> None:
    class Interrupted(Broken):
        def take(self, tick: int) -> NoReturn:
            raise KeyboardInterrupt

    cast = isolated(Cast(Broken(), Interrupted(), Broken(), [], UnpacedPacer()))
    with pytest.raises(KeyboardInterrupt):
        cast.commands.take(1)
