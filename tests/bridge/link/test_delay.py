import numpy as np
import pytest

from simconsole.bridge.link.delay import CommandsOverLink, over_link
from simconsole.profiles.link import LinkProfile
from simconsole.values.kernels import Row
from simconsole.values.signals import NO_COMMAND, EventInput, RemoteCommand

TICK_HZ = 250
PERIOD = 5


class Controller:
    """Answers the state of every fifth tick within it, as in lockstep: its answer is seen in the tick after."""

    def __init__(self) -> None:
        self.refused = 0.0

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        number, since = divmod(tick - 1, PERIOD)
        if number < 1:
            return NO_COMMAND, EventInput(float(tick == 3))
        command = NO_COMMAND._replace(sequence=float(number), age_ticks=float(since), speed_mps=float(number))
        return command._replace(refused=self.refused, hazard_lights=1.0), EventInput(float(tick == 3))


def taken(link: LinkProfile, ticks: int) -> list[RemoteCommand]:
    source = over_link(Controller(), link, TICK_HZ)
    return [source.take(tick)[0] for tick in range(1, ticks)]


def test_a_perfect_link_is_no_link() -> None:
    controller = Controller()
    assert over_link(controller, LinkProfile(), TICK_HZ) is controller


def test_a_command_acts_after_the_delay_and_ages_from_its_arrival() -> None:
    commands = taken(LinkProfile(delay_ms=40.0), 60)
    for tick, command in enumerate(commands, start=1):
        answered = (tick - 10) // PERIOD  # 40 ms are 10 ticks: the newest state that is so old
        assert command.sequence == max(0.0, float(answered)), tick
        if answered > 0:
            assert command.age_ticks == float((tick - 10) % PERIOD)


class Foreseeing(Controller):
    """The same, as a drive in lockstep sees it: what is taken in a period is known at its beginning."""

    periods = 1

    def foresee(self, tick: int, commands: Row) -> int:
        if tick == 3:
            return 0  # an edge
        count = min(len(commands), self.periods * PERIOD - (tick - 1) % PERIOD)
        for at in range(count):
            commands[at] = Controller.take(self, tick + at)[0]
        return count


@pytest.mark.parametrize("kept", [PERIOD, 2], ids=["whole blocks", "blocks that are cut short"])
@pytest.mark.parametrize(
    "link",
    [
        LinkProfile(delay_ms=40.0),
        LinkProfile(delay_ms=10.0, jitter_ms=60.0, loss_share=0.2),
        LinkProfile(delay_ms=7.0, jitter_ms=3.0),
    ],
    ids=["delay", "jitter and loss", "within a period"],
)
def test_what_is_foreseen_is_what_is_taken(link: LinkProfile, kept: int) -> None:
    """It may be asked again for the same ticks: a block may end before what was foreseen."""
    source = over_link(Foreseeing(), link, TICK_HZ)
    assert isinstance(source, CommandsOverLink)
    expected = [list(command) for command in taken(link, 3000)]
    rows = np.zeros((64, len(NO_COMMAND)))
    seen: list[list[float]] = []
    while len(seen) < len(expected) - 64:
        tick = len(seen) + 1
        count = min(source.foresee(tick, rows), kept)
        seen += rows[:count].tolist() if count else [list(source.take(tick)[0])]
    assert seen == expected[: len(seen)]


def test_the_next_command_is_not_foreseen_before_it_is_sent() -> None:
    """Also where the source knows it already: when it is lost is drawn as it is sent."""
    link = LinkProfile(delay_ms=10.0, jitter_ms=60.0, loss_share=0.2)
    controller = Foreseeing()
    controller.periods = 3
    source = over_link(controller, link, TICK_HZ)
    assert isinstance(source, CommandsOverLink)
    rows = np.zeros((64, len(NO_COMMAND)))
    seen: list[list[float]] = []
    while len(seen) < 500:
        tick = len(seen) + 1
        count = source.foresee(tick, rows)
        assert count <= PERIOD
        seen += rows[:count].tolist() if count else [list(source.take(tick)[0])]
    assert seen == [list(command) for command in taken(link, 2000)][: len(seen)]


def test_without_a_source_that_foresees_nothing_is_foreseen() -> None:
    source = over_link(Controller(), LinkProfile(delay_ms=40.0), TICK_HZ)
    assert isinstance(source, CommandsOverLink)
    assert source.foresee(1, np.zeros((5, len(NO_COMMAND)))) == 0


def test_edges_refusals_and_lights_do_not_wait() -> None:
    controller = Controller()
    source = over_link(controller, LinkProfile(delay_ms=400.0), TICK_HZ)
    assert [source.take(tick)[1].events for tick in (1, 2, 3, 4)] == [0.0, 0.0, 1.0, 0.0]
    controller.refused = 2.0
    command, _ = source.take(12)
    assert (command.sequence, command.refused, command.hazard_lights) == (0.0, 2.0, 1.0)


def test_a_lost_command_never_acts_and_as_many_are_lost_as_said() -> None:
    commands = taken(LinkProfile(loss_share=0.3), 5 * 4000)
    arrived = {command.sequence for command in commands if command.sequence}
    assert abs(len(arrived) / 3999 - 0.7) < 0.04
    assert max(command.age_ticks for command in commands if command.sequence) > PERIOD


def test_a_command_that_is_overtaken_is_dropped() -> None:
    commands = taken(LinkProfile(delay_ms=20.0, jitter_ms=100.0), 5 * 1000)
    sequences = [command.sequence for command in commands]
    assert sequences == sorted(sequences)
    assert 100 < len(set(sequences)) < 900
