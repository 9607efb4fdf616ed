"""Rules for the whole run: in CI (`CI=true`) a skipped or expected-to-fail test is a failure; figures are printed.

A test that measures something keeps it with `record_property(NAME, TEXT)`; the figures stand above the summary line.
"""

import os
import signal
from pathlib import Path

import pytest

from tests.drives.fixtures import script, short

__all__ = ["script", "short"]

# A shell starts background jobs with SIGINT ignored, and every program a test starts would inherit that: a Ctrl-C sent
# to it would be lost, however the tests themselves were started.
signal.signal(signal.SIGINT, signal.default_int_handler)


HARDWARE = Path(__file__).parent / "hardware"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option without which the tests that need a real wheel and a person are not even collected."""
    parser.addoption("--hardware", metavar="COCKPIT", help="also test this cockpit's real devices (docs/hardware.md)")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave tests/hardware out unless asked for."""
    wanted = config.getoption("--hardware") is not None
    return True if collection_path.is_relative_to(HARDWARE) and not wanted else None


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


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Print what the tests measured; none of them passes or fails by it."""
    figures = [figure for report in terminalreporter.stats.get("passed", []) for figure in report.user_properties]
    for name, text in figures:
        terminalreporter.write_line(f"measured: {name}: {text}")
