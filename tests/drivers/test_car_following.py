import math

import pytest

from simconsole.drivers.car_following import Following, following_mps2

HOW = Following(gap_m=3.0, headway_s=1.5, accelerate_mps2=1.6, brake_mps2=1.6, hardest_mps2=6.0)
STEP_S = 0.02


def test_nobody_ahead_allows_everything() -> None:
    assert following_mps2(math.inf, 0.0, 30.0, HOW) == HOW.accelerate_mps2


def test_bumper_to_bumper_is_braked_for_with_all_there_is() -> None:
    assert following_mps2(0.0, 0.0, 20.0, HOW) == following_mps2(-1.0, 0.0, 20.0, HOW) == -HOW.hardest_mps2


@pytest.mark.parametrize("lead_mps", [0.0, 5.0, 20.0])
@pytest.mark.parametrize("speed_mps", [0.0, 8.0, 15.0])
def test_gap_becomes_that_of_the_headway_and_is_never_less_than_at_rest(lead_mps: float, speed_mps: float) -> None:
    gap_m, least_m = 80.0, math.inf
    for _ in range(20_000):
        speed_mps = max(0.0, speed_mps + following_mps2(gap_m, lead_mps, speed_mps, HOW) * STEP_S)
        gap_m += (lead_mps - speed_mps) * STEP_S
        least_m = min(least_m, gap_m)
    assert speed_mps == pytest.approx(lead_mps, abs=0.02)
    assert gap_m == pytest.approx(HOW.gap_m + HOW.headway_s * lead_mps, abs=0.5)
    assert least_m >= HOW.gap_m - 0.1


def test_leader_that_brakes_hard_is_not_run_into() -> None:
    speed_mps = lead_mps = 14.0
    gap_m = least_m = HOW.gap_m + HOW.headway_s * speed_mps
    for _ in range(2_000):
        lead_mps = max(0.0, lead_mps - 6.0 * STEP_S)
        speed_mps = max(0.0, speed_mps + following_mps2(gap_m, lead_mps, speed_mps, HOW) * STEP_S)
        gap_m += (lead_mps - speed_mps) * STEP_S
        least_m = min(least_m, gap_m)
    assert speed_mps < 0.05
    assert least_m > 0.5
