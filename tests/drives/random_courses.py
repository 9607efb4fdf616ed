"""Random closed courses, and one drive over each with the autopilot over the real WebSocket, behind the gate."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.bridge.link.localisation import Localisation
from simconsole.profiles.course_plan import CoursePlan, Curve, Straight
from simconsole.profiles.link import LinkProfile, LocalisationProfile
from simconsole.profiles.world import CourseProfile
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Mode, VehicleState
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import DEG_PER_RAD
from simconsole.world.course import Course
from simconsole.world.planning import solve
from simconsole.world.route import Route
from simconsole.world.tools.generate import to_text

PERIOD_S = 0.02
END_M = 3.0
STANDING_MPS = 0.02
_TRIES = 10_000
_REACHED_RAD = 1e-6
_STATES = len(VehicleState._fields)
SETTLED_M = 20.0
"""Driven by the autopilot before its errors count: it takes over beside the path, from a person."""
DRIVES = "virtual, person: {{sit_s: 0.5, cruise_kmh: 20, top_gear: 2, autonomy: {{distance_m: {}}}}}"
ASKS = "script:asks.yaml"
SCRIPT = """points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 0.5, press: [autonomous]}
"""
"""Somebody who only asks, without a wheel that the motor turns: fewer ticks in which anybody acts."""
HAND_OVER_M = 20.0


class Size(NamedTuple):
    """How long a course may be, and what it is made of beside its bends."""

    length_m: tuple[float, float]
    bends: tuple[int, int]  # and one more, which closes the loop
    first_m: float  # a straight to drive off on
    straight_m: tuple[float, float]


FULL = Size((500.0, 1200.0), (4, 9), 80.0, (5.0, 80.0))
SHORT = Size((240.0, 480.0), (3, 6), 40.0, (5.0, 40.0))


def random_course(rng: np.random.Generator, size: Size = FULL) -> CourseProfile:
    """Radii of 8 to 60 m, curvature ramps of 3 to 15 m, a speed limit of 30 to 80 km/h, bends to both sides."""
    for _ in range(_TRIES):
        angles = rng.uniform(20.0, 120.0, int(rng.integers(*size.bends)))
        angles *= np.where(rng.random(len(angles)) < 0.7, 1.0, -1.0)
        angles = np.append(angles, 360.0 - angles.sum())
        if not 20.0 <= abs(angles[-1]) <= 170.0:
            continue
        free = set(rng.choice(len(angles), 3, replace=False).tolist())
        elements: list[Straight | Curve] = [Straight(length_m=size.first_m)]
        for index, angle in enumerate(angles.tolist()):
            elements.append(Curve(radius_m=rng.uniform(8.0, 60.0), angle_deg=angle, ramp_m=rng.uniform(3.0, 15.0)))
            elements.append(Straight(length_m="free" if index in free else rng.uniform(*size.straight_m)))
        plan = CoursePlan(
            schema=1,
            title="random",
            lane_width_m=3.5,
            speed_limit_kmh=rng.uniform(30.0, 80.0),
            length_m=rng.uniform(*size.length_m),
            elements=tuple(elements),
        )
        try:
            return solve(plan, "random")
        except ProfileError:
            continue
    raise AssertionError("no course closes")


class Tracked(NamedTuple):
    """How one drive went; errors are base_link's from the path while the autopilot drove, in cm.

    They are true ones but where the localisation drifts: then those of odometry without its white noise, which nobody
    could tell from the path otherwise.
    """

    stopped: bool  # by the console, or taken over, before the end of the route
    rms_cm: float
    max_cm: float
    lateral_kept: float  # share of ticks within 2.5 m/s2 of lateral acceleration
    longitudinal_kept: float  # share of commands within -2.0 to 1.6 m/s2 and 3 m/s3
    reached: float  # share of commands whose angle the gate has let through by the time the next one comes
    driven_s: float
    left_m: float  # of the route


def tracked(
    world: CourseProfile,
    vehicle: str,
    link: str,
    folder: Path,
    tracker: str = "preview",
    control: str = "{}",
    until_m: float = math.inf,
    hand_over_m: float | None = HAND_OVER_M,
) -> Tracked:
    """Drive one lap over the link (YAML of a LinkProfile), behind a gate (of a ControlProfile), and measure."""
    folder.mkdir()
    (folder / "course.yaml").write_text(to_text(world, "random"))
    return tracked_on(
        Course(world), "course.yaml", vehicle, link, folder, hand_over_m, tracker, control, until_m=until_m
    )


def tracked_on(
    route: Route,
    world: str,
    vehicle: str,
    link: str,
    folder: Path,
    hand_over_m: float | None = HAND_OVER_M,
    tracker: str = "preview",
    control: str = "{}",
    start_m: float = 0.0,
    until_m: float = math.inf,
) -> Tracked:
    """Drive a lap, or an open route up to its end, in a world of `folder` or a shipped one, and measure.

    The car stands at `start_m` first. A person drives it up to `hand_over_m`, or (None) asks for autonomy at once.
    A drive that goes no farther than `until_m` has driven its route there.
    """
    length_m = min(route.length_m, until_m)
    (folder / "session.yaml").write_text(
        f"schema: 1\nenvironment: {{world: {world}}}\n"
        f"scenario: {{vehicle: {vehicle}, duration_s: 600, start: {_start(route, start_m)}}}\n"
        f"features: {{autopilot: {world}, tracker: {tracker}, control: {control}}}\n"
        f"outputs: {{hud: null, scene: null, report: false, bridge: {{port: 0, link: {link}}}}}\n"
        f"devices: {{driver: {ASKS if hand_over_m is None else DRIVES.format(hand_over_m)}}}\n"
        "mode: {pacing: lockstep, answer_timeout_s: 60}\n"
    )
    (folder / "asks.yaml").write_text(SCRIPT)
    ended = (Mode.MINIMAL_RISK, Mode.STOPPED, Mode.EMERGENCY_STOP)

    def watch(snapshot: Snapshot) -> bool:
        car = snapshot.vehicle
        place_m = start_m + car.distance_m
        at_end = place_m > route.length_m - END_M and car.vx_mps < STANDING_MPS
        goes_on = route.closed or until_m < route.length_m
        over = place_m > length_m + 10.0 if goes_on else at_end
        return snapshot.arbitration.mode in ended or over

    resolved = resolve(load_session(str(folder / "session.yaml")))
    assert resolved.session.outputs.bridge is not None
    result = drive(resolved, folder / "bundle", watch)
    assert result.summary["bridge"]["refused"] == 0
    log = open_bundle(folder / "bundle").log
    names = ("arbitration.mode", "vehicle.x_m", "vehicle.y_m", "vehicle.distance_m", "vehicle.ay_mps2")
    table = log.table((*names, "ros.sequence", "ros.accel_mps2", "ros.road_wheel_rad", "command.road_wheel_rad"))
    mode, distance = table.column("arbitration.mode"), table.column("vehicle.distance_m")
    driven = mode == float(Mode.AUTONOMOUS)
    first = int(np.flatnonzero(driven)[0])
    settled = driven & (distance > distance[first] + SETTLED_M)
    drift = _drift(resolved.session.outputs.bridge.link, len(mode), resolved.session.mode.tick_hz)
    x, y = table.column("vehicle.x_m") + drift[:, 0], table.column("vehicle.y_m") + drift[:, 1]
    place, lateral = route.project_all(x, y, start_m)
    errors_cm = 100.0 * np.abs(lateral[settled])
    commands = np.flatnonzero(np.diff(table.column("ros.sequence"), prepend=0.0) > 0.0)
    commands = commands[settled[commands]]
    accel, sequence = table.column("ros.accel_mps2")[commands], table.column("ros.sequence")[commands]
    missing_rad = np.abs(table.column("ros.road_wheel_rad") - table.column("command.road_wheel_rad"))[commands[1:] - 1]
    tick_hz = resolved.session.mode.tick_hz
    left_m = length_m - float(place[-1])
    jerk = np.diff(accel) / (np.diff(sequence) * PERIOD_S)
    gentle = (np.abs(jerk) <= 3.0 + 1e-9) & (accel[1:] <= 1.6 + 1e-9) & (accel[1:] >= -2.0 - 1e-9)
    return Tracked(
        stopped=bool(np.isin(mode, [float(one) for one in ended]).any()) or left_m > END_M,
        rms_cm=float(np.sqrt(np.mean(errors_cm**2))),
        max_cm=float(errors_cm.max()),
        lateral_kept=float((np.abs(table.column("vehicle.ay_mps2")[settled]) <= 2.5).mean()),
        longitudinal_kept=float(gentle.mean()),
        reached=float((missing_rad < _REACHED_RAD).mean()),
        driven_s=float(settled.sum()) / tick_hz,
        left_m=left_m,
    )


def _start(route: Route, start_m: float) -> str:
    """Return where the car stands at first, in YAML; null leaves it to the world."""
    if not start_m:
        return "null"
    at = route.at(start_m)
    return f"{{x_m: {at.x_m}, y_m: {at.y_m}, yaw_deg: {math.remainder(at.yaw_rad, math.tau) * DEG_PER_RAD}}}"


def _drift(link: LinkProfile, ticks: int, tick_hz: int) -> NDArray[np.float64]:
    """Return by how much the odometry of each tick is off, but for white noise: x and y in m."""
    errors = link.localisation
    if not (errors.position_drift_m or errors.yaw_drift_deg):
        return np.zeros((ticks, 2))
    slow = LocalisationProfile(position_drift_m=errors.position_drift_m, drift_time_s=errors.drift_time_s)
    measured, nowhere = Localisation(LinkProfile(seed=link.seed, localisation=slow)), VehicleState(*(0.0,) * _STATES)
    seen = (measured.measure(nowhere, tick, tick_hz) for tick in range(1, ticks + 1))
    return np.array([(one.x_m, one.y_m) for one in seen])
