"""One session: open everything, drive, close everything, whatever happens in between."""

import hashlib
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np

from simconsole.devices.force_feedback.aligning import shares_by_speed
from simconsole.drivers.own_controller import NO_OWN_CODE, OwnCode
from simconsole.processes.lifetimes import Interrupt, remove_half_made, undone
from simconsole.processes.shared_memory import sweep
from simconsole.profiles.files.loader import to_text
from simconsole.profiles.files.world_files import enclosed
from simconsole.recording.bundles.bundle import SESSION_FILE, BundleWriter, add_export, unlisted
from simconsole.recording.bundles.manifest import Manifest
from simconsole.recording.bundles.provenance import NOTHING_GIVEN, Given
from simconsole.recording.bundles.replay_bundle import sources_sha256
from simconsole.recording.log_header import (
    ACTS,
    ADVICE,
    PLANS,
    ROAD_USERS,
    SIGNALS,
    LogHeader,
    Stream,
    message_stream,
    vector_stream,
)
from simconsole.recording.own_signals import stream_of
from simconsole.session.advice.advice_worker import gives_advice, hears_advice
from simconsole.session.headless import open_headless
from simconsole.session.opened import Opened
from simconsole.session.paced import keeps_plans
from simconsole.session.preconditions import check_session, check_world
from simconsole.session.provenance import package_versions, provenance_at_start, with_devices
from simconsole.session.realtime import open_realtime
from simconsole.session.seat import look_for_devices
from simconsole.tick.advance import SETTINGS, Console, ConsoleState, advance, advance_block
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.tick.loop import come_to_rest, run
from simconsole.values.errors import ProfileError, RecordingError
from simconsole.values.host.jit import compiled
from simconsole.values.layout import read
from simconsole.values.own_signals import OwnSignals
from simconsole.values.planned_path import ENCODING as PLANS_ENCODING
from simconsole.values.signals import NO_COMMAND, NO_EVENTS, NO_SAMPLE
from simconsole.values.state_vector import INPUT_WIDTH, Snapshot, TickInputs
from simconsole.values.version import __version__
from simconsole.world.traffic.road_users import ENCODING as ROAD_USERS_ENCODING

ENDLESS_TICKS = 2**53


class DriveResult(NamedTuple):
    """The result of a drive: the bundle's folder and its summary."""

    folder: Path
    ticks: int
    digest: str
    interrupted: bool
    summary: dict[str, Any]
    recording_failure: str | None = None
    failure: BaseException | None = None  # what a lab's own code has raised: it ended the drive
    platforms: tuple[str, ...] = ()
    """Folders in the bundle that hold those of the session's other platforms."""


def drive(
    resolved: ResolvedSession,
    folder: Path,
    watch: Callable[[Snapshot], bool] | None = None,
    on_bridge: Callable[[str], None] = lambda url: None,
    given: Given = NOTHING_GIVEN,
    own: OwnCode = NO_OWN_CODE,
    show: Callable[[Snapshot], None] = lambda snapshot: None,
) -> DriveResult:
    """Drive a session into a new bundle in `folder`.

    `watch` sees every tick; True ends the drive. `show` sees it again and again, the last of the ticks that are made at
    once: who only looks on does not make a drive slower.

    `on_bridge` is told where the bridge of a paced drive listens, once it does. `given` is what whoever starts the
    drive says of it; it is kept with the rest of its provenance before the first tick. `own` is a lab's own code,
    called in a drive that is not paced.

    SIGINT, SIGTERM, SIGHUP and the driver who closes the window end it in order: the vehicle comes to rest in the log,
    torque goes off, the bundle is finished, then everything is closed. A second signal ends the process at once; before
    the first tick nothing is left.

    Raises:
        SimConsoleError: a device, port or file cannot be opened; what was opened before is closed again.
    """
    if resolved.fleet:
        raise ProfileError("scenario.platforms: value given: several are driven by simconsole drive and turtlebot only")
    sweep()
    check_session(resolved.session, has_controller=own.controller is not None)
    check_world(resolved)
    look_for_devices(resolved)
    console, state = assemble(resolved, compiled)
    warm_up(console, state, awaited=resolved.session.mode.pacing == "lockstep")
    duration_s = resolved.session.scenario.duration_s
    ticks = ENDLESS_TICKS if duration_s is None else round(duration_s * console.tick_hz)
    with ExitStack() as stack:
        interrupt = stack.enter_context(Interrupt())
        bundle = stack.enter_context(bundle_of(resolved, console, folder, given, own.signals))
        stack.enter_context(undone(lambda: remove_half_made(folder)))
        opened = _open(resolved, console, bundle, interrupt, stack, own)
        if opened.bridge_url is not None:
            on_bridge(opened.bridge_url)
        began_s = time.monotonic()

        def finished(snapshot: Snapshot) -> bool:
            """Show the drive as far as it is; return whether somebody or something ends it."""
            show(snapshot)
            ends = interrupt.raised or opened.left() or (watch is not None and watch(snapshot))
            return ends or opened.finished(snapshot)

        state = run(
            console,
            state,
            opened.components,
            ticks,
            finished,
            on_request=resolved.session.mode.start == "on_request",
            at_once=watch is None,
        )
        if interrupt.raised or opened.left():
            state = come_to_rest(console, state, opened.components.recorder)
        wall_s = time.monotonic() - began_s
        summary = {
            "wall_s": wall_s,
            "real_time_factor": state.tick / console.tick_hz / wall_s,
            "interrupted": interrupt.raised,
            **opened.summary(),
            **({} if console.platform.exact else {"bit_exact": False}),
        }
        manifest = bundle.finish(summary)
    list_what_workers_wrote(folder, manifest)
    return DriveResult(
        folder=folder,
        ticks=manifest.ticks,
        digest=manifest.digest,
        interrupted=interrupt.raised,
        summary=summary,
        recording_failure=manifest.recording_failure,
        failure=opened.failure(),
    )


def warm_up(console: Console, state: ConsoleState, *, awaited: bool = False) -> None:
    """Run one tick and drop it: compiles or loads the kernels before any clock runs or client waits.

    Where a controller is `awaited`, also the kernel that makes several ticks at once: it would give up a console that
    falls silent for the seconds that this takes.
    """
    advance(state, TickInputs(NO_SAMPLE, NO_COMMAND, NO_EVENTS), console)
    if awaited:
        advance_block(state.vector, state.vector[np.newaxis].copy(), console)


def _open(
    resolved: ResolvedSession,
    console: Console,
    bundle: BundleWriter,
    interrupt: Interrupt,
    stack: ExitStack,
    own: OwnCode,
) -> Opened:
    if resolved.session.mode.pacing == "realtime":
        opened = open_realtime(resolved, console, bundle.log, bundle.folder, interrupt, stack)
    else:
        opened = open_headless(resolved, console, bundle.log, bundle.folder, interrupt, stack, own)
    interrupt.check()
    if opened.identities:
        bundle.extend_provenance(with_devices(bundle.manifest.provenance, opened.identities))
    return opened


def list_what_workers_wrote(folder: Path, manifest: Manifest) -> None:
    """List the files that workers have written beside the log; they are whole only once their workers have ended."""
    if not manifest.finished:
        return
    with suppress(RecordingError, OSError):  # the drive is recorded; `verify` names what is not listed
        add_export(folder, *unlisted(folder, manifest))


def bundle_of(
    resolved: ResolvedSession,
    console: Console,
    folder: Path,
    given: Given,
    signals: OwnSignals | None = None,
    among_platforms: bool = False,
) -> BundleWriter:
    """Begin the bundle of a drive, as `new_bundle`, with the streams that its session has.

    With `among_platforms` it has road users, too: the session's other platforms.
    """
    traffic = resolved.session.environment.traffic
    seen = traffic is not None or among_platforms
    road_users = (message_stream(ROAD_USERS, ROAD_USERS_ENCODING),) if seen else ()
    if traffic is not None and traffic.sumo is not None:
        road_users = (*road_users, message_stream(SIGNALS, "json"))
    plans = (message_stream(PLANS, PLANS_ENCODING),) if keeps_plans(resolved.session) else ()
    if gives_advice(resolved.session) or hears_advice(resolved.session):
        plans = (*plans, message_stream(ADVICE))
    own = () if signals is None else (stream_of(signals),)
    return new_bundle(resolved, console, folder, given, (message_stream(ACTS), *road_users, *plans, *own))


def new_bundle(
    resolved: ResolvedSession, console: Console, folder: Path, given: Given, messages: Sequence[Stream]
) -> BundleWriter:
    """Begin the bundle of a drive: its session in full, its provenance, an open log.

    Args:
        resolved: the session.
        console: the console that it makes.
        folder: new, or empty.
        given: what whoever starts the drive says of it.
        messages: the log's streams beside that of the state vectors.

    Raises:
        RecordingError: it cannot be written, or something given is too long.
    """
    world, maps = (None, {}) if resolved.world is None else enclosed(resolved.world)
    text = to_text(msgspec.structs.replace(resolved, world=world))
    header = LogHeader(
        tick_hz=console.tick_hz,
        streams=(vector_stream(console.columns, INPUT_WIDTH), *messages),
        console_version=__version__,
        source_sha256=sources_sha256(console),
        session_sha256=hashlib.sha256(text.encode()).hexdigest(),
    )
    has_motor = console.force_feedback is not None and not console.platform.turns_in_place  # a robot has no torque
    shares = shares_by_speed(read(console.settings, SETTINGS.force)) if has_motor else ()
    provenance = provenance_at_start(resolved.session.title, given, shares)
    return BundleWriter(folder, header, {SESSION_FILE: text, **maps}, package_versions(), provenance)
