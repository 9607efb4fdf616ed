"""Opens the components that a session's profile names, for headless and for paced drives."""

import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from subprocess import Popen
from typing import TYPE_CHECKING, Any, NamedTuple

from simconsole.bridge.link.delay import over_link
from simconsole.control.requests.refusals import steering_limit
from simconsole.drivers.own_controller import NO_OWN_CODE, OwnCode, OwnParts
from simconsole.faults.schedule import with_faults
from simconsole.processes.lifetimes import Interrupt, end, tell_to_end, undone
from simconsole.processes.receipts import latencies_of
from simconsole.processes.shared_memory import make_run_folder, remove_run_folder
from simconsole.processes.supervisor import SupervisorHandle
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.session import SessionProfile
from simconsole.recording.bundles.log import LogWriter
from simconsole.session.advice.advice_worker import share_advice
from simconsole.session.autopilot_program import PROGRAM_END_S, new_nonce, own_token, start_autopilot
from simconsole.session.lockstep import STAND_S, LockstepLink, LockstepServer
from simconsole.session.paced import (
    PLAN_HZ,
    CommandPort,
    Memory,
    add_can_memory,
    bridge_address,
    bridge_summary,
    can_summary,
    make_memory,
    runs_signals,
    share_plans,
    share_road_users,
    wait_for_can,
    worker_specs,
)
from simconsole.session.pacing import Pacer, UnpacedPacer, realtime_hints
from simconsole.session.preconditions import check_address
from simconsole.session.recorder import Log, LogRecorder
from simconsole.session.seat import open_seating
from simconsole.session.traffic_source import TrafficSource, open_traffic
from simconsole.session.worker_programs import LATENCY
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.tick.collision_end import CollisionEnd
from simconsole.tick.isolation import isolated
from simconsole.tick.loop import Components, Standby
from simconsole.values.errors import BridgeError, ProfileError
from simconsole.values.latency import LatencyStatistics
from simconsole.values.protocols import CommandSource, DeviceIdentity, NobodyCommands, Output
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import road_signals, route_points, shown_map

LOOKED_AT = 64
"""In a drive that is not paced, hops are timed in each 64th tick."""
LOOK_S = 0.2
"""How often a wait for another process checks whether it was cancelled."""

if TYPE_CHECKING:
    from simconsole.bridge.transport.lockstep_server import LockstepBridge
    from simconsole.canbus.bus.worker import HeadlessCan
    from simconsole.recording.imports.bag_commands import BagCommands


class Opened(NamedTuple):
    """The components of a drive, ready to run."""

    components: Components
    finished: Callable[[Snapshot], bool]
    summary: Callable[[], dict[str, Any]]
    bridge_url: str | None = None
    """Where the bridge listens, of a paced drive."""
    identities: tuple[DeviceIdentity, ...] = ()
    """Of the cockpit's devices."""
    left: Callable[[], bool] = lambda: False
    """Whether the driver has closed the window, or the drive cannot go on: it ends in order, as by a signal."""
    failure: Callable[[], BaseException | None] = lambda: None
    """What a lab's own code has raised; it has ended the drive."""


def open_headless(
    resolved: ResolvedSession,
    console: Console,
    log: Log,
    bundle: Path,
    interrupt: Interrupt,
    stack: ExitStack,
    own: OwnCode = NO_OWN_CODE,
    scripted: Callable[[Components], Components] = lambda components: components,
    link: LockstepLink | None = None,
    others: TrafficSource | None = None,
) -> Opened:
    """Open a drive that runs as fast as it can, all of it in this process. A raised `interrupt` ends all waiting.

    A controller of `own` drives in the place of whoever the session names, as in lockstep. `scripted` puts what a
    scenario holds into the parts, before faults act on them; `others` are its road users, in the place of traffic. A
    platform of several brings its `link` to the server that they share.

    Raises:
        ProfileError: lockstep without a bridge.
        RecordingError: the bag with its commands cannot be used.
        BridgeError: the bridge cannot listen, or the autopilot did not connect.
        CanError: the CAN bus cannot be opened.
        DeviceError: a device is missing.
    """
    commands: CommandSource = NobodyCommands()
    outputs: tuple[Output, ...] = ()
    pace = UnpacedPacer()
    standby: tuple[Standby, ...] = (_idle,)
    counters: Callable[[], dict[str, Any]] = dict
    of_can: Callable[[], dict[str, Any]] = dict
    take_acts: Callable[[], list[bytes]] = list
    traffic, unpushable = others or _open_traffic(resolved, console, stack), CollisionEnd(console.platform)
    parts = OwnParts(own, resolved.session.mode.control_period_ticks)
    if parts.controller is not None:
        link = lockstep_link(parts.controller, resolved.session, interrupt)
        commands, outputs, counters = _over_link(link, resolved, console), (link,), link.counters
    elif resolved.session.mode.pacing == "lockstep":
        link = link or _open_lockstep(resolved, console, bundle, interrupt, stack, traffic)
        commands, outputs, standby = _over_link(link, resolved, console), (link,), (link.stand,)
        counters, take_acts = link.counters, link.take_acts
    elif resolved.session.features.commands is not None:
        bag = _open_bag(resolved.session, console, stack)
        commands, outputs, counters = bag, (bag,), bag.summary
    can = _open_can(resolved, console, bundle, stack)
    if can is not None:
        outputs, of_can = (*outputs, can), can.summary
    if parts.observer is not None:
        outputs = (*outputs, parts.observer)
    seating = open_seating(resolved, console, stack)
    recorder = LogRecorder(log, take_acts, traffic, own.signals)
    components = Components(
        devices=seating.devices,
        commands=commands,
        recorder=recorder,
        outputs=(*seating.outputs, *_outputs_of(traffic), *unpushable.outputs, *outputs),
        pace=pace,
        seat=seating.seat,
        ecu=can or NobodyCommands(),
        standby=(*standby, *(() if can is None else (can.listen,))),
        road_users=traffic,
    )
    latencies = LatencyStatistics(time.monotonic_ns, console.tick_hz, every=LOOKED_AT)
    faulty = with_faults(scripted(components), resolved, console.tick_hz)
    components = isolated(faulty, UnpacedPacer)._replace(latencies=latencies)

    def summary() -> dict[str, Any]:
        own = {**counters(), **of_can(), **recorder.acts_summary(), **_summary_of(traffic)}
        own |= unpushable.summary()
        return {**pace.summary(), **own, "latency_us": latencies.summary_us()}

    return Opened(
        components,
        lambda snapshot: parts.ended(snapshot) or seating.finished(snapshot),
        summary,
        identities=seating.identities,
        left=unpushable.ended,
        failure=lambda: parts.failure,
    )


def open_realtime(
    resolved: ResolvedSession,
    console: Console,
    log: LogWriter,
    bundle: Path,
    interrupt: Interrupt,
    stack: ExitStack,
) -> Opened:
    """Open a paced drive: every output in a process of its own, their inputs through shared memory.

    A raised `interrupt` ends all waiting.

    Raises:
        WorkerError: shared memory or the workers cannot be created.
        BridgeError: the bridge worker does not listen.
        CanError: the CAN worker does not open its bus.
        ProfileError: the bridge's own message types cannot be used.
        DeviceError: a device is missing.
    """
    if resolved.session.outputs.bridge is not None:
        check_address(resolved.session.outputs.bridge)
    token, drive = own_token(resolved.session), new_nonce()
    folder = make_run_folder()
    stack.callback(remove_run_folder, folder)
    opening = stack.enter_context(ExitStack())
    opening.enter_context(undone(lambda: remove_run_folder(folder)))
    memory = make_memory(folder, console)
    traffic, unpushable = _open_traffic(resolved, console, stack, folder), CollisionEnd(console.platform)
    plans = share_plans(resolved.session, folder)
    recorder = LogRecorder(log, memory.acts.take, traffic, plans, share_advice(resolved.session, folder))
    if traffic is not None:
        share_road_users(traffic, folder, runs_signals(resolved))
    ecu = add_can_memory(resolved, console, folder)
    supervisor = SupervisorHandle(folder, worker_specs(resolved, console, folder, bundle, drive))
    programs = _started(supervisor, memory, stack)
    opening.close()  # from here on the supervisor removes the folder, however the core ends
    address = _await_workers(resolved, folder, programs, (drive, token), supervisor, interrupt.check, traffic)
    with_window = resolved.session.outputs.hud is not None
    seating = open_seating(resolved, console, stack, memory.keys if with_window else None)
    missing = stack.enter_context(realtime_hints())
    pace, latencies = Pacer(console.tick_hz), LatencyStatistics(time.monotonic_ns, console.tick_hz)
    components = _paced_components(
        resolved,
        console,
        Components(
            devices=seating.devices,
            commands=memory.commands,
            recorder=recorder,
            outputs=(*seating.outputs, *_outputs_of(traffic), *unpushable.outputs, memory.snapshots, supervisor),
            pace=pace,
            seat=seating.seat,
            ecu=ecu,
            standby=(supervisor.publish, memory.commands.stand),
            road_users=traffic,
        ),
    )._replace(latencies=latencies)

    def summary() -> dict[str, Any]:
        latency = {**latencies.summary_us(), **latencies_of(folder, LATENCY)}
        workers = {"station_restarts": supervisor.counters(), **bridge_summary(folder), **can_summary(folder)}
        own = {**recorder.acts_summary(), **_summary_of(traffic), **unpushable.summary()}
        own |= {"latency_us": latency, "not_granted": missing}
        return {**pace.summary(), **workers, **own}

    return Opened(
        components=components,
        finished=seating.finished,
        summary=summary,
        bridge_url=address,
        identities=seating.identities,
        left=lambda: memory.keys.ended() or unpushable.ended(),
    )


def _open_traffic(
    resolved: ResolvedSession, console: Console, stack: ExitStack, run_folder: Path | None = None
) -> TrafficSource | None:
    traffic = open_traffic(resolved, console, run_folder)
    if traffic is not None:
        stack.callback(traffic.close)
    return traffic


def _outputs_of(traffic: TrafficSource | None) -> tuple[Output, ...]:
    return () if traffic is None else (traffic,)


def _summary_of(traffic: TrafficSource | None) -> dict[str, Any]:
    return {} if traffic is None else traffic.summary()


def _started(supervisor: SupervisorHandle, memory: Memory, stack: ExitStack) -> "list[Popen[bytes]]":
    """Start the supervisor; return the list of programs that end with the drive, before the workers do."""
    programs: list[Popen[bytes]] = []
    stack.callback(end, programs, PROGRAM_END_S)
    stack.callback(supervisor.stop, lambda: memory.snapshots.is_empty)
    stack.callback(tell_to_end, programs)
    supervisor.start()
    return programs


def _paced_components(resolved: ResolvedSession, console: Console, plain: Components) -> Components:
    """Return the components with the session's link and faults around them, each isolated."""
    standby = (*plain.standby, *((plain.ecu.stand,) if isinstance(plain.ecu, CommandPort) else ()))
    linked = plain._replace(commands=_over_link(plain.commands, resolved, console), standby=standby)
    return isolated(with_faults(linked, resolved, console.tick_hz), lambda: Pacer(console.tick_hz))


def _over_link(source: CommandSource, resolved: ResolvedSession, console: Console) -> CommandSource:
    """Return the ROS side's commands as they arrive over the link that the session describes."""
    bridge = resolved.session.outputs.bridge
    return source if bridge is None else over_link(source, bridge.link, console.tick_hz)


def _await_workers(
    resolved: ResolvedSession,
    folder: Path,
    programs: "list[Popen[bytes]]",
    credentials: tuple[str, str | None],
    supervisor: SupervisorHandle,
    check: Callable[[], None],
    traffic: TrafficSource | None,
) -> str | None:
    """Wait until traffic, bridge and CAN bus are there and return the bridge's address.

    Adds the session's own autopilot to `programs`, with the drive's nonce and the token of `credentials`.
    """
    session = resolved.session

    def alive() -> bool:
        check()
        return supervisor.alive()

    if traffic is not None:
        traffic.await_worker(alive)
    address, bridge = None, session.outputs.bridge
    if bridge is not None:
        address = bridge_address(folder, lambda: alive() and not supervisor.counters().get("bridge"))
        if session.features.autopilot is not None:
            programs.append(start_autopilot(address, session, bridge, *credentials, plan_hz=PLAN_HZ))
    if session.outputs.can is not None:
        wait_for_can(folder, lambda: alive() and not supervisor.counters().get("canbus"))
    return address


def _idle(snapshot: Snapshot) -> None:
    """Sleep while simulated time stands, where no other standby function waits."""
    time.sleep(STAND_S)


def _open_lockstep(
    resolved: ResolvedSession,
    console: Console,
    folder: Path,
    interrupt: Interrupt,
    stack: ExitStack,
    traffic: TrafficSource | None,
) -> LockstepLink:
    from simconsole.bridge.console.surroundings import Surroundings
    from simconsole.bridge.console.view_topics import NO_VIEW
    from simconsole.bridge.transport.lockstep_server import LockstepBridge
    from simconsole.session.external_view import display_settings, external_view
    from simconsole.session.robots import robot_at_work
    from simconsole.session.view_job import view_job

    session = resolved.session
    if session.outputs.bridge is None:
        raise ProfileError("outputs.bridge: value missing: a bridge, where mode.pacing is lockstep")
    token, drive = own_token(session), new_nonce()
    view = NO_VIEW
    if session.outputs.bridge.external_view:
        view = external_view(view_job(resolved), display_settings(resolved))
    bridge = LockstepBridge(
        session.outputs.bridge,
        odometry_hz=session.mode.control_hz,
        folder=folder,
        drive=drive,
        around=Surroundings(
            route=route_points(resolved.world),
            shown_map=shown_map(resolved.world),
            signals=(None if traffic is None else traffic.signals()) or road_signals(resolved.world, console.tick_hz),
            road_users=None if traffic is None else traffic.newest,
            view=view,
            robot=robot_at_work(resolved.vehicle, resolved.world),
            steering=steering_limit(session.features.control, console.platform.wheelbase_m),
        ),
    )
    program = None
    if session.features.autopilot is not None:
        program = start_autopilot(bridge.url, session, session.outputs.bridge, drive, token)
        stack.callback(end, [program], PROGRAM_END_S)
    stack.callback(bridge.close)  # closes its clients' connections before the program's end is waited for
    if program is not None:
        stack.callback(tell_to_end, [program])
    _wait_for_controller(bridge, program, session.mode.wait_for_controller_s, interrupt.check)
    return lockstep_link(bridge, session, interrupt)


def lockstep_link(server: LockstepServer, session: SessionProfile, interrupt: Interrupt) -> LockstepLink:
    """Return what the drive loop sees of a bridge in lockstep."""
    mode = session.mode
    return LockstepLink(server, mode.control_period_ticks, mode.answer_timeout_s, lambda: interrupt.raised)


def _open_bag(session: SessionProfile, console: Console, stack: ExitStack) -> "BagCommands":
    from simconsole.recording.imports.bag_commands import BagCommands, bag_choice

    choice = bag_choice(session.features.commands or "")
    bag = BagCommands(choice, session.outputs.bridge or BridgeProfile(), console.tick_hz)
    stack.callback(bag.close)
    return bag


def _wait_for_controller(
    bridge: "LockstepBridge", program: Popen[bytes] | None, patience_s: float, check: Callable[[], None]
) -> None:
    deadline_s = time.monotonic() + patience_s
    while (left_s := deadline_s - time.monotonic()) > 0.0:
        if bridge.wait_for_client(min(left_s, LOOK_S)):
            return
        check()
    if program is not None and program.poll() is not None:
        raise BridgeError(f"the autopilot ended with exit code {program.returncode} before it connected")
    raise BridgeError(f"no controller subscribed to odometry at {bridge.url} within {patience_s:g} s")


def _open_can(resolved: ResolvedSession, console: Console, bundle: Path, stack: ExitStack) -> "HeadlessCan | None":
    session = resolved.session
    if session.outputs.can is None:
        return None
    from simconsole.canbus.bus.worker import HeadlessCan, put_on_bus
    from simconsole.canbus.messages import wheel_columns

    on_bus = put_on_bus(
        session.outputs.can,
        console.tick_hz,
        wheels=wheel_columns(console.columns),
        folder=bundle,
    )
    stack.callback(on_bus.port.close)
    return HeadlessCan(on_bus)
