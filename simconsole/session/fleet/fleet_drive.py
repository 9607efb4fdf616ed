"""The drive of a session with several platforms: everything once for each, but server, clock and world."""

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from simconsole.processes.lifetimes import Interrupt, remove_half_made, undone
from simconsole.processes.shared_memory import sweep
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.recording.bundles.bundle import BundleWriter
from simconsole.recording.bundles.manifest import Manifest
from simconsole.recording.bundles.provenance import NOTHING_GIVEN, Given
from simconsole.session.fleet.company import Company
from simconsole.session.fleet.fleet_bridge import links
from simconsole.session.fleet.members import members
from simconsole.session.fleet.served_link import ServedLink
from simconsole.session.fleet.shared_pace import SharedPace
from simconsole.session.fleet.shared_sumo import SharedSumo, shared_sumo
from simconsole.session.fleet.sight import Sight, sight_of
from simconsole.session.headless import open_headless
from simconsole.session.lifecycle import ENDLESS_TICKS, DriveResult, bundle_of, list_what_workers_wrote, warm_up
from simconsole.session.lockstep import AskingLink
from simconsole.session.opened import Among, Opened
from simconsole.session.pacing import Pacer, realtime_hints
from simconsole.session.preconditions import check_session, check_world
from simconsole.session.provenance import with_devices
from simconsole.session.realtime import open_realtime
from simconsole.session.seat import look_for_devices
from simconsole.tick.advance import Console, ConsoleState
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.tick.loop import Components, come_to_rest, steps
from simconsole.tick.together import Body, Whereabouts, run_together
from simconsole.values.host.jit import compiled
from simconsole.values.state_vector import Snapshot


class _Member(NamedTuple):
    """One platform of the drive."""

    resolved: ResolvedSession
    console: Console
    initial: ConsoleState
    bundle: BundleWriter
    sight: Sight  # of the others
    opened: Opened
    link: AskingLink | ServedLink | None  # None: no server


def drive_fleet(
    resolved: ResolvedSession,
    folder: Path,
    given: Given = NOTHING_GIVEN,
    show: Callable[[Snapshot], None] = lambda snapshot: None,
    until_left: bool = False,
    on_bridge: Callable[[str], None] = lambda url: None,
) -> DriveResult:
    """Drive all platforms of a session into one new bundle: that of the first in `folder`, the others' below it.

    The first one is that of `scenario.seat`. `show` sees it again and again. With `until_left` the drive ends when no
    controller is left, too. `on_bridge` is told where the server listens, before anybody is waited for. Signals end all
    as `lifecycle.drive` tells.

    Raises:
        SimConsoleError: the session cannot be driven so, or a port or file cannot be opened.
    """
    sweep()
    named = members(resolved)
    parts = list(named.values())
    for part in parts:
        check_session(part.session)
        check_world(part)
        look_for_devices(part)
    assembled = [assemble(part, compiled) for part in parts]
    for part, (console, state) in zip(parts, assembled, strict=True):
        warm_up(console, state, awaited=part.session.mode.pacing == "lockstep")
    company, consoles = Company(*zip(*assembled, strict=True)), [console for console, _ in assembled]
    with ExitStack() as stack:
        interrupt = stack.enter_context(Interrupt())
        sumo = shared_sumo(parts, consoles, company, stack)
        sights = [
            sight_of(company, number, part, console, sumo)
            for number, (part, console) in enumerate(zip(parts, consoles, strict=True))
        ]
        bundles = _bundles(named, consoles, folder, given, stack)
        opened = _open(parts, consoles, sights, bundles, interrupt, stack, on_bridge)
        interrupt.check()
        fleet = [
            _Member(part, *built, bundle, sight, *each)
            for part, built, bundle, sight, each in zip(parts, assembled, bundles, sights, opened, strict=True)
        ]
        began_s = time.monotonic()
        states = _run(fleet, company, sumo, interrupt, show, until_left)
        if interrupt.raised or any(member.opened.left() for member in fleet):
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
    parts: Mapping[str, ResolvedSession],
    consoles: Sequence[Console],
    folder: Path,
    given: Given,
    stack: ExitStack,
) -> list[BundleWriter]:
    bundles: list[BundleWriter] = []
    for (name, part), console in zip(parts.items(), consoles, strict=True):
        own = folder / name if bundles else folder
        bundle = bundle_of(part, console, own, given, among_platforms=True)
        bundles.append(stack.enter_context(bundle))
        stack.enter_context(undone(partial(remove_half_made, own)))
        if len(bundles) == 1:
            bundles[0].announce(list(parts)[1:])
    return bundles


def _open(
    parts: Sequence[ResolvedSession],
    consoles: Sequence[Console],
    sights: Sequence[Sight],
    bundles: Sequence[BundleWriter],
    interrupt: Interrupt,
    stack: ExitStack,
    on_bridge: Callable[[str], None],
) -> list[tuple[Opened, AskingLink | ServedLink | None]]:
    ports = links(parts, consoles, sights, bundles[0].folder, interrupt, stack, on_bridge)
    pace, not_granted = SharedPace(Pacer(consoles[0].tick_hz), len(parts)), list[str]()
    opened = list[tuple[Opened, AskingLink | ServedLink | None]]()
    several = zip(parts, consoles, sights, bundles, ports, strict=True)
    for number, (part, console, sight, bundle, port) in enumerate(several):
        what = part, console, bundle.log, bundle.folder, interrupt, stack
        if part.session.mode.pacing == "realtime":
            assert not isinstance(port, AskingLink)
            one = open_realtime(*what, Among(sight, port, pace.of(number), not_granted))
        else:
            assert not isinstance(port, ServedLink)
            one = open_headless(*what, link=port, others=sight)
        if one.identities:
            bundle.extend_provenance(with_devices(bundle.manifest.provenance, one.identities))
        opened.append((one, port))
    if parts[0].session.mode.pacing == "realtime":
        not_granted += stack.enter_context(realtime_hints())
    return opened


def _run(
    fleet: Sequence[_Member],
    company: Company,
    sumo: SharedSumo | None,
    interrupt: Interrupt,
    show: Callable[[Snapshot], None],
    until_left: bool,
) -> list[ConsoleState]:
    session, tick_hz = fleet[0].resolved.session, fleet[0].console.tick_hz
    duration_s = session.scenario.duration_s
    ticks = ENDLESS_TICKS if duration_s is None else round(duration_s * tick_hz)
    initial = [member.initial for member in fleet]
    whereabouts = Whereabouts([_body(member.resolved, member.console) for member in fleet], initial)
    drives = [
        steps(
            member.console, member.initial, _told(member, number, whereabouts), ticks, lambda snapshot: interrupt.raised
        )
        for number, member in enumerate(fleet)
    ]

    has_robots = any(member.console.others for member in fleet)
    links = [member.link for member in fleet if isinstance(member.link, AskingLink)]
    turn_ticks = 1 if session.mode.pacing == "realtime" else None  # no wheel waits for the others' period

    def meet(states: Sequence[ConsoleState]) -> None:
        """Tell each where the others are, all of the same moment; meanwhile their controllers answer."""
        if has_robots:
            whereabouts.renew(states)
        company.renew(states)
        if sumo is not None:
            sumo.step(states[0].tick)
        for number, (member, state) in enumerate(zip(fleet, states, strict=True)):
            member.sight.look(Snapshot(state.tick, tick_hz, state.vector), company, number)
        AskingLink.hear_all(links)

    def finished(states: Sequence[ConsoleState]) -> bool:
        """Show the first platform as far as it is; return whether somebody or something ends the drive."""
        first = Snapshot(states[0].tick, tick_hz, states[0].vector)
        show(first)
        if interrupt.raised or fleet[0].opened.finished(first) or any(member.opened.left() for member in fleet):
            return True
        return until_left and not any(member.link is not None and member.link.clients for member in fleet)

    return run_together(drives, initial, meet, session.mode.control_period_ticks, finished, turn_ticks)


def _told(member: _Member, number: int, whereabouts: Whereabouts) -> Components:
    """Return the parts of a platform's drive; a robot is told of the others in columns of its own alone."""
    parts = member.opened.components
    if not member.console.others:
        return parts
    return parts._replace(others=whereabouts.seen_by(number), road_users=None)


def _body(resolved: ResolvedSession, console: Console) -> Body:
    robot, platform = resolved.vehicle, console.platform
    if isinstance(robot, TurtlebotProfile):
        return Body(robot.body_x_m, robot.body_x_m, robot.body_radius_m)
    radius_m = 0.5 * platform.width_m
    rear_m = radius_m - platform.rear_overhang_m
    return Body(rear_m, max(rear_m, platform.length_m - platform.rear_overhang_m - radius_m), radius_m)


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
