"""A paced drive's outputs and inputs: shared memory, the workers behind it, and the programs beside them."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from simconsole.bridge.console.operator_acts import ACT_BYTES, ACTS_MAX
from simconsole.control.requests.refusals import steering_limit
from simconsole.processes.byte_slot import ByteSlot
from simconsole.processes.shared_memory import EventCounters, Ring, TextQueue
from simconsole.processes.worker import Worker, WorkerSpec
from simconsole.profiles.vehicle import TurtlebotProfile
from simconsole.session.camera_worker import CameraWorker
from simconsole.session.external_view import display_settings
from simconsole.session.scene_job import LIVE_SCENE, scene_job
from simconsole.session.traffic_source import TrafficSource
from simconsole.session.view_job import save_view_job, view_job
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
    LATENCY,
    ROAD_USERS,
    ROAD_USERS_CAPACITY,
    SCENE_JOB,
    SLOT_CAPACITY,
    SNAPSHOT_CAPACITY,
    SNAPSHOTS,
    VIEW_JOB,
    BridgeWorker,
    CanWorker,
    HudWorker,
    SceneWorker,
    command_of,
)
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import BridgeError, CanError
from simconsole.values.key_codes import Key
from simconsole.values.latency import Hop
from simconsole.values.protocols import CommandSource, NobodyCommands
from simconsole.values.signals import NEVER_TICKS, NO_COMMAND, EventInput, RemoteCommand
from simconsole.values.state_vector import LAYOUT, Snapshot
from simconsole.values.units import NS_PER_S
from simconsole.world.traffic.road_users import RECORD_WIDTH, to_record

START_PATIENCE_S = 20.0
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


def share_road_users(traffic: TrafficSource, folder: Path) -> None:
    """Give every worker the road users, in a ring of their own.

    Raises:
        WorkerError: it cannot be made.
    """
    ring = Ring.create(folder / ROAD_USERS, RECORD_WIDTH, ROAD_USERS_CAPACITY)
    traffic.show_to(lambda at: ring.write(to_record(at.users), at.tick))


def worker_specs(
    resolved: ResolvedSession, console: Console, folder: Path, bundle: Path, drive: str
) -> list[WorkerSpec]:
    """Return the workers that the session's outputs name; writes what they need into the run folder.

    `drive` is the nonce of the drive.
    """
    outputs, tick_hz = resolved.session.outputs, console.tick_hz
    has_bridge, has_can = outputs.bridge is not None, outputs.can is not None
    has_traffic = resolved.session.environment.traffic is not None
    workers: dict[str, Worker] = {}
    if outputs.bridge is not None:
        workers["bridge"] = BridgeWorker(
            profile=outputs.bridge,
            tick_hz=tick_hz,
            drive=drive,
            bundle=str(bundle.absolute()),
            steering=steering_limit(resolved.session.features.control, console.platform.wheelbase_m),
            display=display_settings(resolved) if outputs.bridge.external_view else None,
            has_traffic=has_traffic,
            world=resolved.world,
            vehicle=resolved.vehicle if isinstance(resolved.vehicle, TurtlebotProfile) else None,
        )
    if outputs.can is not None:
        from simconsole.canbus.messages import wheel_columns

        workers["canbus"] = CanWorker(
            profile=outputs.can, tick_hz=tick_hz, wheels=wheel_columns(console.columns), bundle=str(bundle.absolute())
        )
    has_view = outputs.hud is not None and outputs.hud.view is not None
    bridge = outputs.bridge
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
        )
    if outputs.hud is not None and outputs.sound is not None:
        from simconsole.session.sound_worker import SoundWorker, sound_settings

        settings = sound_settings(resolved, console)
        workers["sound"] = SoundWorker(
            profile=outputs.sound, settings=settings, tick_hz=tick_hz, has_traffic=has_traffic
        )
    if outputs.scene is not None:
        from simconsole.scene.viewer.job import save_job

        save_job(folder / SCENE_JOB, scene_job(resolved, console.columns, tick_hz))
        path = str((bundle / LIVE_SCENE).absolute())
        workers["scene"] = SceneWorker(path=path, tick_hz=tick_hz, has_bridge=has_bridge, has_traffic=has_traffic)
    return [WorkerSpec.of(name, worker) for name, worker in workers.items()]


def bridge_address(folder: Path, alive: Callable[[], bool], patience_s: float = START_PATIENCE_S) -> str:
    """Wait until the bridge worker listens and return its address.

    Raises:
        BridgeError: it does not listen in time.
    """
    deadline_s = time.monotonic() + patience_s
    while alive() and time.monotonic() < deadline_s:
        if (folder / ADDRESS).exists():
            return (folder / ADDRESS).read_text("utf-8")
        time.sleep(0.02)
    raise BridgeError("the bridge does not listen; its own message stands above")


def wait_for_can(folder: Path, alive: Callable[[], bool], patience_s: float = START_PATIENCE_S) -> None:
    """Wait until the CAN worker has opened its bus.

    Raises:
        CanError: it does not in time.
    """
    deadline_s = time.monotonic() + patience_s
    while alive() and time.monotonic() < deadline_s:
        if (folder / CAN_STATUS).exists():
            return
        time.sleep(0.02)
    raise CanError("the CAN bus is not open; the worker's own message stands above")


def worker_latencies(folder: Path) -> dict[str, Any]:
    """Return the workers' newest latency statistics, at most a second old, by hop and worker: `receive, hud`."""
    found = {}
    for name in ("bridge", "canbus", "hud"):
        try:
            pages = msgspec.json.decode((folder / f"{LATENCY}.{name}.json").read_bytes(), type=dict[str, Any])
        except (OSError, msgspec.DecodeError):
            continue
        found.update({f"{hop}, {name}": page for hop, page in pages.items()})
    return found


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
