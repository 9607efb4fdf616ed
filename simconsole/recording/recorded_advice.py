"""The speed advice of a recorded drive, as its log has it."""

from collections.abc import Iterator
from typing import NamedTuple

import msgspec

from simconsole.recording.log_header import ADVICE
from simconsole.recording.reading import Recording
from simconsole.values.errors import RecordingError


class AdviceAt(NamedTuple):
    """What was advised from a tick on (`world.rules.speed_advice`)."""

    tick: int
    kind: int  # 0 nothing, 1 a speed, 2 prepare to stop
    low_mps: float
    high_mps: float


class _Told(msgspec.Struct, frozen=True):
    kind: int
    low_mps: float
    high_mps: float


def recorded_advice(recording: Recording) -> Iterator[AdviceAt]:
    """Yield each advice from when it was another, oldest first; none where nobody was advised.

    Raises:
        RecordingError: a message is no advice.
    """
    if all(stream.name != ADVICE for stream in recording.header.streams):
        return
    for message in recording.messages(ADVICE):
        try:
            told = msgspec.json.decode(message.content, type=_Told)
        except msgspec.MsgspecError as problem:
            raise RecordingError(f"tick {message.tick}: advice: {problem}") from None
        yield AdviceAt(message.tick, told.kind, told.low_mps, told.high_mps)
