from simconsole.bridge.console.input_slots import BridgeInputs, Question, with_age
from simconsole.values.signals import NEVER_TICKS, NO_COMMAND, Event, RemoteCommand, RemoteKind

COMMAND = NO_COMMAND._replace(kind=float(RemoteKind.SPEED), speed_mps=3.0, direction=0.0)


def test_nothing_received_is_never() -> None:
    command, events = BridgeInputs().take(1)
    assert command.age_ticks == NEVER_TICKS
    assert (command.kind, command.sequence, events.events) == (0.0, 0.0, 0.0)


def test_age_counts_from_the_first_tick_that_could_use_the_command() -> None:
    inputs = BridgeInputs()
    inputs.tick = 10
    inputs.accept(COMMAND, None, 0)
    assert [inputs.take(tick)[0].age_ticks for tick in (11, 12, 61)] == [0.0, 1.0, 50.0]


def test_latest_wins_and_all_are_counted() -> None:
    inputs = BridgeInputs()
    for speed in range(1, 101):
        inputs.accept(COMMAND._replace(speed_mps=float(speed)), None, speed)
    command, _ = inputs.take(1)
    assert (command.speed_mps, command.sequence) == (100.0, 100.0)


def test_refusals_count_beside_the_command_and_change_nothing_else() -> None:
    inputs = BridgeInputs()
    inputs.accept(COMMAND, 7, 5)
    before = inputs.command
    inputs.refuse()
    assert inputs.command == before._replace(refused=1.0)
    assert (inputs.receipt_ns, inputs.stamp_ns) == (5, 7)
    inputs.accept(COMMAND, None, 9)
    assert inputs.command.refused == 1.0


def test_direction_stays_until_another_is_set() -> None:
    inputs = BridgeInputs()
    assert inputs.command.direction == 1.0
    inputs.keep(direction=-1.0)
    assert inputs.take(1)[0].age_ticks == NEVER_TICKS
    inputs.accept(COMMAND, None, 0)
    assert inputs.command.direction == -1.0
    inputs.accept(COMMAND._replace(direction=1.0), None, 0)
    assert inputs.command.direction == 1.0


def test_events_add_up_and_are_taken_once() -> None:
    inputs = BridgeInputs()
    inputs.raise_events(int(Event.EMERGENCY_STOP))
    inputs.raise_events(int(Event.RESET))
    assert inputs.take(1)[1].events == Event.EMERGENCY_STOP | Event.RESET
    assert inputs.take(2)[1].events == 0.0


def test_every_change_is_announced_at_once() -> None:
    seen: list[tuple[RemoteCommand, int | None]] = []
    events: list[int] = []
    inputs = BridgeInputs(lambda command, receipt_ns: seen.append((command, receipt_ns)), events.append)
    inputs.refuse()
    inputs.accept(COMMAND, None, 42)
    inputs.raise_events(4)
    assert [(command.sequence, command.refused, receipt) for command, receipt in seen] == [(0, 1, None), (1, 1, 42)]
    assert events == [4]


def test_age_from_a_monotonic_clock_in_whole_ticks() -> None:
    assert with_age(COMMAND, None, 5, 250).age_ticks == NEVER_TICKS
    assert with_age(COMMAND, 1_000_000, 4_999_999, 250).age_ticks == 0.0
    assert with_age(COMMAND, 1_000_000, 5_000_000, 250).age_ticks == 1.0
    assert with_age(COMMAND, 5_000_000, 1_000_000, 250).age_ticks == 0.0


def test_odometry_is_answered_by_a_newer_command_with_its_stamp_or_without_any() -> None:
    inputs = BridgeInputs()
    inputs.accept(COMMAND, 20, 0)
    question = Question(inputs, inputs.command.sequence, 20)
    assert not question.is_answered, "the command was there before"
    inputs.accept(COMMAND, 10, 1)
    assert not question.is_answered, "it answers what went out before"
    inputs.accept(COMMAND, 20, 2)
    assert question.is_answered
    inputs.accept(COMMAND, None, 3)
    assert question.is_answered
    assert Question(inputs, inputs.command.sequence, None).is_answered, "nothing has gone out"


def test_nothing_more_is_waited_for_once_the_commander_is_gone() -> None:
    inputs = BridgeInputs()
    inputs.accept(COMMAND, 20, 0)
    question = Question(inputs, inputs.command.sequence, 30)
    assert not question.is_settled
    inputs.lose()
    assert (question.is_settled, question.is_answered) == (True, False)
    inputs.accept(COMMAND, 20, 1)
    assert not question.is_settled, "another one commands, and may answer yet"
