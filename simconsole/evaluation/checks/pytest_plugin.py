"""Scenario files as tests of a lab's own pytest: each is driven against its bounds, its golden or its limits.

A lab names it in its conftest.py: `pytest_plugins = ["simconsole.evaluation.checks.pytest_plugin"]`. An entry point
would make pytest compile every module of the package anew, to rewrite its assertions. Files that the option
`simconsole_scenarios` names are collected, by default `*.scenario.yaml`; one that is no scenario is an error, not a
file that is left out.
"""

from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from simconsole.evaluation.checks.scenario_check import Verdict

PATTERNS = "simconsole_scenarios"
UPDATE = "--simconsole-update-golden"


class ScenarioFailed(Exception):
    """A scenario does not pass.

    Attributes:
        verdict: what was driven.
    """

    def __init__(self, verdict: "Verdict") -> None:
        super().__init__(verdict.scenario)
        self.verdict = verdict


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add which files are scenarios, and whether what is driven is accepted."""
    parser.addini(PATTERNS, "patterns of scenario files, below the root folder", "args", ["*.scenario.yaml"])
    parser.getgroup("simconsole").addoption(
        UPDATE, action="store_true", help="accept what scenarios drive as their new goldens"
    )


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Take a file whose name or place is that of a scenario."""
    if file_path.suffix not in (".yaml", ".yml"):
        return None
    patterns = parent.config.getini(PATTERNS)
    below = file_path.relative_to(parent.config.rootpath) if file_path.is_relative_to(parent.config.rootpath) else None
    names = (file_path.name, *(() if below is None else (below.as_posix(),)))
    if not any(fnmatch(name, pattern) for name in names for pattern in patterns):
        return None
    found: ScenarioFile = ScenarioFile.from_parent(parent, path=file_path)
    return found


class ScenarioFile(pytest.File):
    """A file with one scenario."""

    def collect(self) -> Iterator[pytest.Item]:
        """Yield its one test."""
        yield ScenarioItem.from_parent(self, name="scenario")


class ScenarioItem(pytest.Item):
    """The drive of one scenario."""

    def runtest(self) -> None:
        """Drive it.

        Raises:
            ScenarioFailed: it does not pass.
        """
        from simconsole.evaluation.checks.scenario_check import check_scenario

        verdict = check_scenario(str(self.path), update_golden=bool(self.config.getoption(UPDATE)))
        if not verdict.passed:
            raise ScenarioFailed(verdict)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return what is wrong, for people: no trace of ours where the scenario or its drive is at fault."""
        from simconsole.values.errors import SimConsoleError

        if isinstance(excinfo.value, ScenarioFailed):
            return "\n".join(excinfo.value.verdict.problems)
        if isinstance(excinfo.value, SimConsoleError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Return where it is, and what it is called in a report."""
        return self.path, None, f"scenario {self.path.name}"
