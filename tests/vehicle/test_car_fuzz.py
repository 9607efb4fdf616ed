"""Millions of steps of anything: finite, inside physical bounds, and at rest afterwards."""

from collections.abc import Callable

import numpy as np
import pytest

from tests.samples import Sample

from . import fuzzing

FEW = fuzzing.SUBJECTS["hatchback"]._replace(cars=64)


def test_millions_of_steps_of_anything_stay_physical_and_end_at_rest(
    record_property: Callable[[str, object], None], sample: Sample
) -> None:
    steps = sample.of(1_000_000, 100_000_000)
    subject = fuzzing.SUBJECTS["hatchback"]
    found = fuzzing.fuzz(steps, sample.seed, subject._replace(cars=sample.of(64, subject.cars)))
    record_property("car, fuzzed steps", f"{found.steps} in {found.cpu_s:.1f} s CPU, rest {found.rest_mps:.1e} m/s")
    assert found.steps >= steps
    assert not found.beyond
    assert found.rest_mps < fuzzing.REST_MPS
    assert min(found.lowest["vx_mps"], found.lowest["vy_mps"]) < -fuzzing.HIT_MPS * 0.9, "nothing was hit"
    assert (found.lowest["gear"], found.highest["gear"]) == (-1.0, 6.0)
    assert found.lowest["engine_running"] == 0.0


def test_hundreds_of_thousands_of_steps_on_a_tir_tyre_stay_physical_and_end_at_rest(
    record_property: Callable[[str, object], None], sample: Sample
) -> None:
    steps = sample.of(100_000, 10_000_000)
    subject = fuzzing.SUBJECTS["tir"]
    found = fuzzing.fuzz(steps, sample.seed, subject._replace(cars=sample.of(4, subject.cars)))
    record_property("car on a .tir, fuzzed", f"{found.steps} in {found.cpu_s:.1f} s CPU, rest {found.rest_mps:.1e} m/s")
    assert found.steps >= steps
    assert not found.beyond
    assert found.rest_mps < fuzzing.REST_MPS
    assert min(found.lowest["vx_mps"], found.lowest["vy_mps"]) < -fuzzing.HIT_MPS * 0.5, "nothing was hit"


def test_a_state_beyond_its_bound_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(fuzzing.BOUNDS, "vx_mps", (-10.0, 10.0))
    monkeypatch.setattr(fuzzing, "rest", lambda states, subject: 0.0)
    (line,) = fuzzing.fuzz(100_000, 3, FEW).beyond
    assert line.startswith("vx_mps: -")


def test_a_state_that_is_no_number_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(rng: np.random.Generator, states: fuzzing.Table) -> fuzzing.Table:
        states[:, fuzzing.AT["heave_m"]] = np.nan
        return states

    monkeypatch.setattr(fuzzing, "hit", broken)
    monkeypatch.setattr(fuzzing, "rest", lambda states, subject: 0.0)
    assert any(line.startswith("heave_m: nan") for line in fuzzing.fuzz(100_000, 3, FEW).beyond)
