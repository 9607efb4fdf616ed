"""The autopilot holds random courses with noisy, late odometry: behind the gate, over the WebSocket, with any car."""

from pathlib import Path

import numpy as np
import pytest

from tests.drives.random_courses import Tracked, random_course, tracked
from tests.samples import Sample

NOISE = "{position_noise_m: 0.02, yaw_noise_deg: 0.2}"
CARS = (("hatchback", 12, 50), ("light_van", 2, 50), ("commonroad_bmw320i", 2, 50))


def drives(sample: Sample, count: int, vehicle: str, link: str, folder: Path) -> list[Tracked]:
    rng = np.random.default_rng(sample.seed)
    done = []
    for number in range(count):
        seed = int(rng.integers(2**53))
        world = random_course(np.random.default_rng(seed))
        done.append(tracked(world, vehicle, link.replace("SEED", str(seed)), folder / str(number)))
        print(f"course {seed}: {done[-1]}")
    return done


def judge(done: list[Tracked], rms_cm: float, max_cm: float, what: str) -> None:
    worst_rms, worst = max(one.rms_cm for one in done), max(one.max_cm for one in done)
    lateral, longitudinal = min(one.lateral_kept for one in done), min(one.longitudinal_kept for one in done)
    print(
        f"measured: {what}, {len(done)} courses: RMS at most {worst_rms:.2f} cm, max {worst:.1f} cm, "
        f"lateral limit kept in {lateral:.2%}, longitudinal ones in {longitudinal:.2%}"
    )
    assert not any(one.stopped for one in done)
    assert worst_rms <= rms_cm
    assert worst <= max_cm
    assert np.mean([one.lateral_kept for one in done]) >= 0.999
    assert np.mean([one.longitudinal_kept for one in done]) >= 0.999


@pytest.mark.parametrize(("vehicle", "short", "full"), CARS)
def test_noise_and_40_ms(sample: Sample, tmp_path: Path, vehicle: str, short: int, full: int) -> None:
    link = f"{{seed: SEED, delay_ms: 40, localisation: {NOISE}}}"
    judge(drives(sample, sample.of(short, full), vehicle, link, tmp_path), 3.0, 12.0, f"{vehicle}, 40 ms")


@pytest.mark.parametrize("vehicle", [car for car, _, _ in CARS])
def test_noise_and_100_ms(sample: Sample, tmp_path: Path, vehicle: str) -> None:
    link = f"{{seed: SEED, delay_ms: 100, localisation: {NOISE}}}"
    judge(drives(sample, sample.of(1, 50), vehicle, link, tmp_path), 3.0, 20.0, f"{vehicle}, 100 ms")


def test_jitter_and_loss_besides(sample: Sample, tmp_path: Path) -> None:
    link = f"{{seed: SEED, delay_ms: 30, jitter_ms: 20, loss_share: 0.05, localisation: {NOISE}}}"
    judge(drives(sample, sample.of(1, 20), "hatchback", link, tmp_path), 3.0, 12.0, "hatchback, jitter and loss")
