"""Faults of the loop's own process: told once, raised only while they are on."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from simconsole.faults.process_faults import (
    InjectedError,
    RaisingCommands,
    RaisingDevices,
    RaisingOutput,
    StallingPace,
)
from simconsole.values.protocols import NobodyCommands, NobodySeated
from simconsole.values.signals import NO_COMMAND, NO_EVENTS, NO_SAMPLE, Event
from simconsole.values.state_vector import Snapshot

STALL = int(Event.LOOP_STALL)


class Switch:
    def __init__(self) -> None:
        self.ticks = 0


class EveryTick:
    """A pace that raises an event of its own."""

    def wait(self) -> int:
        return int(Event.MARK)


def test_a_stall_is_one_event_beside_those_of_the_pace() -> None:
    switch = Switch()
    pace = StallingPace(EveryTick(), [(101.0, switch)])
    told = []
    for ticks in (0, 1, 2, 0, 1):
        switch.ticks = ticks
        told.append(pace.wait())
    mark = int(Event.MARK)
    assert told == [mark, mark | STALL, mark, mark, mark], "a fault comes once"


def test_a_stall_of_100_ms_is_none_and_two_are_counted_apart() -> None:
    short, long = Switch(), Switch()
    pace = StallingPace(EveryTick(), [(100.0, short), (500.0, long)])
    short.ticks = 1
    assert not pace.wait() & STALL
    long.ticks = 1
    assert pace.wait() & STALL


class Kept(NobodySeated):
    closed = False

    def close(self) -> None:
        self.closed = True


@pytest.mark.parametrize(
    ("part", "act", "quiet"),
    [
        (lambda s: RaisingDevices(NobodySeated(), s), lambda it: it.poll(1), NO_SAMPLE),
        (lambda s: RaisingCommands(NobodyCommands(), s), lambda it: it.take(1), (NO_COMMAND, NO_EVENTS)),
        (lambda s: RaisingOutput(s), lambda it: it.publish(Snapshot(1, 250, np.zeros(1))), None),
    ],
    ids=["devices", "commands", "output"],
)
def test_a_part_raises_while_any_of_its_faults_is_on_and_works_otherwise(
    part: Callable[[list[Switch]], Any], act: Callable[[Any], object], quiet: object, request: pytest.FixtureRequest
) -> None:
    switches = [Switch(), Switch()]
    faulty = part(switches)
    assert act(faulty) == quiet
    switches[1].ticks = 3
    with pytest.raises(InjectedError, match=f"{request.node.callspec.id}: a fault of the scenario"):
        act(faulty)
    switches[1].ticks = 0
    assert act(faulty) == quiet


def test_devices_are_closed_even_while_they_raise() -> None:
    devices, switch = Kept(), Switch()
    switch.ticks = 1
    RaisingDevices(devices, [switch]).close()
    assert devices.closed
