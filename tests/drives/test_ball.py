"""The paper's first example as two programs: the ROS side sends desired speed and pose, the console rolls the ball.

Its node of ROS 2 rolls in tests/interop/test_roll_a_ball.py.
"""

import math
import os
import re
import subprocess
import sys
from pathlib import Path
from runpy import run_path

import numpy as np
import pytest

import simconsole
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.reading import LogTable
from simconsole.values.signals import Mode
from tests.drives.console import Running, environment
from tests.patience import PATIENCE_S
from tests.ports import free_port

EXAMPLE = Path(simconsole.__file__).parents[1] / "examples" / "roll_a_ball" / "roll_a_ball.py"
GAME = run_path(str(EXAMPLE.with_name("game.py")))


class Rolled:
    """What is left of one drive of the ball."""

    def __init__(self, folder: Path) -> None:
        self.bundle = folder / "bundle"
        port = free_port()
        shipped = (EXAMPLE.parents[2] / "profiles" / "sessions" / "roll_a_ball.yaml").read_text()
        assert shipped.count("port: 9090") == 1
        session = folder / "session.yaml"
        session.write_text(shipped.replace("port: 9090", f"port: {port}"))
        with Running(folder, "drive", session, "--out", self.bundle, "--json") as console:
            example = subprocess.run(
                [sys.executable, str(EXAMPLE), "--port", str(port)],
                capture_output=True,
                text=True,
                timeout=PATIENCE_S,
                env=environment(PYTHONPATH=os.pathsep.join(entry for entry in sys.path if entry)),
                check=False,
            )
            self.done = console.end()
        assert example.returncode == 0, example.stderr
        assert self.done.returncode == 0, self.done.stderr
        self.said = example.stdout
        self.table: LogTable = open_bundle(self.bundle).log.table()


@pytest.fixture(scope="module")
def rolled(tmp_path_factory: pytest.TempPathFactory) -> Rolled:
    return Rolled(tmp_path_factory.mktemp("ball"))


def test_the_ball_collects_every_cube(rolled: Rolled) -> None:
    collected = re.findall(r"collected (\d) of 8 cubes at \(([-\d.]+), ([-\d.]+)\)", rolled.said)
    assert [int(count) for count, _, _ in collected] == [1, 2, 3, 4, 5, 6, 7, 8]
    assert "the drive has ended, 0 cubes are left" in rolled.said
    x, y = rolled.table.column("vehicle.x_m"), rolled.table.column("vehicle.y_m")
    for cube in GAME["CUBES_M"]:
        assert np.hypot(x - cube[0], y - cube[1]).min() < GAME["TOUCH_M"]
    speed = np.hypot(rolled.table.column("vehicle.vx_mps"), rolled.table.column("vehicle.vy_mps"))
    assert math.isclose(speed.max(), 0.8, abs_tol=0.05), "at the speed that was asked for"


def test_arrow_keys_say_where_it_rolls() -> None:
    game = GAME["Game"]()
    game.by_keys = True
    assert game.roll(0.5, 0.25) == (0.5, 0.25), "no key, no way"
    for key, goal in (("A", (0.5, 1.25)), ("B", (0.5, -0.75)), ("C", (1.5, 0.25)), ("D", (-0.5, 0.25))):
        game.press(f"\x1b[{key}")
        assert game.roll(0.5, 0.25) == goal
    game.press(" ")
    assert game.roll(0.5, 0.25) == (0.5, 0.25)
    assert len(game.left) == 8
    game.roll(1.5, 0.0)
    assert len(game.left) == 7


def test_sessions_of_the_example_are_the_shipped_one_but_for_what_they_say() -> None:
    shipped = simconsole.load("roll_a_ball").profile
    for name, pacing in (("ros2.yaml", "lockstep"), ("by_hand.yaml", "realtime")):
        own = simconsole.load(EXAMPLE.with_name(name)).profile
        assert own.mode.pacing == pacing
        assert (own.scenario.vehicle, own.features, own.mode.tick_hz) == (
            "ball",
            shipped.features,
            shipped.mode.tick_hz,
        )


def test_nobody_sits_at_the_wheel_and_the_ros_side_asks_for_control(rolled: Rolled) -> None:
    modes = rolled.table.column("arbitration.mode")
    assert modes[0] == Mode.PARKED
    assert modes[-1] == Mode.AUTONOMOUS
    assert (rolled.table.column("ros.refused") == 0.0).all()


def test_the_ball_replays_and_is_reported_as_the_car_is(rolled: Rolled) -> None:
    assert verify(rolled.bundle) == []
    found = replay_bundle(rolled.bundle)
    assert found.hashes_equal, found.differences
    assert found.ticks == len(rolled.table.ticks) == 2000
    assert "<svg" in (rolled.bundle / "report.html").read_text("utf-8")
    assert (rolled.bundle / "scene.rrd").stat().st_size > 10_000
