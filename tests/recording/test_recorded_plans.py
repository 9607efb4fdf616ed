from collections.abc import Iterator

import numpy as np
import pytest

from simconsole.recording.framing import Message
from simconsole.recording.log_header import PLANS, LogHeader, message_stream, vector_stream
from simconsole.recording.recorded_plans import recorded_plans
from simconsole.values.errors import RecordingError
from simconsole.values.planned_path import ENCODING, PlannedPath, to_bytes


class Recorded:
    """A recording with these messages of plans; None: without such a stream."""

    def __init__(self, messages: list[Message] | None) -> None:
        streams = (vector_stream(("a",), 0), *(() if messages is None else (message_stream(PLANS, ENCODING),)))
        self.header = LogHeader(tick_hz=250, streams=streams, console_version="", source_sha256="", session_sha256="")
        self._messages = messages

    def messages(self, stream: str) -> Iterator[Message]:
        assert stream == PLANS
        yield from self._messages or ()


def read(messages: list[Message] | None) -> list[PlannedPath]:
    return list(recorded_plans(Recorded(messages)))  # type: ignore[arg-type]  # as far as it is read


def test_plans_come_with_the_time_at_which_they_were_told() -> None:
    plans = [PlannedPath(200_000_000, np.ones((3, 4))), PlannedPath(400_000_000, np.empty((0, 4)))]
    found = read([Message(51 + 50 * number, to_bytes(plan)) for number, plan in enumerate(plans)])
    assert [(plan.t_ns, len(plan.places)) for plan in found] == [(200_000_000, 3), (400_000_000, 0)]


def test_an_older_log_has_none() -> None:
    assert read(None) == []


def test_message_that_is_no_plan_is_named_by_its_tick() -> None:
    with pytest.raises(RecordingError, match="tick 11: plan: 7 bytes"):
        read([Message(11, bytes(7))])
