"""`simconsole check`: scripted drives, headless, against their bounds and goldens."""

from argparse import Namespace
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from simconsole.cli.outcome import Outcome, table
from simconsole.cli.progress import Progress
from simconsole.evaluation.checks.scenario_check import Verdict, check_scenario
from simconsole.evaluation.checks.selection import selected
from simconsole.processes.lifetimes import end_with_parent
from simconsole.values.errors import ProfileError


def check(options: Namespace) -> Outcome:
    """Drive every scenario; code 1 if one breaks a bound or leaves its golden.

    Raises:
        ProfileError: a scenario cannot be read, none is selected, or a golden is to be reviewed and accepted at once.
    """
    if options.review and options.update_golden:
        raise ProfileError("command line: --review: look first, then --update-golden")
    scenarios = selected(options.scenarios, options.select)
    verdicts: list[Verdict] = []
    with Progress(f"{len(scenarios)} scenarios") as progress:
        for verdict in _driven(scenarios, options):
            verdicts.append(verdict)
            progress.done("driven", len(verdicts) / len(scenarios))
    if options.junit:
        _write_junit(Path(options.junit), verdicts)
    if options.report:
        _write_report(Path(options.report), verdicts)
    if options.review:
        _write_review(Path(options.review), scenarios, verdicts)
    passed = all(verdict.passed for verdict in verdicts)
    results: dict[str, Any] = {"passed": passed, "scenarios": [_results(verdict) for verdict in verdicts]}
    return Outcome(0 if passed else 1, results, "\n".join(_line(verdict) for verdict in verdicts))


def _driven(scenarios: Sequence[str], options: Namespace) -> Iterator[Verdict]:
    """Drive the scenarios, as many at a time as the command line says; yield what came of each, in their order."""
    accepts = [options.update_golden] * len(scenarios)
    if options.jobs > 1:
        with ProcessPoolExecutor(options.jobs, get_context("spawn"), end_with_parent) as pool:
            yield from pool.map(check_scenario, scenarios, accepts)
    else:
        yield from map(check_scenario, scenarios, accepts)


def _results(verdict: Verdict) -> dict[str, Any]:
    kept = {name: getattr(verdict, name) for name in ("scenario", "passed", "ticks", "digest", "problems")}
    return kept if verdict.result is None else {**kept, "values": verdict.result.values}


def _line(verdict: Verdict) -> str:
    head = f"{'pass' if verdict.passed else 'FAIL'}  {verdict.scenario}  {verdict.ticks} ticks  {verdict.digest}"
    values = {} if verdict.result is None else verdict.result.values
    rows = table([(name, f"{value:.4g}") for name, value in values.items()])
    return "\n".join((head, *(f"      {problem}" for problem in verdict.problems), *([rows] if rows else [])))


def _write_report(path: Path, verdicts: list[Verdict]) -> None:
    from simconsole.evaluation.report.manoeuvre_page import Chapter, write_handling_report

    chapters = [
        Chapter(verdict.scenario, verdict.title, verdict.result, verdict.limits, tuple(verdict.problems))
        for verdict in verdicts
        if verdict.result is not None
    ]
    write_handling_report(path, chapters)


def _write_review(path: Path, scenarios: list[str], verdicts: list[Verdict]) -> None:
    """Write the page of what differs; a scenario that left its golden is driven once more for it."""
    from simconsole.evaluation.checks.review import review_scenario
    from simconsole.evaluation.report.review_page import write_review

    with_golden = [(name, verdict) for name, verdict in zip(scenarios, verdicts, strict=True) if verdict.result is None]
    reviews = [review_scenario(name) for name, verdict in with_golden if not verdict.passed]
    passed = [verdict for _, verdict in with_golden if verdict.passed]
    equal = [verdict.scenario for verdict in passed if verdict.exact]
    write_review(path, reviews, equal, [verdict.scenario for verdict in passed if not verdict.exact])


def _write_junit(path: Path, verdicts: list[Verdict]) -> None:
    failures = sum(not verdict.passed for verdict in verdicts)
    suite = ElementTree.Element("testsuite", name="simconsole", tests=str(len(verdicts)), failures=str(failures))
    for verdict in verdicts:
        case = ElementTree.SubElement(suite, "testcase", name=verdict.scenario)
        if not verdict.passed:
            ElementTree.SubElement(case, "failure", message=verdict.problems[0]).text = "\n".join(verdict.problems)
    ElementTree.ElementTree(suite).write(path, encoding="utf-8", xml_declaration=True)
