"""What the recorder keeps of a tick, and what it tells the drive."""

from collections.abc import Sequence

import numpy as np
import pytest

from simconsole.session.recorder import LogRecorder
from simconsole.values.signals import Event
from simconsole.values.state_vector import Snapshot

FAILED = int(Event.RECORDING_FAILED)


class Log:
    """A log whose disk fails as it is told to."""

    def __init__(self, error: Exception | None = None) -> None:
        self.failure: str | None = None
        self.error = error
        self.ticks: list[int] = []
        self.messages: list[tuple[int, str, bytes]] = []

    def append(self, tick: int, vector: np.ndarray, messages: Sequence[tuple[str, bytes]] = ()) -> None:
        if self.error is not None:
            raise self.error
        self.ticks.append(tick)
        self.messages += [(tick, *message) for message in messages]


def snapshot(tick: int) -> Snapshot:
    return Snapshot(tick, 250, np.zeros(1))


def test_a_log_that_stopped_is_an_alarm_in_every_tick_after() -> None:
    log = Log()
    recorder = LogRecorder(log)  # type: ignore[arg-type]  # as far as a recorder needs it
    assert [recorder.write(snapshot(tick)) for tick in (1, 2)] == [0, 0]
    log.failure = "no space left"
    assert [recorder.write(snapshot(tick)) for tick in (3, 4)] == [FAILED, FAILED]
    assert log.ticks == [1, 2, 3, 4]


def test_what_raises_is_kept_as_the_first_reason_and_raised_on() -> None:
    log = Log(ValueError("width"))
    recorder = LogRecorder(log)  # type: ignore[arg-type]
    for _ in range(2):
        with pytest.raises(ValueError, match="width"):
            recorder.write(snapshot(1))
        log.error = ValueError("width, another time")
    assert log.failure == "ValueError: width"


def test_acts_go_into_the_tick_in_which_they_arrived_and_into_the_summary() -> None:
    arrived = [[], [b'{"tick":1,"act":"mark","note":"cut in"}', b'{"tick":1,"act":"estop"}'], []]
    log = Log()
    recorder = LogRecorder(log, iter(arrived).__next__)  # type: ignore[arg-type]
    for tick in (1, 2, 3):
        recorder.write(snapshot(tick))
    assert log.messages == [(2, "acts", act) for act in arrived[1]]
    acts = [{"tick": 1, "act": "mark", "note": "cut in"}, {"tick": 1, "act": "estop"}]
    assert recorder.acts_summary() == {"acts": acts}


class Source:
    """Somebody whose messages the log keeps."""

    def __init__(self, name: str) -> None:
        self._name = name

    def take_messages(self, tick: int) -> list[tuple[str, bytes]]:
        return [(self._name, b"said")]


def test_messages_of_all_sources_go_with_the_tick() -> None:
    log = Log()
    sources = Source("road_users"), None, Source("own")
    recorder = LogRecorder(log, list, *sources)  # type: ignore[arg-type]
    assert recorder.write(snapshot(1)) == 0
    assert log.messages == [(1, "road_users", b"said"), (1, "own", b"said")]
