"""Faults between a controller and the arbiter, one by one."""

import math

import pytest

from simconsole.faults.command_faults import FaultyCommands
from simconsole.profiles import faults as kinds
from simconsole.profiles.faults import Fault
from simconsole.values.signals import NO_COMMAND, Event, EventInput, RemoteCommand

HZ = 250


class Controller:
    """One command in every fifth tick."""

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        count = tick // 5
        return NO_COMMAND._replace(sequence=float(count), age_ticks=float(tick - 5 * count)), EventInput(0.0)


class Switch:
    ticks = 0


class Armed:
    def __init__(self, fault: Fault) -> None:
        self.fault = fault
        self.switch = Switch()


def taken(fault: Fault, ticks: range, began: int = 21) -> list[tuple[RemoteCommand, EventInput]]:
    armed = Armed(fault)
    source = FaultyCommands(Controller(), [armed], HZ)
    found = []
    for tick in range(1, ticks.stop):
        armed.switch.ticks = max(0, tick - began + 1)
        found.append(source.take(tick))
    return [found[tick - 1] for tick in ticks]


def test_silence_keeps_the_last_command_and_lets_it_grow_old() -> None:
    found = taken(kinds.Silent(at_s=0.0), range(20, 40))
    assert [command.sequence for command, _ in found] == [4.0] * 20
    assert [command.age_ticks for command, _ in found] == [float(tick - 20) for tick in range(20, 40)]
    assert {events.events for _, events in found} == {0.0}


def test_a_closed_connection_is_told_once() -> None:
    found = taken(kinds.Disconnected(at_s=0.0), range(20, 30))
    assert [events.events for _, events in found] == [0.0, float(Event.COMMANDER_LOST), *[0.0] * 8]


def test_refused_commands_are_counted() -> None:
    found = taken(kinds.Refused(at_s=0.0), range(20, 41))
    assert [command.refused for command, _ in found[::5]] == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert found[-1][0].sequence == 4.0


def test_delayed_commands_act_whole_ticks_later_and_are_older_by_that() -> None:
    found = [command for command, _ in taken(kinds.DelayedCommands(at_s=0.0, by_ms=100.0), range(20, 60))]
    assert [command.sequence for command in found] == [4.0] * 30 + [5.0] * 5 + [6.0] * 5  # 100 ms: 25 ticks
    assert [command.age_ticks for command in found] == [*map(float, range(30)), *map(float, [*range(25, 30)] * 2)]


def test_commands_sent_after_a_delay_overtake_those_on_the_way() -> None:
    source = FaultyCommands(Controller(), [armed := Armed(kinds.DelayedCommands(at_s=0.0, by_ms=100.0))], HZ)
    found = []
    for tick in range(1, 61):
        armed.switch.ticks = max(0, tick - 20) if tick < 33 else 0
        found.append(source.take(tick)[0])
    sequences = [command.sequence for command in found]
    assert sequences[18:34] == [3.0, *[4.0] * 15]
    assert sequences[34:45] == [7.0] * 5 + [8.0] * 5 + [9.0]  # 5 and 6, sent late, come after 7 and are dropped
    assert found[34].age_ticks == 0.0


def test_a_whole_delay_beside_another_fault_keeps_the_order_of_the_list() -> None:
    """The command that is astray when it is sent is so, late; one that is led astray late is so at once."""
    for faults, at in (((0, 1), 50), ((1, 0), 25)):
        kind = (kinds.Astray(at_s=0.0, road_wheel_deg=20.0), kinds.DelayedCommands(at_s=0.0, by_ms=100.0))
        armed = [Armed(kind[number]) for number in faults]
        source = FaultyCommands(Controller(), armed, HZ)
        angles = []
        for tick in range(1, 61):
            for one in armed:
                one.switch.ticks = max(0, tick - 24)
            angles.append(source.take(tick)[0].road_wheel_rad)
        assert 1 + next(place for place, angle in enumerate(angles) if angle) == at


def test_what_does_not_stop_commands_changes_them() -> None:
    late = taken(kinds.LateCommands(at_s=0.0, by_ms=100.0), range(25, 26))[0][0]
    assert (late.sequence, late.age_ticks) == (5.0, 25.0)
    assert math.isnan(taken(kinds.NotFinite(at_s=0.0), range(25, 26))[0][0].road_wheel_rad)
    astray = taken(kinds.Astray(at_s=0.0, road_wheel_deg=20.0), range(25, 26))[0][0]
    assert astray.road_wheel_rad == pytest.approx(math.radians(20.0))
    before = taken(kinds.Astray(at_s=0.0, road_wheel_deg=20.0), range(20, 21))[0][0]
    assert before.road_wheel_rad == 0.0


def test_a_controller_that_never_spoke_is_silent_from_the_start() -> None:
    command, _ = taken(kinds.Silent(at_s=0.0), range(9, 10), began=1)[0]
    assert command.sequence == 0.0
