"""Whether a controller's commands may be relied on: age, finiteness, refused ones in a row, stable for how long."""

from typing import Final

from simconsole.control.remote import command_finite, known_kind
from simconsole.control.settings import ControlSettings
from simconsole.kernels import kernel
from simconsole.signals import Link, LinkState, RemoteCommand

_MANY: Final = 1e9
_NEVER: Final = float(LinkState.NEVER)
_UNSTEADY: Final = float(LinkState.UNSTEADY)
_STEADY: Final = float(LinkState.STEADY)
_STALE: Final = float(LinkState.STALE)
_INVALID: Final = float(LinkState.INVALID)


@kernel
def watch_link(remote: RemoteCommand, before: Link, settings: ControlSettings) -> Link:
    """Follow one controller by one tick. A restarted counter (smaller than before) counts as nothing refused."""
    lease = before.lease_ticks - 1.0 if before.lease_ticks > 0.0 else 0.0
    if not command_finite(remote):
        return Link(before.sequence_seen, before.refused_seen, before.invalid_run, 0.0, 0.0, 1.0, lease, _INVALID)
    refused = remote.refused - before.refused_seen
    if refused < 0.0:
        refused = 0.0
    run = before.invalid_run + refused
    if remote.sequence != before.sequence_seen:
        run = 0.0
    elif run > _MANY:
        run = _MANY
    in_time = 0.0 <= remote.age_ticks < settings.stale_ticks
    fresh = in_time and remote.sequence > 0.0 and known_kind(remote.kind)
    fresh_ticks = before.fresh_ticks + 1.0 if fresh and refused == 0.0 else 0.0
    invalid = run >= settings.invalid_commands_max
    if fresh and not invalid:
        lease = settings.lease_ticks
    return Link(
        remote.sequence,
        remote.refused,
        run,
        fresh_ticks,
        1.0 if fresh else 0.0,
        1.0 if invalid else 0.0,
        lease,
        _state(remote.sequence, fresh, invalid, fresh_ticks >= settings.engage_stable_ticks),
    )


@kernel
def _state(sequence: float, fresh: bool, invalid: bool, steady: bool) -> float:
    if invalid:
        return _INVALID
    if not fresh:
        return _STALE if sequence > 0.0 else _NEVER
    return _STEADY if steady else _UNSTEADY
