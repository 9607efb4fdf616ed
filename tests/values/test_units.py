"""Conversions: against their definitions, and their exact agreement with each other."""

import math
import re

import pytest

from simconsole.values import units
from tests.paths import ROOT


@pytest.mark.parametrize(
    ("factor", "definition"),
    [
        (units.RAD_PER_DEG, math.pi / 180.0),
        (units.DEG_PER_RAD, 180.0 / math.pi),
        (units.RADPS_PER_RPM, 2.0 * math.pi / 60.0),
        (units.RPM_PER_RADPS, 60.0 / (2.0 * math.pi)),
        (units.MPS_PER_KMH, 1000.0 / 3600.0),
        (units.KMH_PER_MPS, 3600.0 / 1000.0),
        (units.STANDARD_GRAVITY_MPS2, 9.80665),  # CGPM 1901
    ],
)
def test_factor_is_its_definition(factor: float, definition: float) -> None:
    assert factor == pytest.approx(definition, rel=2e-16)


@pytest.mark.parametrize(
    ("there", "back"),
    [
        (units.RAD_PER_DEG, units.DEG_PER_RAD),
        (units.MPS_PER_KMH, units.KMH_PER_MPS),
        (units.RADPS_PER_RPM, units.RPM_PER_RADPS),
    ],
)
def test_there_and_back_is_one(there: float, back: float) -> None:
    assert there * back == pytest.approx(1.0, rel=1e-15)


def test_tick_time_never_drifts() -> None:
    """Ten years at any rate: every whole second is a whole second."""
    for tick_hz in (50, 250, 1000):
        ten_years_s = 10 * 365 * 86_400
        assert units.tick_time_ns(ten_years_s * tick_hz, tick_hz) == ten_years_s * 1_000_000_000
    assert units.tick_time_ns(1, 300) == 3_333_333
    assert units.tick_time_ns(300, 300) == 1_000_000_000


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("vehicle.x_m", "m"),
        ("vehicle.vx_mps", "m/s"),
        ("vehicle.ax_mps2", "m/s^2"),
        ("memory.mode_ticks", "ticks"),
        ("torque.torque_nm", "N m"),
        ("platform.engine_impulse_nms", "N m s"),
        ("command.throttle", "1"),
        ("sample.hat_x", "1"),
        ("s", "1"),
    ],
)
def test_the_suffix_of_a_column_is_its_unit(name: str, unit: str) -> None:
    assert units.unit_of(name) == unit


def test_every_unit_of_the_documented_table_is_known() -> None:
    table = (ROOT / "docs" / "units.md").read_text("utf-8")
    suffixes = re.findall(r"`_(\w+)` \|", table.partition("Profiles are written by people")[0])
    assert len(suffixes) == 19
    assert all(units.unit_of(f"value_{suffix}") != "1" for suffix in suffixes)


@pytest.mark.parametrize(
    ("name", "shown", "factor"),
    [
        ("vehicle.yaw_rad", "vehicle.yaw_deg", units.DEG_PER_RAD),
        ("vehicle.yaw_rate_radps", "vehicle.yaw_rate_degps", units.DEG_PER_RAD),
        ("vehicle.vx_mps", "vehicle.vx_kmh", units.KMH_PER_MPS),
        ("vehicle.engine_radps", "vehicle.engine_rpm", units.RPM_PER_RADPS),
        ("vehicle.ax_mps2", "vehicle.ax_mps2", 1.0),
        ("driver.gear", "driver.gear", 1.0),
    ],
)
def test_displays_have_their_own_names_and_units(name: str, shown: str, factor: float) -> None:
    assert units.displayed(name) == (shown, factor)
