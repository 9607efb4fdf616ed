import os
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any, NamedTuple

import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.log import LogTable
from tests.drives.console import results, simconsole
from tests.recording.conftest import rewrite_checksums, rewrite_log, rewrite_session

__all__ = ["rewrite_checksums", "rewrite_log", "rewrite_session"]


class Demo(NamedTuple):
    """The one demo of this test run."""

    bundle: Path
    done: "CompletedProcess[str]"
    results: dict[str, Any]
    table: LogTable
    cpu_s: float  # of the console and all that it started


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Demo:
    """`simconsole demo`, once for all tests, as a person starts it."""
    bundle = tmp_path_factory.mktemp("demo") / "bundle"
    before = os.times()
    done = simconsole("demo", "--out", bundle, "--json")
    after = os.times()
    cpu_s = sum(after[2:4]) - sum(before[2:4])
    assert done.returncode == 0, done.stderr
    return Demo(bundle, done, results(done), open_bundle(bundle).log.table(), cpu_s)
