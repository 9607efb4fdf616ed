"""Processor time of the process that keeps the operators' scene: `python benchmarks/operators_scene.py`.

A drive of 100 ticks a second among 30 vehicles that all move in every tick is fed into shared memory in real time, as
the console does; the scene's own worker makes its file of it at 100 Hz. Told is the processor time of that process over
the drive's time, from the moment on when the world is in the file: of a car without camera and lidar, of one with a
camera, and of a robot with camera and lidar. Each has a plan, five times a second.
"""

import argparse
import os
import tempfile
import time
from pathlib import Path
from subprocess import Popen

import msgspec
import numpy as np

from simconsole.bridge.console.operator_acts import ACT_BYTES, ACTS_MAX
from simconsole.processes.byte_slot import ByteSlot
from simconsole.processes.lifetimes import end, spawn
from simconsole.processes.shared_memory import Ring, TextQueue
from simconsole.processes.worker import WorkerCall, WorkerSpec
from simconsole.profiles.bridge import BridgeProfile, CameraProfile
from simconsole.profiles.view import SceneProfile
from simconsole.session.resolution import load_session, override, resolve
from simconsole.session.scene_worker import SceneWorker, scene_source
from simconsole.session.worker_programs import (
    ACTS,
    CAMERA,
    PLAN,
    ROAD_USERS,
    ROAD_USERS_CAPACITY,
    SNAPSHOT_CAPACITY,
    SNAPSHOTS,
)
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import plain
from simconsole.values.kernels import Row
from simconsole.values.planned_path import MOST_BYTES as PLAN_BYTES
from simconsole.values.planned_path import PlannedPath, to_bytes
from simconsole.values.units import NS_PER_S
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import PathPoint, Route
from simconsole.world.traffic.road_users import RECORD_WIDTH, RoadUser, RoadUserKind, table, to_record

HZ = 100
VEHICLES = 30
PICTURE_HZ = 10
PLAN_HZ = 5
PLAN_PLACES = 21
PICTURE_BYTES = 45_000
MOST_BYTES = 1 << 20
SPEED_MPS = 10.0
SCAN_HZ = 5


def user(number: int, x_m: float, y_m: float, yaw_rad: float) -> RoadUser:
    """Return one vehicle."""
    return RoadUser(
        id=float(number),
        kind=float(RoadUserKind.CAR),
        x_m=x_m,
        y_m=y_m,
        yaw_rad=yaw_rad,
        speed_mps=SPEED_MPS,
        length_m=4.3,
        width_m=1.8,
        height_m=1.5,
    )


def cpu_s(process: "Popen[bytes]") -> float:
    """Return the processor time of a process, threads included, in s."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def put(vector: Row, places: dict[str, int], at: PathPoint, speed_mps: float, tick: int) -> None:
    """Move the vehicle to a place of its route; a robot's lidar has turned there."""
    pose = (("x_m", at.x_m), ("y_m", at.y_m), ("yaw_rad", at.yaw_rad))
    for column, value in (*pose, ("vx_mps", speed_mps)):
        vector[places[f"vehicle.{column}"]] = value
    if "platform.gauges.scans" in places:
        vector[places["platform.gauges.scans"]] = tick * SCAN_HZ // HZ
        for end_of_turn in ("scan_from", "scan_to"):
            for column, value in pose:
                vector[places[f"platform.{end_of_turn}.{column}"]] = value


def plan(route: Route, speed_mps: float, tick: int) -> bytes:
    """Return a plan of the next 5 s."""
    ahead = [(0.25 * number, route.at(speed_mps * (tick / HZ + 0.25 * number))) for number in range(PLAN_PLACES)]
    places = np.array([(after_s, place.x_m, place.y_m, 0.0) for after_s, place in ahead])
    return to_bytes(PlannedPath(tick * NS_PER_S // HZ, places))


def share(session: str, camera: bool, length_s: float) -> tuple[float, float]:
    """Return the processor time of the scene's process over the drive's time, and the file's bytes a second."""
    bridge = BridgeProfile(camera=CameraProfile() if camera else None)
    outputs: dict[str, object] = {"scene": SceneProfile(rate_hz=HZ), "bridge": bridge}
    resolved = resolve(override(load_session(session), outputs=outputs))
    console, state = assemble(resolved, plain)
    places = {name: index for index, name in enumerate(console.columns)}
    assert resolved.world is not None
    route = open_world(resolved.world).route
    speed_mps = min(SPEED_MPS, route.speed_limit_mps)
    with tempfile.TemporaryDirectory() as name:
        folder, path = Path(name), Path(name) / "scene.live.rrd"
        ring = Ring.create(folder / SNAPSHOTS, console.width, SNAPSHOT_CAPACITY)
        others = Ring.create(folder / ROAD_USERS, RECORD_WIDTH, ROAD_USERS_CAPACITY)
        TextQueue.create(folder / ACTS, ACT_BYTES, ACTS_MAX)
        slot = ByteSlot.create(folder / CAMERA, MOST_BYTES)
        plans = ByteSlot.create(folder / PLAN, PLAN_BYTES)
        worker = SceneWorker(
            path=str(path),
            source=scene_source(resolved, console.columns, HZ),
            has_bridge=True,
            has_traffic=True,
        )
        call = WorkerCall(folder=name, worker=WorkerSpec.of("scene", worker), patience_s=20.0)
        process = spawn(["-m", "simconsole.processes", "worker"], told=msgspec.json.encode(call) + b"\n")
        picture = np.random.default_rng(1).bytes(PICTURE_BYTES)
        vector, tick, measured_from = state.vector.copy(), 0, -1
        began_cpu_s = began_bytes = 0.0
        due_s = time.monotonic()
        try:
            while measured_from < 0 or tick < measured_from + round(length_s * HZ):
                tick += 1
                put(vector, places, route.at(speed_mps * tick / HZ), speed_mps, tick)
                ring.write(vector, tick, time.monotonic_ns())
                gone = [route.at(speed_mps * tick / HZ + 30.0 * (number + 1)) for number in range(VEHICLES)]
                users = [user(number, place.x_m, place.y_m, place.yaw_rad) for number, place in enumerate(gone)]
                others.write(to_record(table(users)), tick)
                if tick % (HZ // PLAN_HZ) == 0:
                    plans.write(tick, plan(route, speed_mps, tick))
                if camera and tick % (HZ // PICTURE_HZ) == 0:
                    slot.write(tick, picture)
                if measured_from < 0 and path.exists() and path.stat().st_size > 0:
                    measured_from, began_cpu_s, began_bytes = tick, cpu_s(process), path.stat().st_size
                due_s += 1.0 / HZ
                time.sleep(max(0.0, due_s - time.monotonic()))
            return (cpu_s(process) - began_cpu_s) / length_s, (path.stat().st_size - began_bytes) / length_s
        finally:
            end([process], 10.0)


def main() -> None:
    """Print a line for each case."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--for", dest="length_s", type=float, default=30.0, metavar="S")
    given = parser.parse_args()
    for name, session, camera, most in (
        ("a car, without camera and lidar", "demo", False, 10),
        ("a car with a camera", "demo", True, 25),
        ("a robot with camera and lidar", "turtlebot3_burger", True, 25),
    ):
        found, bytes_per_s = share(session, camera, given.length_s)
        print(f"{name}: {100.0 * found:.1f} % of a core (at most {most} %), {bytes_per_s / 1e3:.0f} kB/s")


if __name__ == "__main__":
    main()
