"""Opens a paced drive: every output in a process of its own."""

import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from subprocess import Popen
from typing import Any

import msgspec

from simconsole.faults.schedule import with_faults
from simconsole.processes.lifetimes import Interrupt, end, tell_to_end, undone
from simconsole.processes.receipts import latencies_of
from simconsole.processes.shared_memory import make_run_folder, remove_run_folder
from simconsole.processes.supervisor import SupervisorHandle
from simconsole.recording.bundles.log import LogWriter
from simconsole.session.advice.advice_worker import NewestAdvice, share_advice
from simconsole.session.autopilot_program import PROGRAM_END_S, new_nonce, own_token, start_autopilot
from simconsole.session.opened import Among, Opened, commands_over_link, outputs_of, summary_of, traffic_of
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
from simconsole.session.pacing import Pacer, realtime_hints
from simconsole.session.preconditions import check_address
from simconsole.session.recorder import LogRecorder
from simconsole.session.seat import open_cockpit
from simconsole.session.traffic_source import TrafficSource
from simconsole.session.worker_programs import LATENCY
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.tick.collision_end import CollisionEnd
from simconsole.tick.isolation import isolated
from simconsole.tick.loop import Components
from simconsole.values.latency import LatencyStatistics


def open_realtime(
    resolved: ResolvedSession,
    console: Console,
    log: LogWriter,
    bundle: Path,
    interrupt: Interrupt,
    stack: ExitStack,
    among: Among | None = None,
) -> Opened:
    """Open a paced drive: every output in a process of its own, their inputs through shared memory.

    A raised `interrupt` ends all waiting. `among` is what one of several platforms has with the others: for them the
    session's server, and its traffic where there is any, are opened once.

    Raises:
        WorkerError: shared memory or the workers cannot be created.
        BridgeError: the bridge worker does not listen.
        CanError: the CAN worker does not open its bus.
        ProfileError: the bridge's own message types cannot be used.
        DeviceError: a device is missing.
    """
    own = resolved if among is None else _alone(resolved)
    if own.session.outputs.bridge is not None:
        check_address(own.session.outputs.bridge)
    token, drive = own_token(own.session), new_nonce()
    folder = make_run_folder()
    stack.callback(remove_run_folder, folder)
    opening = stack.enter_context(ExitStack())
    opening.enter_context(undone(lambda: remove_run_folder(folder)))
    memory = make_memory(folder, console)
    traffic = traffic_of(resolved, console, stack, folder) if among is None else among.others
    unpushable, link = CollisionEnd(console.platform), None if among is None else among.link
    plans = share_plans(own.session, folder)
    advice = share_advice(own.session, folder, console.tick_hz)
    recorder = LogRecorder(log, memory.acts.take if link is None else link.take_acts, traffic, plans, advice)
    if traffic is not None:
        share_road_users(traffic, folder, runs_signals(resolved))
    ecu = add_can_memory(resolved, console, folder)
    workers = worker_specs(own, console, folder, bundle, drive, has_traffic=traffic is not None)
    supervisor = SupervisorHandle(folder, workers)
    programs = _started(supervisor if workers else None, memory, stack)
    opening.close()  # from here on the supervisor removes the folder, however the core ends
    address = _await_workers(own, folder, programs, (drive, token), supervisor, interrupt.check, traffic)
    with_window = resolved.session.outputs.hud is not None
    shown = None if advice is None else NewestAdvice(folder)
    cockpit = open_cockpit(resolved, console, stack, memory.keys if with_window else None, shown)
    missing = stack.enter_context(realtime_hints()) if among is None else among.not_granted
    pace = Pacer(console.tick_hz) if among is None else among.pace
    latencies = LatencyStatistics(time.monotonic_ns, console.tick_hz)
    served = () if link is None else (link,)
    components = _paced_components(
        resolved,
        console,
        Components(
            devices=cockpit.devices,
            commands=memory.commands if link is None else link,
            recorder=recorder,
            outputs=(
                *(*cockpit.outputs, *outputs_of(traffic), *unpushable.outputs),
                *(memory.snapshots, *served, supervisor),
            ),
            pace=pace,
            seat=cockpit.seat,
            ecu=ecu,
            standby=(supervisor.publish, memory.commands.stand, *(each.stand for each in served)),
            road_users=traffic,
        ),
    )._replace(latencies=latencies)

    def summary() -> dict[str, Any]:
        latency = {**latencies.summary_us(), **latencies_of(folder, LATENCY)}
        restarts = {"worker_restarts": supervisor.counters(), **bridge_summary(folder), **can_summary(folder)}
        told = {**recorder.acts_summary(), **summary_of(traffic), **unpushable.summary()}
        told |= {"latency_us": latency, "not_granted": missing}
        for each in served:
            told |= each.counters()
        return {**pace.summary(), **restarts, **told}

    return Opened(
        components=components,
        finished=cockpit.finished,
        summary=summary,
        bridge_url=address,
        identities=cockpit.identities,
        left=lambda: memory.keys.ended() or unpushable.ended(),
    )


def _alone(resolved: ResolvedSession) -> ResolvedSession:
    """Return the session of one of several platforms without what is opened once for all: server and traffic."""
    replace, session = msgspec.structs.replace, resolved.session
    outputs, environment = replace(session.outputs, bridge=None), replace(session.environment, traffic=None)
    return replace(resolved, session=replace(session, outputs=outputs, environment=environment))


def _started(supervisor: SupervisorHandle | None, memory: Memory, stack: ExitStack) -> "list[Popen[bytes]]":
    """Start the supervisor, None where nobody has to be looked after.

    Return the list of programs that end with the drive, before the workers do.
    """
    programs: list[Popen[bytes]] = []
    stack.callback(end, programs, PROGRAM_END_S)
    if supervisor is not None:
        stack.callback(supervisor.stop, lambda: memory.snapshots.is_empty)
    stack.callback(tell_to_end, programs)
    if supervisor is not None:
        supervisor.start()
    return programs


def _paced_components(resolved: ResolvedSession, console: Console, plain: Components) -> Components:
    """Return the components with the session's link and faults around them, each isolated."""
    standby = (*plain.standby, *((plain.ecu.stand,) if isinstance(plain.ecu, CommandPort) else ()))
    linked = plain._replace(commands=commands_over_link(plain.commands, resolved, console), standby=standby)
    return isolated(with_faults(linked, resolved, console.tick_hz), lambda: Pacer(console.tick_hz))


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
