import pytest

from simconsole.casting import check_commander
from simconsole.commander import Commander
from simconsole.errors import ProfileError
from simconsole.profiles.session import SessionProfile
from simconsole.session_files import load_session, override
from simconsole.signals import NO_COMMAND, Event, EventInput, RemoteCommand


class Side:
    def __init__(self, sequence: float, events: Event) -> None:
        self.sequence, self.events = sequence, events

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        return NO_COMMAND._replace(sequence=self.sequence), EventInput(float(self.events))


def test_commands_are_the_chosen_sides() -> None:
    command, _ = Commander(Side(7, Event(0)), Side(9, Event(0))).take(1)
    assert command.sequence == 7


def test_edges_of_both_count_but_the_loss_of_who_does_not_command() -> None:
    chosen = Side(1, Event.COMMANDER_LOST | Event.MARK)
    other = Side(1, Event.COMMANDER_LOST | Event.NO_ANSWER | Event.EMERGENCY_STOP)
    _, events = Commander(chosen, other).take(1)
    assert Event(int(events.events)) == Event.COMMANDER_LOST | Event.MARK | Event.EMERGENCY_STOP
    _, events = Commander(Side(1, Event(0)), other).take(1)
    assert Event(int(events.events)) == Event.EMERGENCY_STOP


@pytest.fixture
def session() -> SessionProfile:
    return load_session("can")


def test_shipped_session_can_be_driven(session: SessionProfile) -> None:
    check_commander(session)
    check_commander(load_session("demo"))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"outputs": {"can": None}}, r"features\.commander: value can: needs outputs\.can"),
        ({"mode": {"pacing": "lockstep"}}, r"mode\.pacing: value lockstep"),
        ({"features": {"autopilot": "urban"}}, r"features\.autopilot"),
    ],
)
def test_commander_with_no_way_in_is_refused(
    session: SessionProfile, changes: dict[str, dict[str, object]], words: str
) -> None:
    with pytest.raises(ProfileError, match=words):
        check_commander(override(session, **changes))
