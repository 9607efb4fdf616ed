"""The tests of single functions and ticks of the arbitration take every line and branch of it."""

import json
import subprocess
import sys
from pathlib import Path

from tests.paths import ROOT

ROOM = ROOT / "simconsole" / "control"
DRIVES = (
    *("arbitration", "commander", "flapping", "implausible", "pairs", "random", "reactions"),
    *("shared_drives", "short_drives", "speed_loop", "stops", "walk"),
)
"""Tests that drive for seconds would take what single tests should take, and compiled code is not seen line by line."""
BEYOND = (
    *("more_than_five_seconds", "waited_for_ten_seconds", "does_not_grant", "is_not_refused", "shown_for_a_while"),
    *("hazard_lights", "short_knocks", "lateral_acceleration_is_limited_by_angle", "after_a_silence"),
    *("takes_authority", "cleared_by_reset", "lateral_jerk", "gets_a_bad_value_through"),
)
"""Parts of the names of tests that drive for seconds in the other files, and take no line that the others do not."""
LEFT_OUT = tuple(f"test_{name}.py" for name in (*DRIVES, "coverage", "mutation_page"))


def test_every_line_and_branch_is_taken(tmp_path: Path) -> None:
    files = sorted(path for path in (ROOT / "tests" / "control").rglob("test_*.py") if path.name not in LEFT_OUT)
    environment = {"COVERAGE_FILE": str(tmp_path / "coverage"), "PYTHONPATH": str(ROOT), "PATH": ""}
    run = [sys.executable, "-m", "coverage"]
    measure = [*run, "run", "--branch", "--source", str(ROOM), "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(
        [*measure, "-k", f"not ({' or '.join(BEYOND)})", *map(str, files)],
        cwd=ROOT, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-1000:]
    report = tmp_path / "report.json"
    subprocess.run([*run, "json", "-q", "-o", report], cwd=ROOT, env=environment, check=True)
    pages = json.loads(report.read_text())["files"]
    missed = {
        name: (page["missing_lines"], page["missing_branches"])
        for name, page in pages.items()
        if page["missing_lines"] or page["missing_branches"]
    }
    assert len(pages) > 15
    assert missed == {}
