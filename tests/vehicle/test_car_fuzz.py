"""Ten million steps of anything: finite, inside physical bounds, and at rest afterwards."""

import random
from collections.abc import Callable

import numpy as np
import pytest

from . import fuzzing

STEPS = 10_000_000
TIR_STEPS = 400_000


def test_ten_million_steps_of_anything_stay_physical_and_end_at_rest(
    record_property: Callable[[str, object], None],
) -> None:
    seed = random.SystemRandom().randrange(2**32)
    print(f"seed {seed}")
    found = fuzzing.fuzz(STEPS, seed)
    record_property("car, fuzzed steps", f"{found.steps} in {found.seconds:.1f} s, rest {found.rest_mps:.1e} m/s")
    assert found.steps >= STEPS
    assert not found.beyond
    assert found.rest_mps < fuzzing.REST_MPS
    assert min(found.lowest["vx_mps"], found.lowest["vy_mps"]) < -fuzzing.HIT_MPS * 0.9, "nothing was hit"
    assert (found.lowest["gear"], found.highest["gear"]) == (-1.0, 6.0)
    assert found.lowest["engine_running"] == 0.0


def test_four_hundred_thousand_steps_on_a_tir_tyre_stay_physical_and_end_at_rest(
    record_property: Callable[[str, object], None],
) -> None:
    seed = random.SystemRandom().randrange(2**32)
    print(f"seed {seed}")
    found = fuzzing.fuzz(TIR_STEPS, seed, fuzzing.SUBJECTS["tir"])
    record_property("car on a .tir, fuzzed", f"{found.steps} in {found.seconds:.1f} s, rest {found.rest_mps:.1e} m/s")
    assert found.steps >= TIR_STEPS
    assert not found.beyond
    assert found.rest_mps < fuzzing.REST_MPS
    assert min(found.lowest["vx_mps"], found.lowest["vy_mps"]) < -fuzzing.HIT_MPS * 0.5, "nothing was hit"


def test_a_state_beyond_its_bound_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(fuzzing.BOUNDS, "vx_mps", (-10.0, 10.0))
    monkeypatch.setattr(fuzzing, "rest", lambda states, subject: 0.0)
    (line,) = fuzzing.fuzz(200_000, 3).beyond
    assert line.startswith("vx_mps: -")


def test_a_state_that_is_no_number_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(rng: np.random.Generator, states: fuzzing.Table) -> fuzzing.Table:
        states[:, fuzzing.AT["heave_m"]] = np.nan
        return states

    monkeypatch.setattr(fuzzing, "hit", broken)
    monkeypatch.setattr(fuzzing, "rest", lambda states, subject: 0.0)
    assert any(line.startswith("heave_m: nan") for line in fuzzing.fuzz(200_000, 3).beyond)
