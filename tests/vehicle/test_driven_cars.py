"""The page of the driven cars: how its script marks figures, and that the published one is red for no car of ours."""

import importlib
import math
import re
import sys
from typing import Any

import numpy as np
import pytest

from tests.paths import ROOT


@pytest.fixture
def script(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(ROOT / "scripts")
    module = importlib.import_module("make_driven_cars")
    yield module
    sys.modules.pop("make_driven_cars", None)


@pytest.fixture
def single_track(script: Any) -> Any:
    return importlib.import_module("validation.single_track")


def found(script: Any, place: float) -> dict[str, dict[str, dict[str, float]]]:
    """Return figures at a place of their range: 0 its low end, 1 its high end."""
    cars: dict[str, dict[str, dict[str, float]]] = {}
    for car in script.CARS:
        for figure in script.FIGURES:
            low, high = figure.van if car == "light_van" else figure.car
            value = (low + place * (high - low)) / figure.factor
            cars.setdefault(car, {}).setdefault(figure.manoeuvre, {})[figure.value] = value
    return cars


def test_figures_inside_are_plain_and_those_outside_are_red_and_said(script: Any) -> None:
    assert "🔴" not in script.page(found(script, 0.5)).partition("| ---")[2]
    page = script.page(found(script, 1.2))
    rows = [line for line in page.splitlines() if line.startswith("| ") and "🔴" in line]
    assert len(rows) == len(script.FIGURES)
    assert "n/a" in next(row for row in rows if row.startswith("| Parking torque"))
    assert "Out of range, hatchback: 0 to 100 km/h 13.3 s; Top speed 207 km/h" in page


def test_a_manoeuvre_that_could_not_be_driven_is_red(script: Any) -> None:
    given = found(script, 0.5)
    given["light_van"]["acceleration"] = {}
    assert "- Out of range, light van: 0 to 100 km/h none; Top speed none." in script.page(given)


def test_the_published_page_has_all_figures_and_none_of_hatchback_and_van_is_red(script: Any) -> None:
    rows = re.findall(
        r"^\| ([^-].*?) \| (.+?) \| (.+?) \| (.+?) \|", (ROOT / "docs" / "driven_cars.md").read_text(), re.M
    )
    labels = [row[0] for row in rows[1:]]
    assert labels == [figure.label for figure in script.FIGURES]
    assert [label for label, hatchback, van, _ in rows[1:] if "🔴" in hatchback + van] == []


def test_every_number_of_a_source_stands_below_the_table_and_every_source_is_named_in_it(script: Any) -> None:
    table, _, below = script.page(found(script, 0.5)).partition("- Out of range")
    listed = {int(number) for number in re.findall(r"^(\d+)\. ", below, re.M)}
    assert {int(number) for number in re.findall(r"\[(\d+)\]", table)} == listed


def test_transient_ranges_of_cars_are_those_of_the_published_single_tracks(script: Any, single_track: Any) -> None:
    cars = [single_track.figures(car) for car in single_track.PUBLISHED.values()]
    ranges = {figure.value: figure.car for figure in script.FIGURES}
    for value in ("yaw_rate_response_time_s", "yaw_rate_overshoot_percent", "yaw_rate_lag_at_1_hz_deg"):
        assert ranges[value] == pytest.approx((min(c[value] for c in cars), max(c[value] for c in cars)), rel=7e-3)
    assert ranges["yaw_rate_peak_ratio"][1] == pytest.approx(max(c["yaw_rate_peak_ratio"] for c in cars), rel=7e-3)
    assert ranges["yaw_rate_peak_frequency_hz"][0] == min(c["yaw_rate_peak_frequency_hz"] for c in cars)


@pytest.mark.parametrize(("car", "deg_per_g"), [("Acura TSX of 2007", 3.6), ("Honda Civic Si of 2012", 5.5)])
def test_compliances_make_the_understeer_that_was_measured(single_track: Any, car: str, deg_per_g: float) -> None:
    """By the steady gain of the sine: v over wheelbase and understeer gradient times v^2."""
    one = single_track.PUBLISHED[car]
    speed_mps = 100.0 / 3.6
    system, steered = single_track.matrices(one, speed_mps)
    gain = -np.linalg.solve(system, steered)[1]
    gradient = (speed_mps / gain - one.front_m - one.rear_m) / speed_mps**2
    assert math.degrees(9.80665 * gradient) == pytest.approx(deg_per_g, rel=1e-6)
