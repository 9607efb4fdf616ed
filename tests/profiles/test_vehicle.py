"""The vehicle profiles that are shipped: where their numbers come from, and that the light van is one."""

import re
from pathlib import Path

import pytest

from simconsole.values.units import KMH_PER_MPS
from tests.paths import ROOT
from tests.vehicle.driving import Drive, platform

FOLDER = ROOT / "profiles" / "vehicles"
NUMBER = re.compile(r"[:\[]\s*-?\d")


def unsourced(text: str) -> list[str]:
    """Return the lines whose number has no remark, neither on the line nor on a key above that it belongs to."""
    missing: list[str] = []
    said: list[tuple[int, bool]] = []  # indent of each open key, and whether it has a remark
    for line in text.splitlines():
        code, _, remark = line.partition("#")
        if not code.strip():
            continue
        indent = len(code) - len(code.lstrip())
        while said and said[-1][0] >= indent:
            said.pop()
        sourced = bool(remark.strip()) or any(has for _, has in said)
        if NUMBER.search(code) and not sourced:
            missing.append(line)
        said.append((indent, bool(remark.strip())))
    return missing


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_number_says_where_it_comes_from(path: Path) -> None:
    assert unsourced(path.read_text()) == []


def test_a_number_without_a_source_is_found() -> None:
    assert unsourced("a:\n  b: 1  # usual\n  c: 2\nd:  # estimated\n  e: 3\nf: 4\n") == ["  c: 2", "f: 4"]


def test_the_light_van_drives_like_a_van() -> None:
    drive = Drive(platform("light_van"))
    drive.until(lambda seen: seen.vx_mps * KMH_PER_MPS >= 100.0, 30.0, automatic=1, gear=1, throttle=1.0)
    started, from_m = drive.time_s, drive.seen.x_m
    drive.until(lambda seen: seen.vx_mps <= 0.0, 10.0, automatic=1, gear=1, brake=1.0)
    stopped_m = drive.seen.x_m - from_m
    print(f"0-100 km/h in {started:.1f} s, 100-0 km/h in {stopped_m:.1f} m")
    assert 12.0 < started < 18.0
    assert 40.0 < stopped_m < 52.0
    drive = Drive(platform("light_van"))
    seen = drive.hold(120.0, automatic=1, gear=1, throttle=1.0)
    print(f"top speed {seen.vx_mps * KMH_PER_MPS:.0f} km/h in gear {seen.gear:.0f}")
    assert 140.0 < seen.vx_mps * KMH_PER_MPS < 180.0


def test_the_light_van_stalls_when_its_clutch_is_dumped_and_holds_on_a_slope() -> None:
    drive = Drive(platform("light_van"))
    drive.hold(0.5, clutch=1.0, gear=1)
    assert drive.hold(1.5, gear=1).engine_running == 0.0
    before = drive.hold(10.0, brake=0.5)
    assert abs(drive.hold(10.0, brake=0.5).x_m - before.x_m) < 1e-6
