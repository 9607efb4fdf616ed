"""A scenario that a recorded cockpit drives sees what was recorded, sample by sample."""

import numpy as np

from simconsole.session.resolution import load_scenario
from tests.evaluation.in_memory import drive_scenario
from tests.paths import ROOT


def test_each_sample_of_the_trace_arrives() -> None:
    scenario, path = load_scenario(str(ROOT / "profiles/scenarios/by_hand/recorded.yaml"))
    lines = path.with_suffix(".csv").read_text().splitlines()
    names, rows = lines[1].split(","), np.array([line.split(",") for line in lines[2:]], dtype=float)
    recorder, columns = drive_scenario(scenario)
    assert recorder.ticks == len(rows) == 2000
    for at, name in enumerate(names):
        if name != "tick":
            assert np.array_equal(recorder.vectors[:, columns.index(f"sample.{name}")], rows[:, at]), name
    assert len(np.unique(rows[:, names.index("wheel_axis")])) > 2, "somebody has turned the wheel"
