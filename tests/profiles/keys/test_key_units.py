"""The unit of a key is that of its name, as docs/units.md has it."""

import re

import pytest

from simconsole.profiles.keys.catalogue import catalogue
from simconsole.profiles.keys.key_units import MEASURES, WRITTEN, key_unit
from simconsole.values.units import unit_of
from tests.paths import ROOT

TABLE = set(re.findall(r"`_(\w+)` \|", (ROOT / "docs" / "units.md").read_text("utf-8")))
UNITLESS = {
    *("share", "ratio", "scale", "gain", "raw", "zone", "hysteresis", "override", "pressed", "brake", "damper"),
    *("max", "fall", "slip", "stiffness", "resistance", "closed", "open", "lateral", "urgent", "longitudinal"),
    *("from", "factor", "gear", "indicators", "id", "length", "clients", "fragments", "steps", "red"),
}
"""Last words of the names of numbers that are shares, counts and the like; `rpm_max` and `rpm_red` say theirs first."""


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("speed_kmh", "km/h"),
        ("drag_area_m2", "m^2"),
        ("stability_nm_per_radps", "N m per rad/s"),
        ("answered_bytes_per_s", "bytes/s"),
        ("foot_per_s", "1/s"),
        ("drag_nm_per_1000rpm", "N m per 1000/min"),
        ("compliance_deg_per_100nm", "deg per 100 N m"),
        ("slip_m_per_root_m", "m per root of m"),
        ("cornering_stiffness_per_rad", "1/rad"),
        ("camber_per_roll", ""),
        ("friction_right_share", ""),
        ("m", ""),
    ],
)
def test_a_name_says_its_unit(name: str, unit: str) -> None:
    assert key_unit(name) == unit


def test_every_unit_of_a_key_stands_in_the_table() -> None:
    for key in catalogue():
        if key.unit:
            for part in key.name.split("_per_"):
                suffix = part.rpartition("_")[2]
                measured = key_unit(f"_{suffix}") and suffix not in MEASURES
                assert not measured or suffix in TABLE or part == "s", key.path


def test_every_unit_of_the_table_is_known() -> None:
    assert set(WRITTEN) <= TABLE
    assert {suffix for suffix in TABLE if not key_unit(f"value_{suffix}")} == set()


def test_no_unit_is_written_twice() -> None:
    assert {suffix for suffix in WRITTEN if unit_of(f"value_{suffix}") != "1"} == set()


def test_a_number_without_a_unit_is_a_share_or_a_count() -> None:
    last = {
        key.name.rpartition("_")[2]
        for key in catalogue()
        if "number" in key.type and not key.unit and "_" in key.name and "_per_" not in key.name
    }
    assert last - {"100kmh"} == UNITLESS
