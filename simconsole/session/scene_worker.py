"""The worker that keeps the operators' scene of a running drive."""

import contextlib
import os
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from simconsole.processes.byte_slot import ByteSlot
from simconsole.processes.notices import NoticeReader
from simconsole.processes.receipts import Receipts, latencies_of
from simconsole.processes.running_scene import name_scene
from simconsole.processes.shared_memory import Ring
from simconsole.processes.worker import Worker
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.vehicle import CarProfile
from simconsole.profiles.view import SceneProfile
from simconsole.scene.entities import Dimensions
from simconsole.scene.operator_acts import act_entry
from simconsole.scene.timeline import NEEDED, TRAFFIC_LOST, Entry, ShownVehicle
from simconsole.scene.viewer.follow import Ports, Shot, follow
from simconsole.scene.viewer.job import SceneSource, job_of
from simconsole.scene.wheel_shapes import WHEEL_COLUMNS, ShownWheel, ShownWheels
from simconsole.session.worker_programs import (
    ACTS,
    CAMERA,
    LATENCY,
    LINK_STATUS,
    PLAN,
    SNAPSHOTS,
    LinkWatch,
    RoadUsersRing,
    snapshot_of,
)
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.host.jit import plain
from simconsole.values.planned_path import PlannedPath, from_bytes
from simconsole.values.state_vector import Snapshot
from simconsole.vehicle.car.car_platform import car_parameters

LIVE_SCENE: Final = "scene.live.rrd"
"""What a paced drive's scene worker writes for the operators; the scene made from the log takes its place."""
NICE: Final = 10
"""The core, and the display of a person who drives, come first."""


def scene_source(resolved: ResolvedSession, columns: tuple[str, ...], tick_hz: int) -> SceneSource:
    """Return what a scene process needs before the first state vector, which will have `columns`."""
    platform, vehicle, bridge = assemble(resolved, plain)[0].platform, resolved.vehicle, resolved.session.outputs.bridge
    return SceneSource(
        columns=columns,
        tick_hz=tick_hz,
        dimensions=Dimensions(platform.length_m, platform.width_m, platform.height_m, platform.rear_overhang_m),
        vehicle=ShownVehicle(
            wheelbase_m=0.0 if platform.turns_in_place else platform.wheelbase_m,
            wheels=shown_wheels(vehicle) if isinstance(vehicle, CarProfile) else None,
            is_robot=isinstance(vehicle, TurtlebotProfile),
        ),
        world=resolved.world,
        robot=vehicle if isinstance(vehicle, TurtlebotProfile) else None,
        seed=0 if bridge is None else bridge.link.seed,
        has_camera=bridge is not None and bridge.camera is not None,
        profile=resolved.session.outputs.scene or SceneProfile(),
    )


def scene_columns(resolved: ResolvedSession, columns: tuple[str, ...]) -> tuple[str, ...]:
    """Return which `columns` of a recorded drive its scene reads: for a lidar and a camera all."""
    bridge = resolved.session.outputs.bridge
    if isinstance(resolved.vehicle, TurtlebotProfile) or (bridge is not None and bridge.camera is not None):
        return columns
    return tuple(dict.fromkeys((*NEEDED, *(name for name in (TRAFFIC_LOST, *WHEEL_COLUMNS) if name in columns))))


def shown_wheels(profile: CarProfile) -> ShownWheels:
    """Return what one must know of a car to show its wheels."""
    car = car_parameters(profile)

    def wheel(at_front: bool, side: float) -> ShownWheel:
        axle = car.front if at_front else car.rear
        return ShownWheel(
            x_m=profile.body.wheelbase_m if at_front else 0.0,
            y_m=side * axle.half_track_m,
            radius_m=axle.radius_m,
            static_n=axle.static_n,
            carcass_npm=axle.carcass_npm,
            stiffness_x_per_m=axle.stiffness_x_per_m,
            stiffness_y_per_m=axle.stiffness_y_per_m,
            friction=axle.friction,
        )

    return wheel(True, 1.0), wheel(True, -1.0), wheel(False, 1.0), wheel(False, -1.0)


class SceneWorker(Worker, frozen=True, kw_only=True):
    """Makes the scene with rerun, into a file that viewers follow."""

    path: str
    """The .rrd file."""
    source: SceneSource
    has_bridge: bool
    has_traffic: bool = False

    def run(self, folder: Path, stop: Callable[[], bool]) -> None:
        """Record until `stop`."""
        if sys.platform != "win32":
            with contextlib.suppress(OSError):  # not granted: then as it is
                os.nice(NICE)
        tick_hz = self.source.tick_hz
        ring, acts = Ring.open(folder / SNAPSHOTS), Ring.open(folder / ACTS)
        seen, acts_seen = ring.newest, acts.newest
        receipts = Receipts(folder / f"{LATENCY}.scene.json")
        camera = ByteSlot.open(folder / CAMERA) if self.source.has_camera else None

        def new_ticks() -> Sequence[Snapshot]:
            nonlocal seen
            records = ring.since(seen)
            if records:
                seen = records[-1].number
                receipts.received(records[-1])
            return [snapshot_of(record, tick_hz) for record in records]

        def entries() -> Sequence[Entry]:
            nonlocal acts_seen
            records = acts.since(acts_seen)
            if records:
                acts_seen = records[-1].number
            return [act_entry(record.values.tobytes()[: record.stamp], tick_hz) for record in records]

        def shot() -> Shot | None:
            piece = None if camera is None else camera.newest()
            return None if piece is None else Shot(*piece)

        link = LinkWatch(folder / LINK_STATUS, time.time, time.monotonic) if self.has_bridge else lambda: None
        ports = Ports(
            new_ticks=new_ticks,
            stop=stop,
            road_users=RoadUsersRing(folder).since if self.has_traffic else tuple,
            plans=_plans(folder) if self.has_bridge else tuple,
            link=link,
            camera=shot,
            latencies=lambda: latencies_of(folder, LATENCY),
            entries=entries,
            notices=NoticeReader(folder).take,
        )
        name_scene(folder, Path(self.path))
        follow(ports, job_of(self.source), Path(self.path))


def _plans(folder: Path) -> Callable[[], Sequence[PlannedPath]]:
    """Return what returns the newest plan, once."""
    slot = ByteSlot.open(folder / PLAN)
    seen = slot.newest()

    def new_plans() -> Sequence[PlannedPath]:
        nonlocal seen
        piece = slot.newest()
        if piece is None or piece is seen:
            return ()
        seen = piece
        return (from_bytes(piece.content),)

    return new_plans
