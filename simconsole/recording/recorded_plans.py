"""What controllers planned in a recorded drive, as its log has it: nothing else of a drive says it."""

from collections.abc import Iterator

from simconsole.recording.log_header import PLANS
from simconsole.recording.reading import Recording
from simconsole.values.errors import RecordingError
from simconsole.values.planned_path import PlannedPath, from_bytes


def recorded_plans(recording: Recording) -> Iterator[PlannedPath]:
    """Yield the plans of a drive, oldest first; none where the log has no stream of them.

    Raises:
        RecordingError: a message is no plan.
    """
    if all(stream.name != PLANS for stream in recording.header.streams):
        return
    for message in recording.messages(PLANS):
        try:
            yield from_bytes(message.content)
        except ValueError as problem:
            raise RecordingError(f"tick {message.tick}: plan: {problem}") from None
