"""Who takes part in a session: opens the cast that the profile names, for headless and for paced drives."""

from collections.abc import Callable
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, NamedTuple

from simconsole.assembly import ResolvedSession
from simconsole.drive import Cast, Recorder
from simconsole.errors import BridgeError, ProfileError
from simconsole.inline import LockstepLink, start_autopilot
from simconsole.pacing import UnpacedPacer
from simconsole.pipeline import Console
from simconsole.ports import CommandSource, NobodyCommands, Station
from simconsole.rows import Snapshot
from simconsole.seating import open_seating

if TYPE_CHECKING:
    from subprocess import Popen

    from simconsole.bridge.lockstep import LockstepBridge


class Opened(NamedTuple):
    """A cast that is ready to drive."""

    cast: Cast
    finished: Callable[[Snapshot], bool]
    summary: Callable[[], dict[str, Any]]


def open_headless(resolved: ResolvedSession, console: Console, recorder: Recorder, stack: ExitStack) -> Opened:
    """Open a drive that runs as fast as it goes, everything inline.

    Raises:
        ProfileError: the session needs lockstep for what it asks.
        BridgeError: the bridge cannot listen, or the autopilot did not connect.
        DeviceError: a device is missing.
    """
    commands: CommandSource = NobodyCommands()
    stations: tuple[Station, ...] = ()
    pace = UnpacedPacer()
    counters: Callable[[], dict[str, Any]] = dict
    if resolved.session.mode.pacing == "lockstep":
        link = _open_lockstep(resolved, console, stack)
        commands, stations, counters = link, (link,), link.counters
    elif resolved.session.features.autopilot is not None:
        raise ProfileError("mode.pacing: value free: lockstep or realtime, where features.autopilot drives")
    seating = open_seating(resolved, console, stack)
    cast = Cast(seating.devices, commands, recorder, stations, pace, seating.seat)
    return Opened(cast, seating.finished, lambda: {"lateness": "not paced", **counters()})


def _open_lockstep(resolved: ResolvedSession, console: Console, stack: ExitStack) -> LockstepLink:
    from simconsole.bridge.lockstep import LockstepBridge

    session = resolved.session
    if session.outputs.bridge is None:
        raise ProfileError("outputs.bridge: value missing: a bridge, where mode.pacing is lockstep")
    period_ticks = max(1, session.mode.control_period_ms * console.tick_hz // 1000)
    bridge = LockstepBridge(session.outputs.bridge, odometry_hz=console.tick_hz / period_ticks)
    course = session.features.autopilot
    program = None if course is None else start_autopilot(bridge.url, course, stack)
    stack.callback(bridge.close)  # closed before the programs' end is waited for: it is what ends them
    _wait_for_controller(bridge, program, session.mode.wait_for_controller_s)
    return LockstepLink(bridge, period_ticks, session.mode.answer_timeout_s)


def _wait_for_controller(bridge: "LockstepBridge", program: "Popen[bytes] | None", patience_s: float) -> None:
    if bridge.wait_for_client(patience_s):
        return
    if program is not None and program.poll() is not None:
        raise BridgeError(f"the autopilot ended with exit code {program.returncode} before it connected")
    raise BridgeError(f"no controller subscribed to odometry at {bridge.url} within {patience_s:g} s")
