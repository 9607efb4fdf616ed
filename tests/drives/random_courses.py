"""Random closed courses, and one drive over each with the autopilot over the real WebSocket, behind the gate."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from simconsole.profiles.course_plan import CoursePlan, Curve, Straight
from simconsole.profiles.world import WorldProfile
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Mode
from simconsole.values.state_vector import Snapshot
from simconsole.world.course import Course
from simconsole.world.planning import solve
from simconsole.world.tools.generate import to_text

PERIOD_S = 0.02
_TRIES = 10_000
_SETTLED_M = 20.0
"""Driven by the autopilot before its errors count: it takes over beside the path, from a person."""


def random_course(rng: np.random.Generator) -> WorldProfile:
    """Radii of 8 to 60 m, curvature ramps of 3 to 15 m, a speed limit of 30 to 80 km/h, bends to both sides."""
    for _ in range(_TRIES):
        angles = rng.uniform(20.0, 120.0, int(rng.integers(4, 9)))
        angles *= np.where(rng.random(len(angles)) < 0.7, 1.0, -1.0)
        angles = np.append(angles, 360.0 - angles.sum())
        if not 20.0 <= abs(angles[-1]) <= 170.0:
            continue
        free = set(rng.choice(len(angles), 3, replace=False).tolist())
        elements: list[Straight | Curve] = [Straight(length_m=80.0)]
        for index, angle in enumerate(angles.tolist()):
            elements.append(Curve(radius_m=rng.uniform(8.0, 60.0), angle_deg=angle, ramp_m=rng.uniform(3.0, 15.0)))
            elements.append(Straight(length_m="free" if index in free else rng.uniform(5.0, 80.0)))
        plan = CoursePlan(
            schema=1,
            title="random",
            lane_width_m=3.5,
            speed_limit_kmh=rng.uniform(30.0, 80.0),
            length_m=rng.uniform(500.0, 1200.0),
            elements=tuple(elements),
        )
        try:
            return solve(plan, "random")
        except ProfileError:
            continue
    raise AssertionError("no course closes")


class Tracked(NamedTuple):
    """How one drive went; errors are base_link's true ones from the path while the autopilot drove, in cm."""

    stopped: bool
    rms_cm: float
    max_cm: float
    lateral_kept: float  # share of ticks within 2.5 m/s2 of lateral acceleration
    longitudinal_kept: float  # share of commands within -2.0 to 1.6 m/s2 and 3 m/s3


def tracked(world: WorldProfile, vehicle: str, link: str, folder: Path) -> Tracked:
    """Drive one lap over the link (YAML of a LinkProfile) and measure."""
    folder.mkdir()
    (folder / "course.yaml").write_text(to_text(world, "random"))
    (folder / "session.yaml").write_text(
        "schema: 1\nenvironment: {world: course.yaml}\n"
        f"scenario: {{vehicle: {vehicle}, duration_s: 400}}\nfeatures: {{autopilot: course.yaml}}\n"
        f"outputs: {{hud: null, scene: null, report: false, bridge: {{port: 0, link: {link}}}}}\n"
        "devices: {driver: virtual, person: {sit_s: 0.5, cruise_kmh: 20, top_gear: 2, autonomy: {distance_m: 20}}}\n"
        "mode: {pacing: lockstep}\n"
    )
    ended = (Mode.MINIMAL_RISK, Mode.STOPPED, Mode.EMERGENCY_STOP)

    def watch(snapshot: Snapshot) -> bool:
        return snapshot.arbitration.mode in ended or snapshot.vehicle.distance_m > world.length_m + 10.0

    result = drive(resolve(load_session(str(folder / "session.yaml"))), folder / "bundle", watch)
    assert result.summary["bridge"]["refused"] == 0
    log = open_bundle(folder / "bundle").log
    names = ("arbitration.mode", "vehicle.x_m", "vehicle.y_m", "vehicle.distance_m", "vehicle.ay_mps2")
    table = log.table((*names, "ros.sequence", "ros.accel_mps2"))
    mode, distance = table.column("arbitration.mode"), table.column("vehicle.distance_m")
    driven = mode == float(Mode.AUTONOMOUS)
    first = int(np.flatnonzero(driven)[0])
    settled = driven & (distance > distance[first] + _SETTLED_M)
    _, lateral = Course(world).project_all(table.column("vehicle.x_m"), table.column("vehicle.y_m"), 0.0)
    errors_cm = 100.0 * np.abs(lateral[settled])
    commands = np.flatnonzero(np.diff(table.column("ros.sequence"), prepend=0.0) > 0.0)
    commands = commands[settled[commands]]
    accel, sequence = table.column("ros.accel_mps2")[commands], table.column("ros.sequence")[commands]
    jerk = np.diff(accel) / (np.diff(sequence) * PERIOD_S)
    gentle = (np.abs(jerk) <= 3.0 + 1e-9) & (accel[1:] <= 1.6 + 1e-9) & (accel[1:] >= -2.0 - 1e-9)
    return Tracked(
        stopped=bool(np.isin(mode, [float(one) for one in ended]).any()),
        rms_cm=float(np.sqrt(np.mean(errors_cm**2))),
        max_cm=float(errors_cm.max()),
        lateral_kept=float((np.abs(table.column("vehicle.ay_mps2")[settled]) <= 2.5).mean()),
        longitudinal_kept=float(gentle.mean()),
    )
