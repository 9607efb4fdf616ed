"""docs/install.md: its table is of the libraries that are installed, as scripts/install_size.py finds them."""

import re
import runpy
import tomllib

import pytest

from tests.paths import ROOT

PAGE = (ROOT / "docs" / "install.md").read_text()
ROWS = re.findall(r"^\| ([^|]+) \| (\d+) MB \| (\d+) MB \| [^|]+ \| [^|]+ \|$", PAGE, re.MULTILINE)
OTHERS = "all others"
TOLERANCE = 0.1
"""Byte code of one Python is larger than that of another, as are libraries built for it."""


@pytest.fixture(scope="module")
def sizes_mb() -> dict[str, float]:
    script = runpy.run_path(str(ROOT / "scripts" / "install_size.py"))
    return {name: script["size_bytes"](one) / 1e6 for name, one in script["installed"]().items()}


def test_each_row_takes_what_the_table_says(sizes_mb: dict[str, float]) -> None:
    left = dict(sizes_mb)
    for names, _, disk_mb in ROWS:
        if names != OTHERS:
            found = sum(left.pop(name) for name in names.split(", "))
            assert found == pytest.approx(int(disk_mb), rel=TOLERANCE), names
    assert max(left.values()) < 7.0, "what is larger has a row, and a reason why it is no extra"
    (others,) = (int(disk_mb) for names, _, disk_mb in ROWS if names == OTHERS)
    assert sum(left.values()) == pytest.approx(others, rel=2 * TOLERANCE)


def test_sums_are_those_that_the_page_and_readme_tell(sizes_mb: dict[str, float]) -> None:
    fetched, disk_gb = re.findall(r"\*\*(\d+) MB to fetch, ([\d.]+) GB on disk\*\*", PAGE)[0]
    assert sum(int(mb) for _, mb, _ in ROWS) == int(fetched)
    assert sum(sizes_mb.values()) / 1e3 == pytest.approx(float(disk_gb), rel=TOLERANCE)
    assert f"[fetches {fetched} MB](docs/install.md), {disk_gb} GB on disk" in (ROOT / "README.md").read_text()


def test_every_extra_is_named() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    assert {extra for extra in extras if f"`{extra}`" not in PAGE} == {"dev"}
