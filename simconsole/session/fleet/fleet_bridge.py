"""The one rosbridge server of several platforms in lockstep: each has its topics, its commander and its link."""

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from simconsole.processes.lifetimes import Interrupt
from simconsole.session.autopilot_program import new_nonce
from simconsole.session.headless import LOOK_S, lockstep_link
from simconsole.session.lockstep import LockstepLink
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import BridgeError

if TYPE_CHECKING:
    from simconsole.bridge.console.surroundings import Surroundings


def links(
    parts: Sequence[ResolvedSession],
    consoles: Sequence[Console],
    folder: Path,
    interrupt: Interrupt,
    stack: ExitStack,
    on_bridge: Callable[[str], None],
) -> list[LockstepLink]:
    """Open the server, wait until somebody hears each platform's odometry, and return the platforms' links.

    Args:
        parts: the session of each platform.
        consoles: theirs.
        folder: where topics are recorded if the session says so.
        interrupt: ends the waiting.
        stack: closes the server.
        on_bridge: told where it listens.

    Raises:
        BridgeError: it cannot listen, or a platform's controller does not come in time.
        ProfileError: as `ConsoleBridge`.
    """
    from simconsole.bridge.transport.lockstep_port import LockstepPort
    from simconsole.bridge.transport.lockstep_server import LockstepBridge

    bridges = [part.session.outputs.bridge for part in parts]
    mode = parts[0].session.mode
    first, *others = [
        (bridge, _around(part, console)) for bridge, part, console in zip(bridges, parts, consoles, strict=True)
    ]
    assert first[0] is not None
    server = LockstepBridge(
        first[0],
        odometry_hz=mode.control_hz,
        folder=folder,
        drive=new_nonce(),
        around=first[1],
        platforms=len(parts),
    )
    stack.callback(server.close)
    ports = [LockstepPort.of_first(server)]
    for bridge, around in others:
        assert bridge is not None
        ports.append(LockstepPort.beside(server, bridge, mode.control_hz, around))
    on_bridge(server.url)
    consoles_there = [port.console for port in ports]
    deadline_s = time.monotonic() + mode.wait_for_controller_s
    while (left_s := deadline_s - time.monotonic()) > 0.0:
        if server.wait_for_client(min(left_s, LOOK_S), consoles_there):
            return [lockstep_link(port, parts[0].session, interrupt) for port in ports]
        interrupt.check()
    raise BridgeError(
        f"not every platform's odometry was subscribed to at {server.url} within {mode.wait_for_controller_s:g} s"
    )


def _around(part: ResolvedSession, console: Console) -> "Surroundings":
    from simconsole.bridge.console.surroundings import Surroundings
    from simconsole.control.requests.refusals import steering_limit
    from simconsole.session.robots import robot_at_work

    return Surroundings(
        robot=robot_at_work(part.vehicle, part.world),
        steering=steering_limit(part.session.features.control, console.platform.wheelbase_m),
    )
