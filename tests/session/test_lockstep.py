from collections.abc import Callable, Sequence

import numpy as np
import pytest

from simconsole.bridge.console.input_slots import BridgeInputs, Question
from simconsole.session.lockstep import AskingLink, LockstepLink
from simconsole.values.signals import NO_COMMAND, Event, EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot

PERIOD_TICKS = 5


class Server:
    """A bridge whose controller answers as told, and which notes what is asked of it."""

    def __init__(self, answers: bool = True) -> None:
        self.answers = answers
        self.clients = 1
        self.sequence = 0.0
        self.raised = 0
        self.exchanged: list[int] = []
        self.published: list[int] = []

    def exchange(self, snapshot: Snapshot, timeout_s: float, stop: Callable[[], bool]) -> bool:
        self.exchanged.append(snapshot.tick)
        self.sequence += self.answers
        return self.answers

    def counts(self) -> dict[str, int]:
        return {"sent": len(self.published)}

    def stand(self, timeout_s: float) -> None:
        """Nothing to serve."""

    def take_acts(self) -> list[bytes]:
        return []

    def publish(self, snapshot: Snapshot) -> None:
        self.published.append(snapshot.tick)

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        events, self.raised = self.raised, 0
        return NO_COMMAND._replace(sequence=self.sequence), EventInput(float(events))


@pytest.fixture
def server() -> Server:
    return Server()


def drive(link: LockstepLink, first: int, last: int) -> list[int]:
    """Take and publish tick by tick, as the drive loop does; return the events of each tick."""
    seen = []
    for tick in range(first, last + 1):
        seen.append(int(link.take(tick)[1].events))
        link.publish(Snapshot(tick, 250, np.zeros(4)))
    return seen


def test_the_drive_waits_once_in_each_period_and_never_in_between(server: Server) -> None:
    link = LockstepLink(server, PERIOD_TICKS, 1.0)
    assert drive(link, 1, 20) == [0] * 20
    assert server.exchanged == [5, 10, 15, 20]
    assert server.published == []
    assert link.counters() == {"exchanges": 4, "unanswered": 0, "bridge": {"sent": 0}}


def test_the_ticks_of_a_period_are_foreseen_as_they_are_taken(server: Server) -> None:
    link, taken = LockstepLink(server, PERIOD_TICKS, 1.0), LockstepLink(server, PERIOD_TICKS, 1.0)
    commands = np.zeros((64, len(NO_COMMAND)))
    for tick, count in ((1, 5), (3, 3), (5, 1), (6, 5)):
        assert link.foresee(tick, commands) == count
        assert link.unseen(tick) + 1 == count, "a block ends with the exchange"
        expected = [list(taken.take(tick + at)[0]) for at in range(count)]
        assert commands[:count].tolist() == expected
    assert link.foresee(1, commands[:2]) == 2


def test_a_command_grows_older_in_foreseen_ticks(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    newest = NO_COMMAND._replace(sequence=1.0, age_ticks=2.0)
    monkeypatch.setattr(server, "take", lambda tick: (newest, EventInput(0.0)))
    commands = np.zeros((64, len(NO_COMMAND)))
    assert LockstepLink(server, PERIOD_TICKS, 1.0).foresee(6, commands) == 5
    assert commands[:5, NO_COMMAND._fields.index("age_ticks")].tolist() == [2.0, 3.0, 4.0, 5.0, 6.0]


def test_no_tick_is_foreseen_while_an_edge_waits_and_none_is_lost(server: Server) -> None:
    link = LockstepLink(server, PERIOD_TICKS, 1.0)
    server.raised = int(Event.MARK)
    assert link.foresee(1, np.zeros((64, len(NO_COMMAND)))) == 0
    assert link.foresee(1, np.zeros((64, len(NO_COMMAND)))) == 0
    assert link.take(1)[1].events == Event.MARK
    assert link.foresee(2, np.zeros((64, len(NO_COMMAND)))) == 4


def test_a_missing_answer_is_one_event_in_the_next_tick_and_is_not_waited_for_again(server: Server) -> None:
    server.answers = False
    link = LockstepLink(server, PERIOD_TICKS, 1.0)
    events = drive(link, 1, 30)
    assert [tick for tick, event in enumerate(events, start=1) if event] == [6]
    assert events[5] == Event.NO_ANSWER
    assert server.exchanged == [5]
    assert server.published == [10, 15, 20, 25, 30]
    assert link.counters() == {"exchanges": 1, "unanswered": 1, "bridge": server.counts()}


def test_a_controller_that_spoke_again_is_waited_for_again(server: Server) -> None:
    server.answers = False
    link = LockstepLink(server, PERIOD_TICKS, 1.0)
    drive(link, 1, 12)
    server.sequence += 1.0
    server.answers = True
    drive(link, 13, 20)
    assert server.exchanged == [5, 15, 20]


def test_without_a_client_there_is_nobody_to_wait_for(server: Server) -> None:
    server.clients = 0
    link = LockstepLink(server, PERIOD_TICKS, 1.0)
    assert drive(link, 1, 20) == [0] * 20
    assert server.exchanged == []
    assert server.published == [5, 10, 15, 20]


def test_a_missing_answer_does_not_hide_other_events(server: Server) -> None:
    server.answers = False
    link = LockstepLink(server, PERIOD_TICKS, 1.0)
    drive(link, 1, 5)
    server.raised = int(Event.COMMANDER_LOST)
    assert int(link.take(6)[1].events) == Event.COMMANDER_LOST | Event.NO_ANSWER


class AskedServer(Server):
    """One platform's port of a bridge: its controller answers if `answers`, when all are heard."""

    def __init__(self, answers: bool = True) -> None:
        super().__init__(answers)
        self.inputs = BridgeInputs()
        self.heard: list[int] = []

    def ask(self, snapshot: Snapshot) -> Question:
        self.exchanged.append(snapshot.tick)
        return Question(self.inputs, 0.0, 1 if self.answers else None)

    def hear(self, asked: Sequence[Question], timeout_s: float, stop: Callable[[], bool]) -> list[bool]:
        self.heard.append(len(asked))
        return [question.stamp_ns is not None for question in asked]


def test_several_platforms_ask_first_and_are_heard_together() -> None:
    servers = [AskedServer(), AskedServer(answers=False)]
    links = [AskingLink(server, PERIOD_TICKS, 1.0) for server in servers]
    events: list[list[int]] = [[], []]
    for first in range(1, 21, PERIOD_TICKS):
        for link, seen in zip(links, events, strict=True):
            seen += drive(link, first, first + PERIOD_TICKS - 1)
        AskingLink.hear_all(links)
    assert servers[0].heard == [2, 1, 1, 1], "the second one is not waited for until it has spoken"
    assert servers[0].exchanged == [5, 10, 15, 20]
    assert servers[1].exchanged == [5]
    assert servers[1].published == [10, 15, 20]
    assert [tick for tick, event in enumerate(events[1], start=1) if event] == [6]
    assert events[1][5] == Event.NO_ANSWER
    assert not any(events[0])
    assert [link.unanswered for link in links] == [0, 1]


def test_where_nobody_was_asked_nobody_is_heard() -> None:
    server = AskedServer()
    AskingLink.hear_all([AskingLink(server, PERIOD_TICKS, 1.0)])
    assert server.heard == []
