"""The templates as text. `$name` is what the user called it; a test stands beside each, for a lab's own pytest."""

from typing import Final

CONTROLLER: Final = '''\
"""$name: an own controller. `python $name.py` drives the urban course with it."""

import math

import simconsole

SPEED_MPS = 8.0
WHEELBASE_M = 2.6
SIGNALS = ("lateral_m",)
"""What it records beside the console's own columns, as own.lateral_m."""


class Controller:
    """Follows a route by pure pursuit. It is called once per control period with the tick that ends it."""

    def __init__(self, route, own):
        self.route, self.own, self.place_m = route, own, 0.0

    def __call__(self, seen):
        car = seen.vehicle
        self.place_m, lateral_m, _ = self.route.project(car.x_m, car.y_m, self.place_m)
        self.own.set(lateral_m=lateral_m)
        ahead_m = 3.0 + 0.5 * car.vx_mps
        goal = self.route.at(self.place_m + ahead_m)
        bearing_rad = math.atan2(goal.y_m - car.y_m, goal.x_m - car.x_m) - car.yaw_rad
        bend_1pm = max(abs(self.route.curvature_at(self.place_m + far_m)) for far_m in (0.0, ahead_m, 2.0 * ahead_m))
        speed_mps = min(SPEED_MPS, math.sqrt(2.0 / (bend_1pm + 1e-6)))
        return simconsole.hold_speed(speed_mps, math.atan(2.0 * WHEELBASE_M * math.sin(bearing_rad) / ahead_m))


def drive(session="bridge", length_m=math.inf, **options):
    """Drive a session for so long a way, at most the whole route; return the drive."""
    opened = simconsole.load(session)
    own = simconsole.OwnSignals(*SIGNALS)
    controller = Controller(opened.route, own)
    end_m = min(length_m, opened.route.length_m)
    return opened.run(controller, signals=own, until=lambda seen: controller.place_m >= end_m, **options)


if __name__ == "__main__":
    print(drive(out="out/$name").metrics["autonomous"])
'''

TEST_CONTROLLER: Final = '''\
"""$name drives, stays in its lane, and does the same again."""

from pathlib import Path
from runpy import run_path

DRIVE = run_path(str(Path(__file__).with_name("$name.py")))["drive"]


def test_it_stays_in_its_lane():
    drive = DRIVE(length_m=400.0, duration_s=120.0)
    assert drive.metrics["autonomous"]["distance_m"] > 395.0
    assert drive.metrics["autonomous"]["lateral_max_m"] < 0.5
    assert abs(drive.column("own.lateral_m")[5:]).max() < 0.5


def test_it_does_the_same_again():
    first, second = (DRIVE(length_m=50.0, duration_s=60.0) for _ in range(2))
    assert first.digest == second.digest
    assert first.replay().hashes_equal
'''

SCENARIO: Final = """\
# $name: a person hands over, a controller accelerates, the person brakes. What is accepted stands in
# golden/$name.csv: `simconsole check $name.yaml` compares, `--update-golden` accepts anew.
schema: 1
title: $name
duration_s: 12
session:
  schema: 1
  scenario: {vehicle: hatchback}
  devices: {driver: none}
script:
  points:
    - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
    - {time_s: 2.5, brake: 0}
    - {time_s: 3.0, brake: 0, press: [autonomous]}
    - {time_s: 8.0, brake: 0, clutch: 0}
    - {time_s: 8.2, brake: 0.5, clutch: 1}
    - {time_s: 12.0, brake: 0.5, clutch: 1}
remote:
  - {start_s: 1.0, end_s: 12.0, kind: acceleration, accel_mps2: 1.5}
checks:
  - {column: arbitration.mode, at_s: 5.0, min: 3, max: 3}
  - {column: vehicle.vx_mps, at_s: 8.0, min: 4.0, max: 10.0}
  - {column: arbitration.mode, from_s: 8.5, min: 1, max: 1}
"""

TEST_SCENARIO: Final = '''\
"""$name keeps its bounds and its golden."""

from pathlib import Path

import simconsole


def test_it_keeps_its_bounds_and_its_golden():
    verdict = simconsole.check(Path(__file__).with_name("$name.yaml"))
    assert verdict.passed, verdict.problems
'''

VEHICLE_HEAD: Final = "# $name: begun as the shipped {begun}. A session or scenario beside it names it `$name.yaml`.\n"

TEST_VEHICLE: Final = '''\
"""$name drives off, steers to the side it is asked to, brakes, and replays."""

from pathlib import Path

import simconsole

SESSION = simconsole.load("bridge").with_values(
    {"environment.world": None, "scenario.vehicle": str(Path(__file__).with_name("$name.yaml"))}
)


def controller(seen):
    """Ten seconds to the left, then stop."""
    return simconsole.hold_speed(6.0 if seen.t_s < 10.0 else 0.0, 0.05 if seen.t_s > 5.0 else 0.0)


def test_it_drives():
    drive = SESSION.run(controller, duration_s=20.0)
    speed_mps, yaw_rad = drive.column("vehicle.vx_mps"), drive.column("vehicle.yaw_rad")
    assert abs(speed_mps[drive.time_s == 10.0] - 6.0) < 0.5
    assert yaw_rad[-1] > 0.1
    assert abs(speed_mps[-1]) < 0.05
    assert drive.replay().hashes_equal


def test_more_mass_makes_it_slower():
    body = SESSION.resolved.vehicle.body
    laden = SESSION.with_values({"body.mass_kg": 1.2 * body.mass_kg})
    way_m = [
        session.run(lambda seen: simconsole.actuate(0.3, 0.0), duration_s=8.0).column("vehicle.distance_m")[-1]
        for session in (SESSION, laden)
    ]
    assert way_m[1] < way_m[0]
'''

WORLD_PLAN: Final = """\
# $name: the plan of a course, elements in driving order, angles left-positive. "free" straights close the loop.
# After a change: python -m simconsole.world.tools.generate $name.plan.yaml $name.yaml
schema: 1
title: $name
lane_width_m: 3.5
speed_limit_kmh: 50
length_m: 600
elements:
  - {element: straight, length_m: 120}
  - {element: curve, radius_m: 30, angle_deg: 90}
  - {element: straight, length_m: free}
  - {element: curve, radius_m: 30, angle_deg: 90}
  - element: straight
    length_m: free
    features:
      - {feature: crossing, at_m: 40}
  - {element: curve, radius_m: 30, angle_deg: 90}
  - {element: straight, length_m: free}
  - {element: curve, radius_m: 30, angle_deg: 90}
"""

TEST_WORLD: Final = '''\
"""$name is what its plan says, and can be driven."""

from pathlib import Path

import simconsole

WORLD = Path(__file__).with_name("$name.yaml")
SESSION = simconsole.load("bridge").with_values({"environment.world": str(WORLD)})


def test_it_is_what_its_plan_says(tmp_path):
    from simconsole.world.tools.generate import generate

    generate(str(WORLD.with_name("$name.plan.yaml")), str(tmp_path / WORLD.name))
    assert (tmp_path / WORLD.name).read_text() == WORLD.read_text()


def test_its_route_closes():
    route = SESSION.route
    start, end = route.at(0.0), route.at(route.length_m - 1e-6)
    assert abs(start.x_m - end.x_m) < 0.01
    assert abs(start.y_m - end.y_m) < 0.01


def test_a_vehicle_stands_on_it_and_drives():
    drive = SESSION.run(lambda seen: simconsole.hold_speed(5.0), duration_s=10.0)
    assert drive.metrics["autonomous"]["distance_m"] > 20.0
    assert drive.metrics["autonomous"]["lateral_max_m"] < 0.1
'''

SESSION: Final = """\
# $name: a car on the urban course that only a controller commands. `simconsole drive $name.yaml --headless` waits for
# one over rosbridge; `simconsole.load("$name.yaml").run(controller)` calls one.
schema: 1
title: $name
environment:
  world: urban
scenario:
  vehicle: hatchback
  duration_s: 30
features:
  control:
    person_required: false
outputs:
  bridge: {}
  hud: null
devices:
  driver: none
mode:
  tick_hz: 250
  pacing: lockstep
"""

TEST_SESSION: Final = '''\
"""$name can be opened and driven, and its drive replays."""

from pathlib import Path

import simconsole


def test_it_drives_and_replays():
    session = simconsole.load(Path(__file__).with_name("$name.yaml"))
    drive = session.run(lambda seen: simconsole.hold_speed(5.0), duration_s=5.0)
    assert drive.ticks == 5 * session.profile.mode.tick_hz
    assert drive.column("vehicle.vx_mps")[-1] > 2.0
    assert drive.replay().hashes_equal
'''
