"""The drive of a session with several platforms: everything once for each, but server, clock and arena."""

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from simconsole.processes.lifetimes import Interrupt, remove_half_made, undone
from simconsole.processes.shared_memory import sweep
from simconsole.profiles.vehicle import TurtlebotProfile
from simconsole.recording.bundles.bundle import BundleWriter
from simconsole.recording.bundles.manifest import Manifest
from simconsole.recording.bundles.provenance import NOTHING_GIVEN, Given
from simconsole.session.fleet.fleet_bridge import links
from simconsole.session.fleet.members import members
from simconsole.session.headless import open_headless
from simconsole.session.lifecycle import ENDLESS_TICKS, DriveResult, bundle_of, list_what_workers_wrote, warm_up
from simconsole.session.lockstep import LockstepLink
from simconsole.session.opened import Opened
from simconsole.session.preconditions import check_session, check_world
from simconsole.tick.advance import Console, ConsoleState
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.tick.loop import come_to_rest, steps
from simconsole.tick.together import Body, Whereabouts, run_together
from simconsole.values.host.jit import compiled
from simconsole.values.state_vector import Snapshot


class _Member(NamedTuple):
    """One platform of the drive."""

    resolved: ResolvedSession
    console: Console
    initial: ConsoleState
    bundle: BundleWriter
    opened: Opened
    link: LockstepLink


def drive_fleet(
    resolved: ResolvedSession,
    folder: Path,
    given: Given = NOTHING_GIVEN,
    show: Callable[[Snapshot], None] = lambda snapshot: None,
    until_left: bool = False,
    on_bridge: Callable[[str], None] = lambda url: None,
) -> DriveResult:
    """Drive all platforms of a session into one new bundle: that of the first in `folder`, the others' below it.

    `show` sees the first platform again and again. With `until_left` the drive ends when no controller is left, too.
    `on_bridge` is told where the server listens, before anybody is waited for. Signals end all as `lifecycle.drive`
    tells.

    Raises:
        SimConsoleError: the session cannot be driven so, or a port or file cannot be opened.
    """
    sweep()
    parts = members(resolved)
    for part in parts:
        check_session(part.session)
        check_world(part)
    assembled = [assemble(part, compiled) for part in parts]
    for console, state in assembled:
        warm_up(console, state)
    with ExitStack() as stack:
        interrupt = stack.enter_context(Interrupt())
        bundles = _bundles(parts, [console for console, _ in assembled], folder, given, stack)
        opened = _open(parts, [console for console, _ in assembled], bundles, interrupt, stack, on_bridge)
        fleet = [
            _Member(part, *built, bundle, *each)
            for part, built, bundle, each in zip(parts, assembled, bundles, opened, strict=True)
        ]
        began_s = time.monotonic()
        states = _run(fleet, interrupt, show, until_left)
        if interrupt.raised:
            states = [
                come_to_rest(member.console, state, member.opened.components.recorder)
                for member, state in zip(fleet, states, strict=True)
            ]
        wall_s = time.monotonic() - began_s
        manifests = _finish(fleet, states, wall_s, interrupt.raised)
    list_what_workers_wrote(folder, manifests[0])
    failures = [manifest.recording_failure for manifest in manifests if manifest.recording_failure is not None]
    first = manifests[0]
    return DriveResult(
        folder=folder,
        ticks=first.ticks,
        digest=first.digest,
        interrupted=interrupt.raised,
        summary=first.summary,
        recording_failure=failures[0] if failures else None,
        platforms=tuple(first.platforms),
    )


def _bundles(
    parts: Sequence[ResolvedSession], consoles: Sequence[Console], folder: Path, given: Given, stack: ExitStack
) -> list[BundleWriter]:
    names = [platform.name for platform in parts[0].session.scenario.platforms]
    bundles: list[BundleWriter] = []
    for part, console, name in zip(parts, consoles, names, strict=True):
        own = folder / name if bundles else folder
        bundles.append(stack.enter_context(bundle_of(part, console, own, given)))
        stack.enter_context(undone(partial(remove_half_made, own)))
        if len(bundles) == 1:
            bundles[0].announce(names[1:])
    return bundles


def _open(
    parts: Sequence[ResolvedSession],
    consoles: Sequence[Console],
    bundles: Sequence[BundleWriter],
    interrupt: Interrupt,
    stack: ExitStack,
    on_bridge: Callable[[str], None],
) -> list[tuple[Opened, LockstepLink]]:
    ports = links(parts, consoles, bundles[0].folder, interrupt, stack, on_bridge)
    return [
        (open_headless(part, console, bundle.log, bundle.folder, interrupt, stack, link=port), port)
        for part, console, bundle, port in zip(parts, consoles, bundles, ports, strict=True)
    ]


def _run(
    fleet: Sequence[_Member], interrupt: Interrupt, show: Callable[[Snapshot], None], until_left: bool
) -> list[ConsoleState]:
    session, tick_hz = fleet[0].resolved.session, fleet[0].console.tick_hz
    duration_s = session.scenario.duration_s
    ticks = ENDLESS_TICKS if duration_s is None else round(duration_s * tick_hz)
    initial = [member.initial for member in fleet]
    whereabouts = Whereabouts([_body(member.resolved) for member in fleet], initial)
    drives = [
        steps(
            member.console,
            member.initial,
            member.opened.components._replace(others=whereabouts.seen_by(number)),
            ticks,
            lambda snapshot: interrupt.raised,
        )
        for number, member in enumerate(fleet)
    ]

    def finished(states: Sequence[ConsoleState]) -> bool:
        """Show the first platform as far as it is; return whether somebody ends the drive."""
        show(Snapshot(states[0].tick, tick_hz, states[0].vector))
        return interrupt.raised or (until_left and not any(member.link.clients for member in fleet))

    return run_together(drives, initial, whereabouts, session.mode.control_period_ticks, finished)


def _body(resolved: ResolvedSession) -> Body:
    robot = resolved.vehicle
    assert isinstance(robot, TurtlebotProfile)
    return Body(robot.body_x_m, robot.body_radius_m)


def _finish(
    fleet: Sequence[_Member], states: Sequence[ConsoleState], wall_s: float, interrupted: bool
) -> list[Manifest]:
    """Finish the bundles, that of the first platform last: it vouches for the others."""
    digests: dict[str, str] = {}
    manifests: list[Manifest] = []
    for member, state in reversed(list(zip(fleet, states, strict=True))):
        summary: dict[str, Any] = {
            "wall_s": wall_s,
            "real_time_factor": state.tick / member.console.tick_hz / wall_s,
            "interrupted": interrupted,
            **member.opened.summary(),
        }
        is_first = member is fleet[0]
        manifest = member.bundle.finish(summary, dict(reversed(digests.items())) if is_first else None)
        digests[member.bundle.folder.name] = manifest.digest
        manifests.insert(0, manifest)
    return manifests
