"""A simulated person drives the shipped worlds by hand: how they keep the lane, how they differ, and hand-overs."""

import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.table import recorded_drive
from simconsole.profiles.files.world_files import load_world
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.signals import Mode
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import PathPoint, Route
from tests.drives.console import results, within
from tests.samples import Sample

CAR_WIDTH_M = 1.79
LANE_M = {"urban": 3.5, "urban_signals": 3.5, "motorway": 3.75, "country": 3.25, "skid_pad": 3.5}
"""Width of the lane that is driven in; the skid pad's is between cones, on a wide surface."""
LEAST_M, MOST_M = 0.15, 0.35
"""Standard deviation of the lateral position of alert drivers: docs/manual.md names the sources."""
SESSION = """\
schema: 1
environment: {{world: {world}}}
scenario: {{vehicle: hatchback, duration_s: {seconds}, start: {start}}}
outputs: {{hud: null, scene: null, report: false}}
devices:
  driver: virtual
  person: {{along: route, cruise_kmh: 130, top_gear: 6, sit_s: 0.3, seed: {seed}}}
mode: {{pacing: free, tick_hz: {tick_hz}}}
"""
TICK_HZ, SAMPLE_HZ = 250, 125
"""How a person keeps the lane is a matter of seconds: the sample of it has half the ticks."""
PAD_M = 430.0
"""From here the sample drives on the skid pad: a straight to shift up on, the bend, and the end."""


class Driven(NamedTuple):
    """One drive by hand."""

    bundle: Path
    lateral_m: np.ndarray[Any, np.dtype[np.float64]]
    speed_kmh: np.ndarray[Any, np.dtype[np.float64]]
    above_limit_kmh: float
    left_m: float  # of the route

    @property
    def deviation_m(self) -> float:
        """Of the lateral position, at 50 to 100 km/h; nan of a drive that is never that fast."""
        quick = (self.speed_kmh >= 50.0) & (self.speed_kmh <= 100.0)
        return float(self.lateral_m[quick].std(ddof=1)) if quick.sum() > 1 else math.nan


def route(world: str) -> Route:
    return open_world(load_world(world)).route


def place(at: PathPoint) -> str:
    """Return where a car stands at first, in YAML."""
    yaw_deg = math.remainder(at.yaw_rad, math.tau) * DEG_PER_RAD
    return f"{{x_m: {at.x_m}, y_m: {at.y_m}, yaw_deg: {yaw_deg}}}"


def by_hand(
    world: str, seed: int, folder: Path, seconds: float = 600.0, tick_hz: int = TICK_HZ, start_m: float = 0.0
) -> Driven:
    folder.mkdir(parents=True)
    start = place(route(world).at(start_m)) if start_m else "null"
    text = SESSION.format(world=world, seed=seed, seconds=seconds, tick_hz=tick_hz, start=start)
    (folder / "session.yaml").write_text(text)
    drive(resolve(load_session(str(folder / "session.yaml"))), folder / "bundle")
    table = open_bundle(folder / "bundle").log.table(("vehicle.x_m", "vehicle.y_m", "vehicle.vx_mps"))
    x, y, speed = (table.column(f"vehicle.{name}") for name in ("x_m", "y_m", "vx_mps"))
    places, lateral = route(world).project_all(x, y, start_m)
    above = float(((speed - route(world).limits_at(places)) * KMH_PER_MPS).max())
    done = Driven(folder / "bundle", lateral, speed * KMH_PER_MPS, above, route(world).length_m - float(places[-1]))
    print(f"measured: {world}, person {seed}: SDLP {done.deviation_m:.3f} m, max {np.abs(lateral).max():.2f} m")
    return done


def stays(done: Driven, world: str) -> bool:
    """Whether the whole car stays between the lines of its lane."""
    return bool(np.abs(done.lateral_m).max() + 0.5 * CAR_WIDTH_M <= 0.5 * LANE_M[world])


def test_people_keep_the_lane_as_published_and_differ(sample: Sample, tmp_path: Path) -> None:
    found = []
    for number in range(sample.of(2, 20)):
        world = "country" if number % 2 == 0 else "motorway"
        seconds, tick_hz = sample.of(120, 600), sample.of(SAMPLE_HZ, TICK_HZ)
        done = by_hand(world, sample.seed + number, tmp_path / str(number), seconds, tick_hz)
        found.append(done.deviation_m)
        assert LEAST_M <= done.deviation_m <= MOST_M
        assert stays(done, world)
        assert done.above_limit_kmh < 0.0
    assert len(set(found)) == len(found)


@pytest.mark.parametrize("world", ["skid_pad"])
def test_a_route_is_driven_by_hand_to_its_end(sample: Sample, world: str, tmp_path: Path) -> None:
    done = by_hand(world, 1, tmp_path / "drive", start_m=0.0 if sample.long else PAD_M)
    assert stays(done, world)
    assert -0.5 < done.left_m < 6.0
    assert done.speed_kmh[-1] < 0.2
    found = metrics(recorded_drive(open_bundle(done.bundle).log), route(world))
    assert found["autonomous"] is None
    assert 0.1 < found["manual"]["lateral_deviation_m"] < MOST_M
    assert replay_bundle(done.bundle).problems == ()


@pytest.mark.parametrize("world", ["urban", "urban_signals", "motorway", "country"])
def test_long_worlds_are_driven_by_hand_by_several_people(sample: Sample, world: str, tmp_path: Path) -> None:
    assert route(world).length_m > 500.0
    for seed in range(sample.of(0, 5)):
        done = by_hand(world, sample.seed + seed, tmp_path / str(seed))
        assert stays(done, world)
        assert done.above_limit_kmh < 0.0
        assert done.left_m < 6.0


@pytest.mark.parametrize(("start_m", "take_back_m", "end_m"), [(640.0, 150.0, 200.0), (1566.0, 200.0, 250.0)])
def test_in_a_bend_the_person_takes_over_and_stays_in_the_lane(
    start_m: float, take_back_m: float, end_m: float, tmp_path: Path
) -> None:
    """The autopilot drives into bends of 50 m to the left and 40 m to the right; there the person turns the wheel."""
    way = route("urban")
    assert abs(way.curvature_at(start_m + take_back_m)) > 0.01
    (tmp_path / "session.yaml").write_text(
        "schema: 1\nenvironment: {world: urban}\nfeatures: {autopilot: urban}\n"
        f"scenario: {{vehicle: hatchback, duration_s: 90, start: {place(way.at(start_m))}}}\n"
        "outputs: {hud: null, scene: null, report: false, bridge: {port: 0}}\n"
        "devices: {driver: virtual, person: {along: route, sit_s: 0.3, cruise_kmh: 50, autonomy: {distance_m: 40}, "
        f"take_back: {{distance_m: {take_back_m}}}, stop: {{distance_m: {end_m}}}}}}}\n"
        "mode: {pacing: lockstep, answer_timeout_s: 60}\n"
    )
    drive(resolve(load_session(str(tmp_path / "session.yaml"))), tmp_path / "bundle")
    table = open_bundle(tmp_path / "bundle").log.table()
    mode = table.column("arbitration.mode")
    assert [mode[0], *mode[1:][np.diff(mode) != 0.0]] == [Mode.MANUAL, Mode.AUTONOMOUS, Mode.MANUAL]
    s, lateral = way.project_all(table.column("vehicle.x_m"), table.column("vehicle.y_m"), start_m)
    taken = int(np.flatnonzero(mode == float(Mode.AUTONOMOUS))[-1]) + 1
    assert abs(way.curvature_at(float(s[taken]))) > 0.01
    print(f"measured: hand-over in a bend: max {np.abs(lateral[taken:]).max():.2f} m after it")
    assert np.abs(lateral).max() + 0.5 * CAR_WIDTH_M <= 0.5 * LANE_M["urban"]
    assert replay_bundle(tmp_path / "bundle").problems == ()


def test_the_command_line_lets_any_person_drive_a_session_that_names_none(tmp_path: Path) -> None:
    (tmp_path / "session.yaml").write_text(
        "schema: 1\nenvironment: {world: skid_pad}\noutputs: {hud: null, scene: null, report: false}\n"
    )
    bundles = []
    for seed in (1, 2):
        words = ("--headless", "--driver", "virtual", "--person", seed, "--for", 3, "--out", tmp_path / str(seed))
        done = within("drive", tmp_path / "session.yaml", *words, "--json", "--no-pack")
        assert done.returncode == 0, done.stderr
        assert "by the person " in done.stderr
        bundles.append(results(done)["digest"])
    assert bundles[0] != bundles[1]


def test_along_a_route_there_must_be_one(tmp_path: Path) -> None:
    (tmp_path / "session.yaml").write_text("schema: 1\noutputs: {hud: null, scene: null, report: false}\n")
    words = ("--headless", "--driver", "virtual", "--for", 1, "--out", tmp_path / "bundle")
    done = within("drive", tmp_path / "session.yaml", *words)
    assert done.returncode == 2
    assert "devices.person.along: value route: straight, without environment.world" in done.stderr
