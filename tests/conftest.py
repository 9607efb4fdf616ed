"""Rules for the whole run: in CI (`CI=true`) a skipped or expected-to-fail test is a failure."""

import os

import pytest


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Turn a good run into a bad one where something was left out."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if os.environ.get("CI") != "true" or reporter is None:
        return
    left_out = [report for kind in ("skipped", "xfailed") for report in reporter.stats.get(kind, [])]
    for report in left_out:
        reporter.write_line(f"not run, and nothing may be left out in CI: {report.nodeid} {report.longrepr}")
    if left_out and session.exitstatus == pytest.ExitCode.OK:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
