"""roslibpy's own live tests, out of its source distribution, all pass against our server: see roslibpy_suite.py."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interop.programs import CACHE
from tests.interop.roslibpy_suite import CASES, EACH, VERSION, fetch, is_good, run_all
from tests.samples import Sample


def test_all_of_roslibpys_own_tests_pass(
    tmp_path: Path, sample: Sample, record_property: Callable[[str, object], None]
) -> None:
    source = CACHE / f"roslibpy-{VERSION}"
    if not source.exists():
        CACHE.mkdir(parents=True, exist_ok=True)
        try:
            fetch(CACHE)
        except subprocess.CalledProcessError:
            pytest.skip("no package index to fetch roslibpy's source from")
    summaries = run_all(source, tmp_path, CASES if sample.long else EACH)
    assert {case: summary for case, summary in summaries.items() if not is_good(summary)} == {}
    passed = [int(summary.split(" passed")[0]) for summary in summaries.values()]
    assert passed == [25] * sample.of(2, 8)
    record_property(
        "roslibpy's own tests",
        f"{sum(passed)} of {sum(passed)} pass, on both its transports and ours, in both dialects",
    )
