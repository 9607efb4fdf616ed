"""Whether the controller's commands may be relied on: age, finiteness, refused ones in a row, stable for how long."""

from typing import Final, NamedTuple

from simconsole.control.remote import command_finite, known_kind
from simconsole.control.settings import ControlSettings
from simconsole.kernels import kernel
from simconsole.signals import ArbiterMemory, RemoteCommand

_MANY: Final = 1e9


class Link(NamedTuple):
    """The controller as seen by arbitration."""

    sequence_seen: float
    refused_seen: float
    invalid_run: float  # refused commands in a row
    fresh_ticks: float
    fresh: float  # 1: there is a command, it is finite, of a known kind and young enough
    invalid: float  # 1: it is not finite, or too many in a row were refused


@kernel
def watch_link(remote: RemoteCommand, memory: ArbiterMemory, settings: ControlSettings) -> Link:
    """Follow the controller by one tick. A restarted counter (smaller than before) counts as nothing refused."""
    if not command_finite(remote):
        return Link(memory.sequence_seen, memory.refused_seen, memory.invalid_run, 0.0, 0.0, 1.0)
    refused = remote.refused - memory.refused_seen
    if refused < 0.0:
        refused = 0.0
    run = memory.invalid_run + refused
    if remote.sequence != memory.sequence_seen:
        run = 0.0
    elif run > _MANY:
        run = _MANY
    in_time = 0.0 <= remote.age_ticks < settings.stale_ticks
    fresh = in_time and remote.sequence > 0.0 and known_kind(remote.kind)
    fresh_ticks = memory.fresh_ticks + 1.0 if fresh and refused == 0.0 else 0.0
    return Link(
        remote.sequence,
        remote.refused,
        run,
        fresh_ticks,
        1.0 if fresh else 0.0,
        1.0 if run >= settings.invalid_commands_max else 0.0,
    )
