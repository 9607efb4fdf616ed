"""The workers of a paced drive: each runs one part's loop between the ring and the slots.

A worker's fields are its whole configuration; `simconsole.processes.worker` brings them into its process.
"""

import math
import time
from collections import deque
from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import msgspec
import numpy as np

from simconsole.control.requests.refusals import SteeringLimit
from simconsole.hud.view import HudSettings
from simconsole.processes.byte_slot import CAPACITY, ByteSlot, Piece
from simconsole.processes.receipts import Receipts
from simconsole.processes.shared_memory import EventCounters, Record, Ring, TextQueue
from simconsole.processes.worker import Worker
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.can import CanProfile
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.view import HudProfile
from simconsole.profiles.world import WorldProfile
from simconsole.session.advice.advice_worker import NewestAdvice
from simconsole.values.host.files import write_atomically
from simconsole.values.kernels import Row
from simconsole.values.labels import LINK_DOWN
from simconsole.values.planned_path import PlannedPath, to_bytes
from simconsole.values.signals import RemoteCommand
from simconsole.values.state_vector import LAYOUT, Snapshot
from simconsole.values.units import tick_time_ns
from simconsole.world.roads.running import NONE_RUNNING, RunningNow, changed
from simconsole.world.traffic.road_users import NOBODY_AT_ALL, RoadUsersAt, from_record

if TYPE_CHECKING:
    from simconsole.bridge.console.camera_topics import ReadCamera
    from simconsole.hud.driver_view.scene import ViewScene

SNAPSHOTS: Final = "snapshots"
COMMAND: Final = "bridge.command"
EVENTS: Final = "bridge.events"
KEY_CODES: Final = "hud.keys"
ADDRESS: Final = "bridge.address"
ACTS: Final = "bridge.acts"
COUNTS: Final = "bridge.json"
LINK_STATUS: Final = "link.json"
CAN_COMMAND: Final = "can.command"
CAN_EVENTS: Final = "can.events"
CAN_STATUS: Final = "can.json"
ROAD_USERS: Final = "road_users"
SIGNALS: Final = "signals"
LATENCY: Final = "latency"
VIEW_JOB: Final = "view.npz"
CAMERA: Final = "camera"
PLAN: Final = "plan"
SNAPSHOT_CAPACITY: Final = 1024
SLOT_CAPACITY: Final = 4
ROAD_USERS_CAPACITY: Final = 64
NO_RECEIPT: Final = -1


class BridgeWorker(Worker, frozen=True, kw_only=True):
    """Serves rosbridge."""

    profile: BridgeProfile
    tick_hz: int
    drive: str
    """The drive's nonce."""
    bundle: str
    """The bundle's folder, for recorded topics."""
    steering: SteeringLimit | None = None
    """Beyond it the arbiter refuses a command."""
    display: HudSettings | None = None
    """What a display of another program must know of the drive; what there is to see lies in the run folder. None:
    there is no such display."""
    has_traffic: bool = False
    world: WorldProfile | None = None
    """Whose route and traffic lights it tells of."""
    vehicle: TurtlebotProfile | None = None
    """The robot that is driven; None: it is none."""

    def run(self, folder: Path, stop: Callable[[], bool]) -> None:
        """Serve until `stop`."""
        from simconsole.bridge.console.operator_acts import Act
        from simconsole.bridge.console.surroundings import Surroundings
        from simconsole.bridge.console.view_topics import NO_VIEW
        from simconsole.bridge.transport.server import serve
        from simconsole.bridge.transport.sockets import address_url
        from simconsole.session.robots import robot_at_work
        from simconsole.session.view.external_view import external_view
        from simconsole.session.view.view_job import load_view_job
        from simconsole.world.kinds.worlds import road_signals, route_points, running_signals, shown_map

        profile = self.profile
        receipts = Receipts(folder / f"{LATENCY}.bridge.json")
        snapshots = NewestOnce(Ring.open(folder / SNAPSHOTS), self.tick_hz, receipts.received)
        events = EventCounters.open(folder / EVENTS, writable=True)

        acts = TextQueue.open(folder / ACTS, writable=True)

        users = RoadUsersRing(folder) if self.has_traffic else None
        around = Surroundings(
            route=route_points(self.world),
            shown_map=shown_map(self.world),
            signals=road_signals(self.world, self.tick_hz)
            if users is None
            else running_signals(self.world, self.tick_hz, users.signals),
            camera=None if profile.camera is None else _shots(folder),
            road_users=None if users is None else users.newest,
            view=NO_VIEW if self.display is None else external_view(load_view_job(folder / VIEW_JOB), self.display),
            robot=robot_at_work(self.vehicle, self.world),
            steering=self.steering,
        )

        def keep_act(act: Act) -> bool:
            return acts.put(msgspec.json.encode(act))

        def ready(port: int) -> None:
            url = address_url(profile.host, port, profile.certificate is not None)
            write_atomically(folder / ADDRESS, url, durable=False)

        plans = ByteSlot.open(folder / PLAN, writable=True)

        def keep_plan(plan: PlannedPath) -> None:
            plans.write(plan.t_ns, to_bytes(plan))

        def write_counts(counts: dict[str, int]) -> None:
            write_atomically(folder / COUNTS, msgspec.json.encode(counts), durable=False)

        def write_link_state(state: str) -> None:
            write_atomically(folder / LINK_STATUS, msgspec.json.encode({"state": state}), durable=False)

        serve(
            profile, snapshots, command_writer(folder / COMMAND), events.raise_events, stop,
            on_ready=ready, on_act=keep_act, on_counts=write_counts, on_link_state=write_link_state,
            folder=Path(self.bundle), drive=self.drive, around=around,
            on_plan=keep_plan,
        )  # fmt: skip


def _shots(folder: Path) -> "ReadCamera":
    """Return what returns the newest picture of the camera's worker."""
    from simconsole.bridge.console.camera_topics import CameraShot

    slot = ByteSlot.open(folder / CAMERA)

    def newest() -> CameraShot | None:
        piece = slot.newest()
        return None if piece is None else CameraShot(*piece)

    return newest


class CanWorker(Worker, frozen=True, kw_only=True):
    """Runs the console's node on the CAN bus."""

    profile: CanProfile
    tick_hz: int
    wheels: tuple[int, ...] | None
    """Where the state vector holds the wheels' speeds (messages.wheel_columns)."""
    bundle: str
    """The bundle's folder, for the logs."""

    def run(self, folder: Path, stop: Callable[[], bool]) -> None:
        """Send and receive until `stop`."""
        from simconsole.canbus.bus.worker import put_on_bus, serve

        receipts = Receipts(folder / f"{LATENCY}.canbus.json")
        snapshots = NewestOnce(Ring.open(folder / SNAPSHOTS), self.tick_hz, receipts.received)
        write_command = command_writer(folder / CAN_COMMAND)
        events = EventCounters.open(folder / CAN_EVENTS, writable=True)
        on_bus = put_on_bus(self.profile, self.tick_hz, wheels=self.wheels, folder=Path(self.bundle))

        def write_status(status: dict[str, Any]) -> None:
            write_atomically(folder / CAN_STATUS, msgspec.json.encode(status), durable=False)

        try:
            serve(on_bus, snapshots, write_command, events.raise_events, write_status, stop)
        finally:
            on_bus.port.close()


class HudWorker(Worker, frozen=True, kw_only=True):
    """Shows the cluster in a window and reports the keys held there."""

    profile: HudProfile
    settings: HudSettings
    tick_hz: int
    has_can: bool
    has_bridge: bool
    has_traffic: bool = False
    has_advice: bool = False

    def run(self, folder: Path, stop: Callable[[], bool]) -> None:
        """Draw until `stop`."""
        from simconsole.hud.gl.view_window import open_window
        from simconsole.hud.window.habits import STATE_FILE, HabitsFile, state_folder
        from simconsole.hud.window.ports import Motion, Ports
        from simconsole.hud.window.window_loop import run

        ring = Ring.open(folder / SNAPSHOTS)
        keys = Ring.open(folder / KEY_CODES, writable=True)
        receipts = Receipts(folder / f"{LATENCY}.hud.json")
        road_users = RoadUsersRing(folder) if self.has_traffic else None

        def latest() -> Snapshot | None:
            record = ring.latest()
            if record is None:
                return None
            receipts.received(record)
            return snapshot_of(record, self.tick_hz)

        def motion() -> Motion | None:
            records = ring.since(ring.newest - 2)
            if len(records) < 2:
                return None
            older, newer = (snapshot_of(record, self.tick_hz) for record in records[-2:])
            age_s = 1e-9 * (time.monotonic_ns() - records[-1].second_stamp)
            before, now = (None, None) if road_users is None else road_users.newest_two()
            return Motion(older, newer, age_s, now, before)

        def report_keys(mask: int) -> None:
            keys.write(np.array([float(mask)]), time.monotonic_ns())

        can = CanWatch(folder / CAN_STATUS, time.time, time.monotonic) if self.has_can else lambda: None
        link = LinkWatch(folder / LINK_STATUS, time.time, time.monotonic) if self.has_bridge else lambda: None
        ports = Ports(latest, report_keys, stop, can_up=can, drawn=receipts.drawn, link=link, motion=motion)
        if self.has_advice:
            newest, tick_hz = NewestAdvice(folder), self.tick_hz
            ports = ports._replace(advice=lambda: newest(tick_time_ns(_tick_of(ring), tick_hz)))
        scene = _view_scene(folder) if self.profile.view is not None else None
        memory = HabitsFile(state_folder() / STATE_FILE)
        run(ports, self.profile, self.settings, partial(open_window, scene=scene), memory)


class RoadUsersRing:
    """A worker's view of the road users, in a second ring of the run folder: how many, then the users.

    Signals that another simulator runs stand in a slot of their own, where there is one. A step has those of its own
    time, or the oldest that are still there.
    """

    def __init__(self, folder: Path) -> None:
        self._ring = Ring.open(folder / ROAD_USERS)
        self._signals = ByteSlot.open(folder / SIGNALS) if (folder / SIGNALS).exists() else None
        self._pieces: deque[Piece] = deque(maxlen=CAPACITY)
        self._running = lru_cache(CAPACITY)(partial(changed, NONE_RUNNING))
        self._seen = 0

    def newest(self) -> RoadUsersAt:
        """Return those of the newest step; nobody before the first."""
        record = self._ring.latest()
        return NOBODY_AT_ALL if record is None else self._of(record)

    def newest_two(self) -> tuple[RoadUsersAt | None, RoadUsersAt]:
        """Return those of the last step but one, None where there is none, and those of the newest."""
        records = self._ring.since(self._ring.newest - 2)[-2:]
        steps = [self._of(record) for record in records]
        return (steps[0] if len(steps) > 1 else None), (steps[-1] if steps else NOBODY_AT_ALL)

    def since(self) -> list[RoadUsersAt]:
        """Return those of all steps since the last call, oldest first; gaps are allowed."""
        records = self._ring.since(self._seen)
        if records:
            self._seen = records[-1].number
        return [self._of(record) for record in records]

    def signals(self) -> RunningNow:
        """Return the signals that another simulator runs; none where they run their own programs."""
        return self._signals_at(math.inf)

    def _of(self, record: Record) -> RoadUsersAt:
        return RoadUsersAt(record.stamp, from_record(record.values), self._signals_at(record.stamp))

    def _signals_at(self, tick: float) -> RunningNow:
        self._pieces.extend([] if self._signals is None else self._signals.take())
        if not self._pieces:
            return NONE_RUNNING
        piece = next((piece for piece in reversed(self._pieces) if piece.number <= tick), self._pieces[0])
        return self._running(piece.content)


def _tick_of(ring: Ring) -> int:
    """Return the newest tick, 0 before the first."""
    record = ring.latest()
    return 0 if record is None else record.stamp


def _view_scene(folder: Path) -> "ViewScene":
    """Return what the drive's view job describes."""
    from simconsole.session.view.view_job import load_view_job

    return load_view_job(folder / VIEW_JOB).scene()


def command_writer(path: Path) -> Callable[[RemoteCommand, int | None], None]:
    """Return a function that writes a controller's command and its time of receipt (ns) into its slot."""
    slot = Ring.open(path, writable=True)

    def write_command(command: RemoteCommand, receipt_ns: int | None) -> None:
        slot.write(np.array(command), NO_RECEIPT if receipt_ns is None else receipt_ns)

    return write_command


class _Watch:
    """Reads a worker's newest status; one that was not renewed for SILENT_S counts as none."""

    LOOK_S: Final = 0.2
    SILENT_S: Final = 3.0

    def __init__(self, path: Path, file_clock_s: Callable[[], float], clock_s: Callable[[], float]) -> None:
        self._path = path
        self._file_clock_s = file_clock_s
        self._clock_s = clock_s
        self._looked_s = -1e9
        self._status: dict[str, Any] = {}

    def status(self) -> dict[str, Any]:
        """Return the status as read at most LOOK_S ago, empty where there is none."""
        now_s = self._clock_s()
        if now_s - self._looked_s >= self.LOOK_S:
            self._looked_s = now_s
            self._status = self._read()
        return self._status

    def _read(self) -> dict[str, Any]:
        try:
            status = msgspec.json.decode(self._path.read_bytes(), type=dict[str, Any])
            silent_s = self._file_clock_s() - self._path.stat().st_mtime
        except (OSError, msgspec.DecodeError):
            return {}
        return status if silent_s < self.SILENT_S else {}


class CanWatch(_Watch):
    """Says whether the CAN bus is up; silence of its worker counts as down."""

    def __call__(self) -> bool:
        """Return whether it is up."""
        return bool(self.status().get("up"))


class LinkWatch(_Watch):
    """Says how the rosbridge link stands; silence of the bridge counts as down."""

    def __call__(self) -> str:
        """Return a label of `simconsole.values.labels`, or how many clients there are."""
        return str(self.status().get("state", LINK_DOWN))


class NewestOnce:
    """Returns the newest snapshot, or None when it was returned before; `received` is called with its record first."""

    def __init__(self, ring: Ring, tick_hz: int, received: Callable[[Record], None] | None = None) -> None:
        self._ring = ring
        self._received = received
        self._tick_hz = tick_hz
        self._seen = 0

    def __call__(self) -> Snapshot | None:
        """Return the newest snapshot that is new to this reader."""
        if self._ring.newest == self._seen:
            return None
        record = self._ring.latest()
        if record is None or record.number == self._seen:
            return None
        self._seen = record.number
        if self._received is not None:
            self._received(record)
        return snapshot_of(record, self._tick_hz)


def snapshot_of(record: Record, tick_hz: int) -> Snapshot:
    """Return a ring's record as a snapshot; its stamp is the tick."""
    return Snapshot(record.stamp, tick_hz, record.values)


def command_of(values: Row) -> RemoteCommand:
    """Return a slot's values as a command."""
    return RemoteCommand(*values[: LAYOUT.ros.width].tolist())
