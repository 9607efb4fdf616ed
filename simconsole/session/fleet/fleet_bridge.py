"""The one rosbridge server of several platforms, in the tick loop: each has its topics, its commander and its link."""

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from subprocess import Popen
from typing import TYPE_CHECKING

from simconsole.bridge.console.topics import ODOMETRY, ODOMETRY_HZ
from simconsole.processes.lifetimes import Interrupt, end, tell_to_end
from simconsole.session.autopilot_program import PROGRAM_END_S, new_nonce, own_token, start_autopilot
from simconsole.session.fleet.members import is_commanded
from simconsole.session.fleet.served_link import ServedLink
from simconsole.session.headless import LOOK_S, surroundings
from simconsole.session.lockstep import AskingLink
from simconsole.session.traffic_source import TrafficSource
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import BridgeError

if TYPE_CHECKING:
    from simconsole.bridge.console.endpoint import ConsoleBridge
    from simconsole.bridge.transport.lockstep_server import LockstepBridge


def links(
    parts: Sequence[ResolvedSession],
    consoles: Sequence[Console],
    sights: Sequence[TrafficSource],
    folder: Path,
    interrupt: Interrupt,
    stack: ExitStack,
    on_bridge: Callable[[str], None],
) -> list[AskingLink | ServedLink | None]:
    """Open the server, start the autopilots; in lockstep, wait until somebody hears each platform that is commanded.

    Args:
        parts: the session of each platform.
        consoles: theirs.
        sights: the road users of each; a robot tells nobody of them.
        folder: where topics are recorded if the session says so.
        interrupt: ends the waiting.
        stack: closes the server, and ends the autopilots.
        on_bridge: told where it listens.

    Returns:
        The link of each platform; none where the session has no server, or nothing paces it.

    Raises:
        BridgeError: it cannot listen, an autopilot cannot be started, or a platform's controller does not come in time.
        ProfileError: as `ConsoleBridge`.
    """
    pacing = parts[0].session.mode.pacing
    if pacing == "free" or parts[0].session.outputs.bridge is None:
        return [None] * len(parts)
    from simconsole.bridge.transport.lockstep_port import LockstepPort
    from simconsole.bridge.transport.lockstep_server import LockstepBridge

    bridges = [part.session.outputs.bridge for part in parts]
    mode, drive = parts[0].session.mode, new_nonce()
    first, *others = [
        (bridge, surroundings(part, console, None if console.others else sight))
        for bridge, part, console, sight in zip(bridges, parts, consoles, sights, strict=True)
    ]
    assert first[0] is not None
    odometry_hz = mode.control_hz if pacing == "lockstep" else first[0].rates_hz.get(ODOMETRY, ODOMETRY_HZ)
    server = LockstepBridge(
        first[0],
        odometry_hz=odometry_hz,
        folder=folder,
        drive=drive,
        around=first[1],
        platforms=len(parts),
    )
    ports = [LockstepPort.of_first(server)]
    for bridge, around in others:
        assert bridge is not None
        ports.append(LockstepPort.beside(server, bridge, odometry_hz, around))
    programs: list[Popen[bytes]] = []
    stack.callback(end, programs, PROGRAM_END_S)
    stack.callback(server.close)  # closes its clients' connections before the programs' end is waited for
    stack.callback(tell_to_end, programs)
    on_bridge(server.url)
    _start_autopilots(parts, server.url, drive, programs)
    if pacing == "realtime":
        return [ServedLink(port) for port in ports]
    awaited = [port.console for port, part in zip(ports, parts, strict=True) if is_commanded(part.session)]
    _wait(server, awaited, programs, mode.wait_for_controller_s, interrupt)
    return [
        AskingLink(port, mode.control_period_ticks, mode.answer_timeout_s, lambda: interrupt.raised) for port in ports
    ]


def _start_autopilots(parts: Sequence[ResolvedSession], url: str, drive: str, programs: list[Popen[bytes]]) -> None:
    """Start a program for all cars of one profile: what it hears of them and says to them goes in one piece."""
    alike: dict[str, list[str]] = {}
    for part in parts:
        session, bridge = part.session, part.session.outputs.bridge
        if session.features.autopilot is not None:
            assert bridge is not None
            alike.setdefault(session.scenario.vehicle, []).append(bridge.namespace)
    for part in parts:
        session, bridge = part.session, part.session.outputs.bridge
        if session.features.autopilot is not None and (cars := alike.pop(session.scenario.vehicle, None)):
            assert bridge is not None
            programs.append(start_autopilot(url, session, bridge, drive, own_token(session), namespaces=cars))


def _wait(
    server: "LockstepBridge",
    awaited: "Sequence[ConsoleBridge]",
    programs: Sequence[Popen[bytes]],
    patience_s: float,
    interrupt: Interrupt,
) -> None:
    deadline_s = time.monotonic() + patience_s
    while awaited and (left_s := deadline_s - time.monotonic()) > 0.0:
        if server.wait_for_client(min(left_s, LOOK_S), awaited):
            return
        interrupt.check()
    if not awaited:
        return
    ended = next((program.returncode for program in programs if program.poll() is not None), None)
    if ended is not None:
        raise BridgeError(f"an autopilot ended with exit code {ended} before it connected")
    raise BridgeError(f"not every platform's odometry was subscribed to at {server.url} within {patience_s:g} s")
