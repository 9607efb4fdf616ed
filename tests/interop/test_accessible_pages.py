"""axe-core, unmodified, in a browser: the pages that the console writes, and those of the examples, shut nobody out."""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.cli.main import main
from simconsole.evaluation.checks.review import ColumnReview, Review
from simconsole.evaluation.manoeuvres.attempt import Result
from simconsole.evaluation.report.manoeuvre_page import Chapter, write_handling_report
from simconsole.evaluation.report.review_page import write_review
from simconsole.evaluation.report.sweep_page import write_sweep_page
from simconsole.evaluation.sweep.task import TaskResult
from simconsole.profiles.manoeuvre import Limit
from tests.drives.fixtures import Demo
from tests.evaluation.sweep.plans import grip
from tests.interop.browser import CHROMIUM, Page, browse
from tests.interop.programs import npm_packages
from tests.paths import ROOT
from tests.patience import wait_until

VERSION = "4.14.1"
WIDTHS_PX = (390, 1400)
HEIGHT_PX = 900
WRITTEN = ("report.html", "beside.html", "heavy/pair.html", "review.html", "handling.html", "sweep.html")
EXAMPLES = ("controllers/with_roslib.html", "web_view/index.html")

pytestmark = [
    pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: system-packages.txt"),
    pytest.mark.skipif(shutil.which("npm") is None, reason="no npm: system-packages.txt"),
]


@pytest.fixture(scope="module")
def pages(demo: Demo, short: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with one page of each kind."""
    folder = tmp_path_factory.mktemp("pages")
    shutil.copy(demo.bundle / "report.html", folder)
    copy = shutil.copytree(short, folder / "short")
    assert main(["report", str(copy), str(demo.bundle), "--out", str(folder / "beside.html")]) == 0
    assert main(["replay", str(copy), "--set", "body.mass_kg=1900", "--out", str(folder / "heavy")]) == 0
    time_s = np.array([0.5, 1.0])
    column = ColumnReview("vehicle.vx_mps", "m/s", time_s, time_s, 2.0 * time_s, 0.5, 1.0, 1.0)
    write_review(folder / "review.html", [Review("launch", "Launch", ("a remark",), (column,))], ["stop"])
    chapter = Chapter("circle", "Circle", Result({"roll_deg": 4.25}, ()), (Limit(value="roll_deg", max=5.0),), ())
    write_handling_report(folder / "handling.html", [chapter])
    driven = {at: TaskResult(index=at, outcome="driven", metrics={"a_m": float(at)}) for at in range(4)}
    write_sweep_page(folder / "sweep.html", grip(folder, 5), driven, lambda index: f"simconsole sweep --drive {index}")
    return folder


@pytest.fixture(scope="module")
def page(pages: Path) -> Iterator[Page]:
    """A browser with axe-core at hand."""
    (pages / "browser").mkdir()
    with browse("about:blank", pages / "browser", WIDTHS_PX[0], HEIGHT_PX) as opened:
        yield opened


@pytest.fixture(scope="module")
def axe() -> str:
    program = "axe-core/axe.min.js"
    return (npm_packages(f"axe-core-{VERSION}", program, f"axe-core@{VERSION}") / program).read_text()


def violations(page: Page, url: str, width_px: int, axe: str) -> list[str]:
    """What axe-core finds: the rule, and where."""
    page.call("Emulation.setDeviceMetricsOverride", width=width_px, height=HEIGHT_PX, deviceScaleFactor=1, mobile=False)
    page.call("Page.navigate", url=url)
    wait_until(lambda: page.value("location.href + document.readyState") == f"{url}complete", "the page")
    page.call("Runtime.evaluate", expression=axe)
    heard: dict[str, Any] = page.call(
        "Runtime.evaluate", expression="axe.run().then(JSON.stringify)", awaitPromise=True, returnByValue=True
    )
    found = json.loads(heard["result"]["value"])
    assert found["passes"], "axe-core has looked at nothing"
    nodes = [(one["id"], node) for one in found["violations"] for node in one["nodes"]]
    return [f"{rule}: {node['target']} {node['failureSummary']}" for rule, node in nodes]


@pytest.mark.parametrize("width_px", WIDTHS_PX)
@pytest.mark.parametrize("name", WRITTEN)
def test_a_page_that_the_console_writes(name: str, width_px: int, pages: Path, page: Page, axe: str) -> None:
    assert violations(page, (pages / name).as_uri(), width_px, axe) == []
    assert page.value("document.documentElement.scrollWidth <= innerWidth"), "it is wider than the window"


@pytest.mark.parametrize("width_px", WIDTHS_PX)
@pytest.mark.parametrize("name", EXAMPLES)
def test_a_page_of_an_example(name: str, width_px: int, page: Page, axe: str) -> None:
    assert violations(page, (ROOT / "examples" / name).as_uri(), width_px, axe) == []


def test_what_shuts_somebody_out_would_be_found(tmp_path: Path, page: Page, axe: str) -> None:
    path = tmp_path / "bad.html"
    path.write_text("<!DOCTYPE html><title>Bad</title><img src='x.png'>")
    found = violations(page, path.as_uri(), WIDTHS_PX[0], axe)
    assert {line.partition(":")[0] for line in found} >= {"html-has-lang", "image-alt"}
