"""Whether a controller's commands may be relied on: age, finiteness, plausibility, refusals in a row, steadiness."""

from typing import Final

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.remote import command_finite, implausible, known_kind
from simconsole.values.kernels import kernel
from simconsole.values.signals import Link, LinkState, RemoteCommand, VehicleState

_MANY: Final = 1e9


@kernel
def watch_link(
    remote: RemoteCommand, before: Link, age_before_ticks: float, vehicle: VehicleState, settings: ControlSettings
) -> Link:
    """Follow one controller by one tick. A restarted counter (smaller than before) counts as nothing refused.

    A command that steers implausibly hard for the vehicle's speed counts as refused, and the last plausible command
    goes on ageing as if none had come: after the time-out for stale commands none is valid.

    Args:
        remote: Its newest command.
        before: What was remembered of it in the tick before.
        age_before_ticks: Age of its newest command in the tick before.
        vehicle: State after the tick before.
        settings: Limits.
    """
    lease = before.lease_ticks - 1.0 if before.lease_ticks > 0.0 else 0.0
    if not command_finite(remote):
        return _not_finite(before, lease)
    refused = remote.refused - before.refused_seen
    if refused < 0.0:
        refused = 0.0
    in_time = 0.0 <= remote.age_ticks < settings.stale_ticks
    known = remote.sequence > 0.0 and known_kind(remote.kind)
    fresh = in_time and known
    too_hard = known and implausible(remote, vehicle, settings)
    wild = fresh and too_hard
    wild_ticks = 0.0
    if wild:
        wild_ticks = _plausible_age(before, age_before_ticks, settings) + 1.0
    wild_count = before.implausible
    run = before.invalid_run + refused
    if remote.sequence != before.sequence_seen and too_hard:
        run += 1.0
        wild_count += 1.0
    elif remote.sequence != before.sequence_seen and known:
        run = 0.0
    if run > _MANY:
        run = _MANY
    invalid = run >= settings.invalid_commands_max or wild_ticks >= settings.stale_ticks
    well = fresh and refused == 0.0 and not wild and not invalid
    fresh_ticks = before.fresh_ticks + 1.0 if well else 0.0
    if fresh and not wild and not invalid:
        lease = settings.lease_ticks
    return Link(
        sequence_seen=remote.sequence,
        refused_seen=remote.refused,
        invalid_run=run,
        fresh_ticks=fresh_ticks,
        fresh=1.0 if fresh else 0.0,
        invalid=1.0 if invalid else 0.0,
        lease_ticks=lease,
        state=_state(remote.sequence, fresh, invalid, fresh_ticks >= settings.engage_stable_ticks),
        implausible=wild_count,
        implausible_ticks=wild_ticks,
    )


@kernel
def _not_finite(before: Link, lease_ticks: float) -> Link:
    """Return the link after a command that is not finite: invalid, and nothing of the command is remembered."""
    return Link(
        sequence_seen=before.sequence_seen,
        refused_seen=before.refused_seen,
        invalid_run=before.invalid_run,
        fresh_ticks=0.0,
        fresh=0.0,
        invalid=1.0,
        lease_ticks=lease_ticks,
        state=LinkState.INVALID,
        implausible=before.implausible,
        implausible_ticks=0.0,
    )


@kernel
def _plausible_age(before: Link, age_before_ticks: float, settings: ControlSettings) -> float:
    """Return how old the last plausible command was in the tick before; after a silence it is stale in any case."""
    if before.implausible_ticks > 0.0:
        return before.implausible_ticks
    return age_before_ticks if before.fresh > 0.0 else settings.stale_ticks


@kernel
def _state(sequence: float, fresh: bool, invalid: bool, steady: bool) -> float:
    if invalid:
        return LinkState.INVALID
    if not fresh:
        return LinkState.STALE if sequence > 0.0 else LinkState.NEVER
    return LinkState.STEADY if steady else LinkState.UNSTEADY
