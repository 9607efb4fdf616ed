"""Speed advice as a log has it."""

import pytest

from simconsole.recording.framing import Message
from simconsole.recording.log_header import ADVICE, LogHeader, message_stream, vector_stream
from simconsole.recording.recorded_advice import AdviceAt, recorded_advice
from simconsole.values.errors import RecordingError


class Recorded:
    """A recording with these messages; None: without such a stream."""

    def __init__(self, contents: list[bytes] | None) -> None:
        streams = (vector_stream(("a",), 0), *(() if contents is None else (message_stream(ADVICE),)))
        self.header = LogHeader(tick_hz=250, streams=streams, console_version="", source_sha256="", session_sha256="")
        self._contents = contents or []

    def messages(self, stream: str) -> list[Message]:
        assert stream == ADVICE
        return [Message(10 * number, content) for number, content in enumerate(self._contents, 1)]


def test_each_advice_has_its_tick() -> None:
    told = [b'{"kind":1,"low_mps":5.0,"high_mps":9.5,"target_mps":9.0}', b'{"kind":2,"low_mps":0,"high_mps":0}']
    found = list(recorded_advice(Recorded(told)))  # type: ignore[arg-type]  # as far as it is read
    assert found == [AdviceAt(10, 1, 5.0, 9.5), AdviceAt(20, 2, 0.0, 0.0)]


def test_without_advice_there_is_none_and_what_is_none_is_named_by_its_tick() -> None:
    assert list(recorded_advice(Recorded(None))) == []  # type: ignore[arg-type]  # as above
    with pytest.raises(RecordingError, match="tick 10: advice: "):
        list(recorded_advice(Recorded([b"[]"])))  # type: ignore[arg-type]  # as above
