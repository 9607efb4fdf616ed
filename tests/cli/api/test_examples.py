"""The examples of docs/python.md run as they stand."""

import runpy
from functools import partial
from typing import Any

import numpy as np
import pytest
from gymnasium.vector import SyncVectorEnv

from simconsole import Drive, DrivingEnvironment, Session
from tests.paths import ROOT
from tests.samples import Sample

OWN_CONTROLLER = ROOT / "examples" / "own_controller" / "own_controller.py"
LANE_KEEPING = ROOT / "examples" / "lane_keeping" / "train.py"
MOST_LINES = 25


def test_an_own_controller_of_25_lines_drives_the_course(sample: Sample, monkeypatch: pytest.MonkeyPatch) -> None:
    """The whole course in `make long`; else its first two simulated minutes, through an S bend and a corner of 12 m."""
    longest_s, run = sample.of(120, 600), Session.run

    def brief(session: Session, *given: Any, duration_s: float, **more: Any) -> Drive:
        return run(session, *given, duration_s=min(duration_s, longest_s), **more)

    monkeypatch.setattr(Session, "run", brief)
    assert len(OWN_CONTROLLER.read_text().splitlines()) <= MOST_LINES
    drive = runpy.run_path(str(OWN_CONTROLLER))["drive"]
    assert isinstance(drive, Drive)
    driven = drive.metrics["autonomous"]
    assert driven["distance_m"] > sample.of(900, 2600)
    assert driven["lateral_max_m"] < 0.5
    assert abs(drive.column("own.lateral_m")[250:]).max() < 0.5


def test_a_linear_law_learns_to_hold_the_lane(sample: Sample, capsys: pytest.CaptureFixture[str]) -> None:
    """Before learning it leaves the lane; after it, it holds places that it has not seen to the end."""
    example, generations = runpy.run_path(str(LANE_KEEPING)), sample.of(3, 8)
    example["train"].__globals__["CANDIDATES"] = sample.of(16, example["CANDIDATES"])
    learners = SyncVectorEnv([partial(DrivingEnvironment, **example["OPTIONS"])] * example["PLACES"])
    unseen = range(900, 900 + example["PLACES"])
    try:
        before = example["returns"](learners, np.zeros(8), unseen)
        law = example["train"](learners, generations)
        after = example["returns"](learners, law, unseen)
    finally:
        learners.close()
    means = [float(line.partition("mean return")[2].split(",")[0]) for line in capsys.readouterr().out.splitlines()]
    assert len(means) == generations
    assert means[-1] > 2.0 * max(means[0], 10.0)
    assert after.min() > 70.0  # of at most 120 m less what it takes to drive off: none has left the lane
    assert after.sum() > before.sum() + 100.0
