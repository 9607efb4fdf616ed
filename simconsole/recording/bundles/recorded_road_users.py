"""The road users of a recorded drive, as its log has them: traffic is never simulated a second time."""

from collections.abc import Iterator
from typing import NamedTuple

from simconsole.recording.bundles.bundle import Bundle
from simconsole.recording.log_header import ROAD_USERS
from simconsole.values.errors import RecordingError
from simconsole.world.roads.road_map import Array
from simconsole.world.traffic.road_users import from_bytes


class RoadUsersAt(NamedTuple):
    """The road users at a tick: the one after which they were where the table says, float64 [users, FIELDS]."""

    tick: int
    users: Array


def recorded_road_users(bundle: Bundle) -> Iterator[RoadUsersAt]:
    """Yield the road users of a drive, oldest first; nobody where it had no traffic.

    Raises:
        RecordingError: a message is no table of road users.
    """
    if all(stream.name != ROAD_USERS for stream in bundle.log.header.streams):
        return
    for message in bundle.log.messages(ROAD_USERS):
        try:
            table = from_bytes(message.content)
        except ValueError as problem:
            raise RecordingError(f"{bundle.log.path}: tick {message.tick}: road users: {problem}") from None
        yield RoadUsersAt(message.tick - 1, table)
