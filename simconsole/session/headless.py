"""Opens a drive that runs as fast as it can, all of it in one process."""

import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from subprocess import Popen
from typing import TYPE_CHECKING, Any, NamedTuple

from simconsole.control.requests.refusals import steering_limit
from simconsole.drivers.own_controller import NO_OWN_CODE, OwnCode, OwnParts
from simconsole.faults.schedule import with_faults
from simconsole.processes.lifetimes import Interrupt, end, tell_to_end
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.session import SessionProfile
from simconsole.session.advice.advice_worker import ToldAdvice, hears_advice
from simconsole.session.autopilot_program import PROGRAM_END_S, new_nonce, own_token, start_autopilot
from simconsole.session.lockstep import STAND_S, LockstepLink, LockstepServer
from simconsole.session.opened import Opened, commands_over_link, outputs_of, summary_of, traffic_of
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.recorder import Log, LogRecorder
from simconsole.session.seat import open_cockpit
from simconsole.session.traffic_source import TrafficSource
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.tick.collision_end import CollisionEnd
from simconsole.tick.isolation import isolated
from simconsole.tick.loop import Components, Standby
from simconsole.values.errors import BridgeError, ProfileError
from simconsole.values.latency import LatencyStatistics
from simconsole.values.protocols import CommandSource, NobodyCommands, Output
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import open_world, road_signals, route_points, shown_map

LOOKED_AT = 64
"""In a drive that is not paced, hops are timed in each 64th tick."""
LOOK_S = 0.2
"""How often a wait for another process checks whether it was cancelled."""

if TYPE_CHECKING:
    from simconsole.bridge.console.surroundings import Surroundings
    from simconsole.bridge.transport.lockstep_server import LockstepBridge
    from simconsole.canbus.bus.worker import HeadlessCan
    from simconsole.recording.imports.bag_commands import BagCommands


def _idle(snapshot: Snapshot) -> None:
    """Sleep while simulated time stands, where no other standby function waits."""
    time.sleep(STAND_S)


class _RosSide(NamedTuple):
    """Who commands over ROS, and what else of a drive that brings; nobody."""

    commands: CommandSource = NobodyCommands()
    outputs: tuple[Output, ...] = ()
    standby: tuple[Standby, ...] = (_idle,)
    counters: Callable[[], dict[str, Any]] = dict
    take_acts: Callable[[], list[bytes]] = list


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
        ProfileError: lockstep without a bridge, or no such controller as it names.
        RecordingError: the bag with its commands cannot be used.
        BridgeError: the bridge cannot listen, or the autopilot did not connect.
        CanError: the CAN bus cannot be opened.
        DeviceError: a device is missing.
    """
    traffic, unpushable = others or traffic_of(resolved, console, stack), CollisionEnd(console.platform)
    if link is not None and resolved.session.features.controller is not None:
        raise ProfileError("features.controller: value given: without scenario.platforms: it drives one vehicle")
    advice = ToldAdvice() if hears_advice(resolved.session) else None
    parts, pace = (
        OwnParts(_with_named(own, resolved, console), resolved.session.mode.control_period_ticks),
        UnpacedPacer(),
    )
    if parts.controller is not None:
        link = lockstep_link(parts.controller, resolved.session, interrupt)
        ros = _RosSide(commands_over_link(link, resolved, console), (link,), counters=link.counters)
    elif resolved.session.mode.pacing == "lockstep":
        link = link or _open_lockstep(resolved, console, bundle, interrupt, stack, traffic, advice)
        commands = commands_over_link(link, resolved, console)
        ros = _RosSide(commands, (link,), (link.stand,), link.counters, link.take_acts)
    elif resolved.session.features.commands is not None:
        bag = _open_bag(resolved.session, console, stack)
        ros = _RosSide(bag, (bag,), counters=bag.summary)
    else:
        ros = _RosSide()
    can = _open_can(resolved, console, bundle, stack)
    outputs = tuple(part for part in (can, parts.observer) if part is not None)
    cockpit = open_cockpit(resolved, console, stack)
    recorder = LogRecorder(log, ros.take_acts, traffic, advice, own.signals)
    components = Components(
        devices=cockpit.devices,
        commands=ros.commands,
        recorder=recorder,
        outputs=(*cockpit.outputs, *outputs_of(traffic), *unpushable.outputs, *ros.outputs, *outputs),
        pace=pace,
        seat=cockpit.seat,
        ecu=can or NobodyCommands(),
        standby=(*ros.standby, *(() if can is None else (can.listen,))),
        road_users=traffic,
    )
    latencies = LatencyStatistics(time.monotonic_ns, console.tick_hz, every=LOOKED_AT)
    faulty = with_faults(scripted(components), resolved, console.tick_hz)
    components = isolated(faulty, UnpacedPacer)._replace(latencies=latencies)

    def summary() -> dict[str, Any]:
        own = {**ros.counters(), **({} if can is None else can.summary()), **recorder.acts_summary()}
        own |= {**summary_of(traffic), **unpushable.summary()}
        return {**pace.summary(), **own, "latency_us": latencies.summary_us()}

    return Opened(
        components,
        lambda snapshot: parts.ended(snapshot) or cockpit.finished(snapshot),
        summary,
        identities=cockpit.identities,
        left=unpushable.ended,
        failure=lambda: parts.failure,
    )


def _with_named(own: OwnCode, resolved: ResolvedSession, console: Console) -> OwnCode:
    """Return `own` with the controller that the session names, unless it has one."""
    choice = resolved.session.features.controller
    if choice is None or own.controller is not None:
        return own
    from simconsole.drivers.registered import named_controller

    route = None if resolved.world is None else open_world(resolved.world).route
    period_s = resolved.session.mode.control_period_ticks / console.tick_hz
    return own._replace(controller=named_controller(choice, route, console.platform, period_s))


def _open_lockstep(
    resolved: ResolvedSession,
    console: Console,
    folder: Path,
    interrupt: Interrupt,
    stack: ExitStack,
    traffic: TrafficSource | None,
    advice: ToldAdvice | None,
) -> LockstepLink:
    from simconsole.bridge.transport.lockstep_server import LockstepBridge
    from simconsole.session.view.external_view import display_settings, external_view
    from simconsole.session.view.view_job import view_job

    session = resolved.session
    if session.outputs.bridge is None:
        raise ProfileError("outputs.bridge: value missing: a bridge, where mode.pacing is lockstep")
    token, drive = own_token(session), new_nonce()
    around = surroundings(resolved, console, traffic)._replace(on_advice=None if advice is None else advice.take)
    if session.outputs.bridge.external_view:
        around = around._replace(view=external_view(view_job(resolved), display_settings(resolved)))
    bridge = LockstepBridge(
        session.outputs.bridge,
        odometry_hz=session.mode.control_hz,
        folder=folder,
        drive=drive,
        around=around,
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


def surroundings(resolved: ResolvedSession, console: Console, traffic: TrafficSource | None) -> "Surroundings":
    """Return what a bridge in lockstep tells of beside the state vector; the view's topics are not among it."""
    from simconsole.bridge.console.surroundings import Surroundings
    from simconsole.session.robots import robot_at_work

    return Surroundings(
        route=route_points(resolved.world),
        shown_map=shown_map(resolved.world),
        signals=(None if traffic is None else traffic.signals()) or road_signals(resolved.world, console.tick_hz),
        road_users=None if traffic is None else traffic.newest,
        robot=robot_at_work(resolved.vehicle, resolved.world),
        steering=steering_limit(resolved.session.features.control, console.platform.wheelbase_m),
    )


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
