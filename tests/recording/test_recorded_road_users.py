from collections.abc import Iterator
from typing import Any

import pytest

from simconsole.recording.framing import Message
from simconsole.recording.log_header import ROAD_USERS, SIGNALS, LogHeader, message_stream, vector_stream
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.values.errors import RecordingError
from simconsole.world.traffic.road_users import ENCODING, FIELDS, NOBODY, to_bytes


class Recorded:
    """A recording with these messages of road users; None: without such a stream."""

    def __init__(self, messages: list[Message] | None, signals: list[Message] | None) -> None:
        streams = (vector_stream(("a",), 0), *(() if messages is None else (message_stream(ROAD_USERS, ENCODING),)))
        if signals is not None:
            streams = (*streams, message_stream(SIGNALS))
        self.header = LogHeader(tick_hz=250, streams=streams, console_version="", source_sha256="", session_sha256="")
        self._messages = {ROAD_USERS: messages or [], SIGNALS: signals or []}

    def messages(self, stream: str) -> Iterator[Message]:
        yield from self._messages[stream]


def read(messages: list[Message] | None, signals: list[Message] | None = None) -> list[Any]:
    return list(recorded_road_users(Recorded(messages, signals)))  # type: ignore[arg-type]  # as far as it is read


def test_a_step_is_that_of_the_tick_before_its_frame() -> None:
    found = read([Message(1, to_bytes(NOBODY)), Message(11, bytes(8 * FIELDS))])
    assert [(at.tick, len(at.users)) for at in found] == [(0, 0), (10, 1)]


def test_drive_without_traffic_has_nobody() -> None:
    assert read(None) == []


def test_message_that_is_no_table_is_named_by_its_tick() -> None:
    with pytest.raises(RecordingError, match="tick 11: road users: 7 bytes"):
        read([Message(11, bytes(7))])


def test_signals_of_another_simulator_come_with_the_step_that_changed_them() -> None:
    table = to_bytes(NOBODY)
    changed = [Message(1, b'{"a":{"states":"G","switch_tick":7}}'), Message(21, b'{"a":null}')]
    found = read([Message(tick, table) for tick in (1, 11, 21)], changed)
    assert [[one.letters for one in at.signals.values()] for at in found] == [["G"], ["G"], []]
    with pytest.raises(RecordingError, match="tick 1: road users: signals: "):
        read([Message(1, table)], [Message(1, b"[]")])
