"""The road users of a recorded drive, as its log has them: traffic is never simulated a second time."""

from collections.abc import Iterator

from simconsole.recording.log_header import ROAD_USERS, SIGNALS
from simconsole.recording.reading import Recording
from simconsole.values.errors import RecordingError
from simconsole.world.roads.running import NONE_RUNNING, changed
from simconsole.world.traffic.road_users import RoadUsersAt, from_bytes


def recorded_road_users(recording: Recording) -> Iterator[RoadUsersAt]:
    """Yield the road users of a drive after each step of traffic, oldest first; nobody where it had no traffic.

    With them come the signals, where another simulator ran them.

    Raises:
        RecordingError: a message is no table of road users, or no change of signals.
    """
    streams = {stream.name: stream.encoding for stream in recording.header.streams}
    if ROAD_USERS not in streams:
        return
    told = recording.messages(SIGNALS) if SIGNALS in streams else iter(())
    change, signals = next(told, None), NONE_RUNNING
    for message in recording.messages(ROAD_USERS):
        try:
            while change is not None and change.tick <= message.tick:
                signals, change = changed(signals, change.content), next(told, None)
            table = from_bytes(message.content, streams[ROAD_USERS])
        except ValueError as problem:
            raise RecordingError(f"tick {message.tick}: road users: {problem}") from None
        yield RoadUsersAt(message.tick - 1, table, signals)
