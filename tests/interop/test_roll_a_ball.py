"""examples/roll_a_ball as a node of ROS 2: the ball rolls over DDS and collects its cubes."""

import json
from pathlib import Path

from tests.interop.programs import program
from tests.interop.ros2 import PYTHON, domain, needs_ros2
from tests.paths import ROOT
from tests.patience import PATIENCE_S

pytestmark = needs_ros2
EXAMPLE = ROOT / "examples" / "roll_a_ball"


def test_an_rclpy_node_collects_every_cube(tmp_path: Path) -> None:
    """The example's own session; nobody looks at a scene or a report of the drive."""
    around, session = domain(), tmp_path / "ros2.yaml"
    shown = (EXAMPLE / session.name).read_text()
    session.write_text(shown.replace("hud: null", "hud: null\n  scene: null\n  report: false"))
    words = (
        PYTHON,
        "-m",
        "simconsole",
        "drive",
        str(session),
        "--out",
        str(tmp_path / "bundle"),
        "--json",
        "--no-pack",
    )
    with program(around, *words) as drive, program(around, PYTHON, str(EXAMPLE / "roll_a_ball_rclpy.py")) as node:
        said, complaint = node.communicate(timeout=PATIENCE_S)
        assert node.returncode == 0, complaint
        output, complaint = drive.communicate(timeout=PATIENCE_S)
        assert drive.returncode == 0, complaint
    assert "collected 8 of 8 cubes" in said
    assert "the drive has ended, 0 cubes are left" in said
    results = json.loads(output.splitlines()[-1])
    assert (results["unanswered"], results["ticks"]) == (0, 2000)
