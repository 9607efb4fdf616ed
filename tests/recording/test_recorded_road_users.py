from collections.abc import Iterator
from typing import Any

import pytest

from simconsole.recording.framing import Message
from simconsole.recording.log_header import ROAD_USERS, LogHeader, message_stream, vector_stream
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.values.errors import RecordingError
from simconsole.world.traffic.road_users import ENCODING, FIELDS, NOBODY, to_bytes


class Recorded:
    """A recording with these messages of road users; None: without such a stream."""

    def __init__(self, messages: list[Message] | None) -> None:
        streams = (vector_stream(("a",), 0), *(() if messages is None else (message_stream(ROAD_USERS, ENCODING),)))
        self.header = LogHeader(tick_hz=250, streams=streams, console_version="", source_sha256="", session_sha256="")
        self._messages = messages

    def messages(self, stream: str) -> Iterator[Message]:
        assert stream == ROAD_USERS
        yield from self._messages or ()


def read(messages: list[Message] | None) -> list[Any]:
    return list(recorded_road_users(Recorded(messages)))  # type: ignore[arg-type]  # as far as it is read


def test_a_step_is_that_of_the_tick_before_its_frame() -> None:
    found = read([Message(1, to_bytes(NOBODY)), Message(11, bytes(8 * FIELDS))])
    assert [(at.tick, len(at.users)) for at in found] == [(0, 0), (10, 1)]


def test_drive_without_traffic_has_nobody() -> None:
    assert read(None) == []


def test_message_that_is_no_table_is_named_by_its_tick() -> None:
    with pytest.raises(RecordingError, match="tick 11: road users: 7 bytes"):
        read([Message(11, bytes(7))])
