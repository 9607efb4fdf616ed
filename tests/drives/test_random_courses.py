"""The autopilot holds random courses with noisy, late odometry: behind the gate, over the WebSocket, with any car."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from tests.drives.random_courses import FULL, HAND_OVER_M, SHORT, Tracked, random_course, tracked
from tests.samples import Sample

NOISE = "position_noise_m: 0.02, yaw_noise_deg: 0.2"
DRIFT = "position_drift_m: 0.3, yaw_drift_deg: 0.3"
CARS = (("hatchback", 2, 50), ("light_van", 1, 50), ("commonroad_bmw320i", 1, 50))
PLAIN = ("pure_pursuit", "stanley")
PART_M = 240.0
"""So far the sample drives over each of its short courses; some are round by then."""


def others(sample: Sample, row: int) -> Sample:
    """Return the sample with courses of its own for each row of a test."""
    return sample._replace(seed=sample.seed + row)


def drives(
    sample: Sample,
    count: int,
    vehicle: str,
    link: str,
    folder: Path,
    tracker: str = "preview",
    until_m: float = PART_M,
    rests: bool = False,
) -> list[Tracked]:
    """Drive over courses of the sample's size.

    The sample goes no farther than `until_m` on each, and only if `rests` do a person's hands rest on the wheel.
    """
    folder.mkdir(exist_ok=True)
    rng, until_m = np.random.default_rng(sample.seed), math.inf if sample.long else until_m
    hand_over_m = HAND_OVER_M if sample.long or rests else None
    done = []
    for number in range(count):
        seed = int(rng.integers(2**53))
        world = random_course(np.random.default_rng(seed), FULL if sample.long else SHORT)
        late, where = f"{{seed: {seed}, {link}}}", folder / str(number)
        one = tracked(world, vehicle, late, where, tracker, until_m=until_m, hand_over_m=hand_over_m)
        done.append(one)
        print(f"course {seed}: {done[-1]}")
    return done


class Figures(NamedTuple):
    """One row of the table, over all ticks of all its drives."""

    rms_cm: float  # the largest of a drive
    max_cm: float
    lateral_kept: float
    longitudinal_kept: float


def figures(done: list[Tracked], what: str) -> Figures:
    driven_s = sum(one.driven_s for one in done)
    lateral = sum(one.lateral_kept * one.driven_s for one in done) / driven_s
    longitudinal = sum(one.longitudinal_kept * one.driven_s for one in done) / driven_s
    worst_rms, worst = max(one.rms_cm for one in done), max(one.max_cm for one in done)
    print(
        f"measured: {what}, {len(done)} courses, {sum(one.stopped for one in done)} stops: "
        f"RMS at most {worst_rms:.2f} cm, max {worst:.1f} cm, "
        f"within 2.5 m/s2 in {lateral:.2%}, longitudinal limits in {longitudinal:.2%}, "
        f"angles reached behind the gate {np.mean([one.reached for one in done]):.2%}"
    )
    return Figures(worst_rms, worst, lateral, longitudinal)


def judge(done: list[Tracked], rms_cm: float, max_cm: float, what: str) -> None:
    seen = figures(done, what)
    assert not any(one.stopped for one in done)
    assert seen.rms_cm <= rms_cm
    assert seen.max_cm <= max_cm
    assert seen.lateral_kept >= 0.999
    assert seen.longitudinal_kept >= 0.999


@pytest.mark.parametrize(("vehicle", "short", "full"), CARS, ids=[vehicle for vehicle, _, _ in CARS])
def test_noise_and_40_ms(sample: Sample, tmp_path: Path, vehicle: str, short: int, full: int) -> None:
    link = f"delay_ms: 40, localisation: {{{NOISE}}}"
    done = drives(sample, sample.of(short, full), vehicle, link, tmp_path, rests=True)
    judge(done, 3.0, 12.0, f"{vehicle}, 40 ms")


def test_noise_and_100_ms(sample: Sample, tmp_path: Path) -> None:
    link = f"delay_ms: 100, localisation: {{{NOISE}}}"
    for row, (vehicle, _, full) in enumerate(CARS[: sample.of(1, len(CARS))]):
        done = drives(others(sample, row), sample.of(1, full), vehicle, link, tmp_path / vehicle)
        judge(done, 3.0, 20.0, f"{vehicle}, 100 ms")


def test_drift_is_followed(sample: Sample, tmp_path: Path) -> None:
    link = f"delay_ms: 40, localisation: {{{NOISE}, {DRIFT}}}"
    for row, (vehicle, _, full) in enumerate(CARS[: sample.of(1, len(CARS))]):
        done = drives(others(sample, row), sample.of(1, full), vehicle, link, tmp_path / vehicle)
        judge(done, 3.0, 12.0, f"{vehicle}, 40 ms, drift")


def test_jitter_and_loss_besides(sample: Sample, tmp_path: Path) -> None:
    there = "measurements: {delay_ms: 10, jitter_ms: 20, loss_share: 0.05}"
    link = f"delay_ms: 20, jitter_ms: 20, loss_share: 0.05, {there}, localisation: {{{NOISE}}}"
    judge(drives(sample, sample.of(1, 20), "hatchback", link, tmp_path), 3.0, 12.0, "hatchback, jitter and loss")


def test_plain_trackers_drive_behind_the_gate(sample: Sample, tmp_path: Path) -> None:
    """They are for comparison: nothing but that they get round is asked of them."""
    link = f"delay_ms: 40, localisation: {{{NOISE}}}"
    for row, tracker in enumerate(PLAIN[: sample.of(1, len(PLAIN))]):
        done = drives(others(sample, row), sample.of(1, 50), "hatchback", link, tmp_path / tracker, tracker, math.inf)
        figures(done, f"{tracker}, hatchback, 40 ms")
        assert all(one.driven_s > 20.0 for one in done)
