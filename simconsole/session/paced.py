"""A paced drive's outputs and inputs: shared memory, the workers behind it, and the programs beside them."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from simconsole.bridge.console.operator_acts import ACT_BYTES, ACTS_MAX
from simconsole.control.requests.refusals import steering_limit
from simconsole.processes.byte_slot import ByteSlot, Piece
from simconsole.processes.shared_memory import EventCounters, Ring, TextQueue
from simconsole.processes.worker import Worker, WorkerSpec
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.world import RoadsProfile
from simconsole.recording.log_header import PLANS
from simconsole.session.advice.advice_worker import AdviceWorker, gives_advice
from simconsole.session.autopilot_program import own_token
from simconsole.session.camera_worker import CameraWorker
from simconsole.session.sumo.sumo_memory import signal_bytes, signals_within
from simconsole.session.sumo.sumo_worker import NAME as SUMO
from simconsole.session.sumo.sumo_worker import sumo_worker
from simconsole.session.traffic_source import ShowRoadUsers, TrafficSource, ego_box
from simconsole.session.view.external_view import display_settings
from simconsole.session.view.view_job import save_view_job, view_job
from simconsole.session.worker_programs import (
    ACTS,
    ADDRESS,
    CAMERA,
    CAN_COMMAND,
    CAN_EVENTS,
    CAN_STATUS,
    COMMAND,
    COUNTS,
    EVENTS,
    KEY_CODES,
    PLAN,
    ROAD_USERS,
    ROAD_USERS_CAPACITY,
    SIGNALS,
    SLOT_CAPACITY,
    SNAPSHOT_CAPACITY,
    SNAPSHOTS,
    VIEW_JOB,
    BridgeWorker,
    CanWorker,
    HudWorker,
    command_of,
)
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import BridgeError, CanError
from simconsole.values.key_codes import Key
from simconsole.values.latency import Hop
from simconsole.values.planned_path import MOST_BYTES
from simconsole.values.protocols import CommandSource, NobodyCommands
from simconsole.values.signals import NEVER_TICKS, NO_COMMAND, EventInput, RemoteCommand
from simconsole.values.state_vector import LAYOUT, Snapshot
from simconsole.values.units import NS_PER_S
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.roads.road_world import roads_of
from simconsole.world.roads.running import RunningNow
from simconsole.world.traffic.road_users import RECORD_WIDTH, RoadUsersAt, to_record

START_PATIENCE_S = 60.0
"""How long a worker may take to be ready: a machine that is busy, and compiles for the first time, takes this long."""
PLAN_HZ = 5.0
"""How often the session's own autopilot is asked to tell what it plans."""
JPEG_BYTES_PER_PX = 3
"""No JPEG is longer than the picture itself, but for noise."""


class RingOutput:
    """Publishes every tick into the ring: the only thing the core does for all workers together."""

    hop = Hop.PUBLISH

    def __init__(self, ring: Ring) -> None:
        self._ring = ring

    @property
    def is_empty(self) -> bool:
        """Whether nothing was published yet."""
        return self._ring.newest == 0

    def publish(self, snapshot: Snapshot) -> None:
        """Copy one state vector; its second stamp tells when, for the latency statistics."""
        self._ring.write(snapshot.vector, snapshot.tick, time.monotonic_ns())


class CommandPort:
    """A worker's command slot and event counters, read once a tick. Ages are whole ticks since receipt."""

    def __init__(self, slot: Ring, events: EventCounters, tick_hz: int) -> None:
        self._slot = slot
        self._events = events
        self._tick_hz = tick_hz
        self._seen = 0
        self._command = NO_COMMAND
        self._receipt_ns = -1
        self._stood_at_tick = self._stood_from_ns = self._stood_until_ns = -1

    def stand(self, snapshot: Snapshot) -> None:
        """Note that simulated time stands: commands do not age meanwhile."""
        now_ns = time.monotonic_ns()
        if snapshot.tick != self._stood_at_tick:
            self._stood_at_tick, self._stood_from_ns = snapshot.tick, now_ns
        self._stood_until_ns = now_ns

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command and all edges since the last call."""
        if self._slot.newest != self._seen:
            record = self._slot.latest()
            if record is not None:
                self._seen, self._receipt_ns = record.number, record.stamp
                self._command = command_of(record.values)
        age_ticks = NEVER_TICKS
        if self._receipt_ns >= 0:
            stood_ns = max(0, self._stood_until_ns - max(self._stood_from_ns, self._receipt_ns))
            age_ns = max(0, time.monotonic_ns() - self._receipt_ns - stood_ns)
            age_ticks = float(age_ns * self._tick_hz // NS_PER_S)
        return self._command._replace(age_ticks=age_ticks), EventInput(events=float(self._events.take()))


class KeyPort:
    """The window's keys as the keyboard source wants them: (mask, age in whole ticks)."""

    def __init__(self, slot: Ring, tick_hz: int) -> None:
        self._slot = slot
        self._tick_hz = tick_hz
        self._seen = 0
        self._ended = False

    def ended(self) -> bool:
        """Return whether the window was closed, or its key pressed that ends the drive."""
        if self._slot.newest != self._seen:
            record = self._slot.latest()
            if record is not None:
                self._seen = record.number
                self._ended |= bool(int(record.values[0]) & Key.END)
        return self._ended

    def __call__(self) -> tuple[int, int]:
        """Return the keys held now and how long ago the window said so."""
        record = self._slot.latest()
        if record is None:
            return 0, int(NEVER_TICKS)
        age_ns = max(0, time.monotonic_ns() - record.stamp)
        return int(record.values[0]), age_ns * self._tick_hz // NS_PER_S


class Memory(NamedTuple):
    """What the core shares with its workers, from the core's side."""

    snapshots: RingOutput
    commands: CommandPort
    keys: KeyPort
    acts: TextQueue


def make_memory(folder: Path, console: Console) -> Memory:
    """Make every file of the run folder, as their writers' side or readers' side in the core.

    Raises:
        WorkerError: one cannot be made.
    """
    snapshots = Ring.create(folder / SNAPSHOTS, console.width, SNAPSHOT_CAPACITY)
    command = Ring.create(folder / COMMAND, LAYOUT.ros.width, SLOT_CAPACITY)
    keys = Ring.create(folder / KEY_CODES, 1, SLOT_CAPACITY)
    events = EventCounters.create(folder / EVENTS)
    return Memory(
        snapshots=RingOutput(snapshots),
        commands=CommandPort(command, events, console.tick_hz),
        keys=KeyPort(keys, console.tick_hz),
        acts=TextQueue.create(folder / ACTS, ACT_BYTES, ACTS_MAX),
    )


def add_can_memory(resolved: ResolvedSession, console: Console, folder: Path) -> CommandSource:
    """Make the CAN worker's files where the session has one; return where the ECU's commands come from.

    Raises:
        WorkerError: one cannot be made.
    """
    if resolved.session.outputs.can is None:
        return NobodyCommands()
    slot = Ring.create(folder / CAN_COMMAND, LAYOUT.ros.width, SLOT_CAPACITY)
    return CommandPort(slot, EventCounters.create(folder / CAN_EVENTS), console.tick_hz)


def runs_signals(resolved: ResolvedSession) -> RoadMap | None:
    """Return the map whose signals another simulator runs; None: they run their own programs."""
    traffic = resolved.session.environment.traffic
    if traffic is None or traffic.sumo is None or not isinstance(resolved.world, RoadsProfile):
        return None
    roads = roads_of(open_world(resolved.world))
    return None if roads is None else roads.road_map


def share_road_users(traffic: TrafficSource, folder: Path, signals_of: RoadMap | None = None) -> None:
    """Give every worker the road users, in a ring of their own; and the signals that another simulator runs.

    Raises:
        WorkerError: it cannot be made.
    """
    ring = Ring.create(folder / ROAD_USERS, RECORD_WIDTH, ROAD_USERS_CAPACITY)
    if signals_of is not None:
        traffic.show_to(_share_signals(folder, signal_bytes(signals_of)))
    traffic.show_to(lambda at: ring.write(to_record(at.users), at.tick))


def _share_signals(folder: Path, room: int) -> ShowRoadUsers:
    """Return what shows the signals to every worker whenever one has changed."""
    slot = ByteSlot.create(folder / SIGNALS, room)
    told: RunningNow | None = None

    def show(at: RoadUsersAt) -> None:
        nonlocal told
        if at.signals is not told:
            told = at.signals
            slot.write(at.tick, signals_within(told, room))

    return show


def keeps_plans(session: SessionProfile) -> bool:
    """Return whether a drive keeps what controllers plan: where operators watch one platform, and nobody waits."""
    watched = session.mode.pacing == "realtime" and session.outputs.bridge is not None
    return watched and not session.scenario.platforms


class PlanSource:
    """The newest plan, for the log."""

    def __init__(self, slot: ByteSlot) -> None:
        self._slot = slot
        self._taken: Piece | None = None

    def take_messages(self, tick: int) -> list[tuple[str, bytes]]:
        """Return the newest plan, if nobody has taken it yet."""
        piece = self._slot.newest()
        if piece is None or piece is self._taken:
            return []
        self._taken = piece
        return [(PLANS, piece.content)]


def share_plans(session: SessionProfile, folder: Path) -> PlanSource | None:
    """Make the memory through which plans come; None where the drive keeps none.

    Raises:
        WorkerError: it cannot be made.
    """
    return PlanSource(ByteSlot.create(folder / PLAN, MOST_BYTES)) if keeps_plans(session) else None


def worker_specs(
    resolved: ResolvedSession, console: Console, folder: Path, bundle: Path, drive: str, *, has_traffic: bool
) -> list[WorkerSpec]:
    """Return the workers that the session's outputs name; writes what they need into the run folder.

    `drive` is the nonce of the drive; with `has_traffic` there are road users to be shown.
    """
    outputs, tick_hz, bridge = resolved.session.outputs, console.tick_hz, resolved.session.outputs.bridge
    has_bridge, has_can = outputs.bridge is not None, outputs.can is not None
    made = {
        SUMO: sumo_worker(resolved, tick_hz, ego_box(console.platform.initial_vehicle, console.platform)),
        "bridge": _bridge_worker(resolved, console, bundle, drive),
        "advice": _advice_worker(resolved, drive),
    }
    workers: dict[str, Worker] = {name: worker for name, worker in made.items() if worker is not None}
    if outputs.can is not None:
        from simconsole.canbus.messages import wheel_columns

        workers["canbus"] = CanWorker(
            profile=outputs.can, tick_hz=tick_hz, wheels=wheel_columns(console.columns), bundle=str(bundle.absolute())
        )
    has_view = outputs.hud is not None and outputs.hud.view is not None
    if has_view or (bridge is not None and (bridge.external_view or bridge.camera is not None)):
        save_view_job(folder / VIEW_JOB, view_job(resolved))
    if bridge is not None and bridge.camera is not None:
        camera = bridge.camera
        ByteSlot.create(folder / CAMERA, camera.width_px * camera.height_px * JPEG_BYTES_PER_PX)
        workers["camera"] = CameraWorker(profile=bridge.camera, tick_hz=tick_hz, has_traffic=has_traffic)
    if outputs.hud is not None:
        workers["hud"] = HudWorker(
            profile=outputs.hud,
            settings=display_settings(resolved),
            tick_hz=tick_hz,
            has_can=has_can,
            has_bridge=has_bridge,
            has_traffic=has_traffic,
            has_advice=gives_advice(resolved.session),
        )
    if outputs.hud is not None and outputs.sound is not None:
        from simconsole.session.sound_worker import SoundWorker, sound_settings

        settings = sound_settings(resolved, console)
        workers["sound"] = SoundWorker(
            profile=outputs.sound, settings=settings, tick_hz=tick_hz, has_traffic=has_traffic
        )
    if outputs.scene is not None:
        from simconsole.session.scene_worker import LIVE_SCENE, SceneWorker, scene_source

        workers["scene"] = SceneWorker(
            path=str((bundle / LIVE_SCENE).absolute()),
            source=scene_source(resolved, console.columns, tick_hz),
            has_bridge=has_bridge,
            has_traffic=has_traffic,
        )
    return [WorkerSpec.of(name, worker) for name, worker in workers.items()]


def _bridge_worker(resolved: ResolvedSession, console: Console, bundle: Path, drive: str) -> BridgeWorker | None:
    session, bridge = resolved.session, resolved.session.outputs.bridge
    if bridge is None:
        return None
    return BridgeWorker(
        profile=bridge,
        tick_hz=console.tick_hz,
        drive=drive,
        bundle=str(bundle.absolute()),
        steering=steering_limit(session.features.control, console.platform.wheelbase_m),
        display=display_settings(resolved) if bridge.external_view else None,
        has_traffic=session.environment.traffic is not None,
        world=resolved.world,
        vehicle=resolved.vehicle if isinstance(resolved.vehicle, TurtlebotProfile) else None,
    )


def _advice_worker(resolved: ResolvedSession, drive: str) -> AdviceWorker | None:
    bridge = resolved.session.outputs.bridge
    if bridge is None or resolved.world is None or not gives_advice(resolved.session):
        return None
    return AdviceWorker(
        world=resolved.world,
        vehicle=resolved.vehicle,
        drive=drive,
        address=ADDRESS,
        token=own_token(resolved.session),
        certificate=bridge.certificate,
        namespace=bridge.namespace,
        rename=bridge.rename,
    )


def bridge_address(folder: Path, alive: Callable[[], bool], patience_s: float = START_PATIENCE_S) -> str:
    """Wait until the bridge worker listens and return its address.

    Raises:
        BridgeError: it does not, or not in time.
    """
    missing = _why_missing(folder / ADDRESS, alive, patience_s)
    if missing:
        raise BridgeError(f"the bridge does not listen{missing}")
    return (folder / ADDRESS).read_text("utf-8")


def wait_for_can(folder: Path, alive: Callable[[], bool], patience_s: float = START_PATIENCE_S) -> None:
    """Wait until the CAN worker has opened its bus.

    Raises:
        CanError: it does not, or not in time.
    """
    missing = _why_missing(folder / CAN_STATUS, alive, patience_s)
    if missing:
        raise CanError(f"the CAN bus is not open{missing}")


def _why_missing(path: Path, alive: Callable[[], bool], patience_s: float) -> str:
    """Wait until a worker has written a file; return why it has not, empty where it has."""
    deadline_s = time.monotonic() + patience_s
    while not path.exists():
        if not alive():
            return "; the worker's own message stands above"
        if time.monotonic() >= deadline_s:
            return f" within {patience_s:g} s"
        time.sleep(0.02)
    return ""


def bridge_summary(folder: Path) -> dict[str, Any]:
    """Return the bridge worker's newest counters, at most a second old; empty without one."""
    try:
        return {"bridge": msgspec.json.decode((folder / COUNTS).read_bytes())}
    except (OSError, msgspec.DecodeError):
        return {}


def can_summary(folder: Path) -> dict[str, Any]:
    """Return the CAN worker's newest status, at most a second old; empty without one."""
    try:
        return {"can": msgspec.json.decode((folder / CAN_STATUS).read_bytes())}
    except (OSError, msgspec.DecodeError):
        return {}
