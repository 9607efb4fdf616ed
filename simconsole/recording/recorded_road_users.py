"""The road users of a recorded drive, as its log has them: traffic is never simulated a second time."""

from collections.abc import Iterator

from simconsole.recording.log_header import ROAD_USERS
from simconsole.recording.reading import Recording
from simconsole.values.errors import RecordingError
from simconsole.world.traffic.road_users import RoadUsersAt, from_bytes


def recorded_road_users(recording: Recording) -> Iterator[RoadUsersAt]:
    """Yield the road users of a drive after each step of traffic, oldest first; nobody where it had no traffic.

    Raises:
        RecordingError: a message is no table of road users.
    """
    encoding = next((stream.encoding for stream in recording.header.streams if stream.name == ROAD_USERS), None)
    if encoding is None:
        return
    for message in recording.messages(ROAD_USERS):
        try:
            table = from_bytes(message.content, encoding)
        except ValueError as problem:
            raise RecordingError(f"tick {message.tick}: road users: {problem}") from None
        yield RoadUsersAt(message.tick - 1, table)
