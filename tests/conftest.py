"""Rules for the whole run: in CI (`CI=true`) a skipped or expected-to-fail test is a failure; figures are printed.

A test that measures something keeps it with `record_property(NAME, TEXT)`; the figures stand above the summary line.
A test of a case of the fault catalogue says which (`@pytest.mark.fault("P11")`) and keeps what it saw with `measured`.
A random or long check takes its size and its seed from `sample` (tests/samples.py); `pytest --long` runs those whole
and writes docs/long-run.md. One of Hypothesis prints with a failure what draws it again.
"""

import datetime
import gc
import os
import signal
import subprocess
import sys
from collections.abc import Generator, Sequence
from functools import partial
from typing import Final

import hypothesis
import pytest
from xdist.remote import Producer
from xdist.workermanage import WorkerController

from tests import long_run, memory
from tests.account import Account
from tests.drives.fixtures import checked, demo, once, script, short
from tests.faults import figures
from tests.samples import SAMPLED, draw_seed, measured, module_sample, sample
from tests.scheduling import Stretches, scheduler_of

__all__ = ["checked", "demo", "measured", "module_sample", "once", "sample", "script", "short"]

account: Final = Account()
peaks: Final[list[memory.Peak]] = []
"""The largest process of the run, each time that a larger one was seen."""
tidying: Final = memory.Tidying()

# Where this is set (as in many containers), each of the hundreds of programs that the tests start would compile all
# sources of this project anew, which takes as long as half of its imports; and each process of a run all tests.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# Hypothesis would judge each example, and how quickly it draws them, by the clock.
hypothesis.settings.register_profile(
    "any machine", deadline=None, print_blob=True, suppress_health_check=[hypothesis.HealthCheck.too_slow]
)
hypothesis.settings.load_profile("any machine")

# A shell starts background jobs with SIGINT ignored, and nohup ignores SIGHUP; every program that a test starts would
# inherit that: a Ctrl-C or a hang-up sent to it would be lost, however the tests themselves were started.
signal.signal(signal.SIGINT, signal.default_int_handler)
if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options of long runs and of the tables that tests write."""
    parser.addoption("--long", action="store_true", help="run random and long checks only, at their full size, anew")
    parser.addoption("--seed", type=int, help="replay: the seed that a run has told")
    parser.addoption("--write-long-run", action="store_true", help="write what --long saw into docs/long-run.md")
    parser.addoption("--write-faults", action="store_true", help="write what was measured into docs/faults.md")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """Two processes more than there are cores: there are always tests that wait."""
    return (os.cpu_count() or 1) + 2


def pytest_configure(config: pytest.Config) -> None:
    """Settle the seed of the run: processes that run tests get the options as they are after this."""
    draw_seed(config)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> Stretches | None:
    """Where files are kept whole, each process goes through those that lie beside each other."""
    return Stretches(config, log) if config.getoption("dist") == "loadfile" else None


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes(config: pytest.Config) -> None:
    """Compile kernels while the processes that run tests start and collect them."""
    compiling = subprocess.Popen(
        [sys.executable, "-m", "tests.kernels"],
        cwd=config.rootpath,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    config.add_cleanup(partial(_ended, compiling))


def _ended(compiling: "subprocess.Popen[bytes]") -> None:
    """Leave no process behind, and tell where it failed: its kernels were compiled by the tests."""
    if compiling.poll() is None:
        compiling.kill()
        compiling.wait()
    elif compiling.returncode:
        sys.stderr.write(f"python -m tests.kernels ended with {compiling.returncode}\n")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol() -> Generator[None, object, object]:
    """Give back what tests have left."""
    done = yield
    tidying.after_test()
    return done


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Look for garbage seldom while tests are collected, and never among them: there are thousands, and they stay."""
    often = gc.get_threshold()
    gc.set_threshold(20_000, 20, 100)
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(*often)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Let reports say which cases of the fault catalogue a test is of; with --long keep those with a full size."""
    for item in items:
        item.user_properties += [("case", mark.args[0]) for mark in item.iter_markers("fault")]
    if not config.getoption("--long"):
        return
    chosen = [item for item in items if not set(SAMPLED).isdisjoint(getattr(item, "fixturenames", ()))]
    config.hook.pytest_deselected(items=[item for item in items if item not in chosen])
    items[:] = chosen


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_node_collection_finished(node: object, ids: Sequence[str]) -> None:
    """Keep which tests there are; all processes find the same."""
    account.tests = ids


def pytest_runtest_teardown(item: pytest.Item) -> None:
    """Keep how large the processes were until here: the report of the teardown tells it to the process of the run."""
    item.user_properties.append((memory.KEY, memory.peak_mb()))
    item.user_properties.append((memory.LEFT_KEY, tidying.left_mb))


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Keep of which tests there was an outcome."""
    if report.when not in ("setup", "call"):  # a process that died in a test is none of the three
        account.ended.add(report.nodeid)
    for name, value in report.user_properties:
        if name == memory.KEY and isinstance(value, float) and value > (peaks[-1].memory_mb if peaks else 0.0):
            peaks.append(memory.Peak(value, report.nodeid))
        if name == memory.LEFT_KEY and isinstance(value, float) and value > memory.LARGE_MB:
            _retire(report)


def _retire(report: pytest.TestReport) -> None:
    """Let a process that has become large end soon; there is none but this one where tests run without xdist."""
    node = getattr(report, "node", None)
    scheduler = scheduler_of(node) if node is not None else None
    if scheduler is not None:
        scheduler.retire(node)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: WorkerController, error: object | None) -> None:
    """Replace a process that has ended because it was large; xdist itself replaces one that died."""
    scheduler = scheduler_of(node)
    if scheduler is not None and error is None:
        scheduler.replace(node)


def pytest_internalerror(excrepr: object) -> None:
    """Keep what ended a process of the run: it is printed when it happens, thousands of tests before the last line."""
    account.error = account.error or str(excrepr)


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Turn a good run into a bad one where something was left out, and say what a broken run has not run, and why."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if reporter is not None and account.error:
        for line in account.lines():
            reporter.write_line(line)
    if os.environ.get("CI") != "true" or reporter is None:
        return
    left_out = [report for kind in ("skipped", "xfailed") for report in reporter.stats.get(kind, [])]
    for report in left_out:
        reporter.write_line(f"not run, and nothing may be left out in CI: {report.nodeid} {report.longrepr}")
    if left_out and session.exitstatus == pytest.ExitCode.OK:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, exitstatus: int) -> None:
    """Print what the tests measured; none of them passes or fails by it. With --write-faults, write the page."""
    option = terminalreporter.config.getoption
    passed = [(report.nodeid, report.user_properties) for report in terminalreporter.stats.get("passed", [])]
    for name, text in (each for _, properties in passed for each in properties):
        if name not in ("case", "fault"):
            terminalreporter.write_line(f"measured: {name}: {text}")
    found = figures.seen(properties for _, properties in passed)
    for line in figures.lines(found, option("verbose") > 0):
        terminalreporter.write_line(line)
    if peaks:
        terminalreporter.write_line(peaks[-1].line())
    terminalreporter.write_line(f"seed {option('--seed')}")
    if option("--write-long-run"):
        long_run.write(_checks(terminalreporter), option("--seed"), datetime.datetime.now(datetime.UTC).date())
    if option("--write-faults"):
        if exitstatus != pytest.ExitCode.OK:
            terminalreporter.write_line("docs/faults.md is left as it was: not all tests passed")
            return
        figures.write(found, whole=not option("--long"))


def _checks(reporter: pytest.TerminalReporter) -> list[long_run.Check]:
    """Return the checks of a run; one that could not be set up has failed."""
    found = []
    for outcome in ("passed", "failed", "error"):
        for report in reporter.stats.get(outcome, []):
            told = [long_run.figure(name, value) for name, value in report.user_properties]
            figures = [text for text in told if text is not None]
            found.append(long_run.Check(report.nodeid, figures, report.duration, outcome == "passed"))
    return found
