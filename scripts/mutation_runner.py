"""Runs mutants inside one pytest session: a plugin for scripts/mutation.py, used nowhere else.

Every mutated function goes through a switch that calls the original, or in a forked process one of its mutants.
"""

import gc
import itertools
import json
import os
import signal
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import pytest
from _pytest.runner import runtestprotocol

DRIVES: Final = (
    "arbitration",
    "commander",
    "implausible",
    "pairs",
    "random",
    "reactions",
    "shared_drives",
    "short_drives",
    "speed_loop",
    "stops",
    "walk",
)
LEFT_OUT: Final = tuple(f"test_{name}.py" for name in (*DRIVES, "coverage", "mutation_page"))
"""Tests that drive for seconds cost more than all others and kill one mutant in two hundred; the last two are no tests
of what `control/` does."""
QUICK: Final = 5000
"""Calls of a quick test: the best part of all tests."""
LEAST_CPU_S: Final = 10.0
TIMES_SLOWER: Final = 10.0

Function = Callable[..., Any]
switches: dict[str, tuple[list[Function], dict[str, Function]]] = {}
"""By `module.x_function`: the version in force, and all mutants."""


def switch(mutants: dict[str, Function]) -> Callable[[Function], Function]:
    """Decorate a function of a generated file so that one of its `mutants` can stand in for it."""

    def decorate(function: Function) -> Function:
        chosen = [function]
        switches[f"{function.__module__.rpartition('.')[2]}.x_{function.__name__}"] = (chosen, mutants)

        def call(*arguments: Any, **named: Any) -> Any:
            return chosen[0](*arguments, **named)

        return call

    return decorate


@dataclass(frozen=True, order=True)
class Reach:
    """A test that reaches a function; they sort by what will most likely and soonest kill a mutant.

    What a test costs is counted in calls of the functions under test, and so the same on any machine under any load.
    """

    slow: bool
    stranger: bool  # not of the module's own tests
    calls: int
    index: int
    cpu_s: float


class Runner:
    """One session: which test reaches which function, then the mutants."""

    def __init__(self, items: list[pytest.Item], jobs: int, budget_calls: int) -> None:
        self.items = items
        self.jobs = jobs
        self.budget_calls = budget_calls
        self.reached: dict[str, list[Reach]] = {name: [] for name in switches}
        self.done: dict[str, dict[str, Any]] = {}
        self.kills: dict[str, Counter[int]] = {}
        self.running: dict[int, tuple[str, int]] = {}

    def learn(self) -> None:
        """Run every test once on the originals and note the functions it reaches, and what it costs.

        Raises:
            SystemExit: a test fails without any mutant.
        """
        seen: Counter[str] = Counter()
        originals = {name: chosen[0] for name, (chosen, _) in switches.items()}
        for name, original in originals.items():

            def note(*arguments: Any, name: str = name, original: Function = original, **named: Any) -> Any:
                seen[name] += 1
                return original(*arguments, **named)

            switches[name][0][0] = note
        for index, item in enumerate(self.items):
            seen.clear()
            began_s = time.process_time()
            if fails(item):
                sys.exit(f"{item.nodeid} fails without any mutant")
            cpu_s = time.process_time() - began_s
            calls = seen.total()
            for name in seen:
                own = item.path.stem == f"test_{name.partition('.')[0]}"
                self.reached[name].append(Reach(calls > QUICK, not own, calls, index, cpu_s))
        for name, original in originals.items():
            switches[name][0][0] = original
            self.reached[name] = self.affordable(sorted(self.reached[name]))

    def run(self, mutants: list[str]) -> None:
        """Run every mutant in a process of its own."""
        for count, name in enumerate(mutants):
            tests = self.ordered(name.partition("__mutmut_")[0])
            if not tests:
                self.done[name] = {"killed": False, "by": "no test reaches it"}
                continue
            while len(self.running) >= self.jobs:
                self.reap()
            reading, writing = os.pipe()
            pid = os.fork()
            if pid == 0:
                self.child(name, tests, writing)
            os.close(writing)
            self.running[pid] = (name, reading)
            if count % 50 == 0:
                print(f"{count} of {len(mutants)} mutants", flush=True)
                self.save()
        while self.running:
            self.reap()
        self.save()

    def save(self) -> None:
        """Write what is known by now."""
        Path("done.json").write_text(json.dumps({"tests": len(self.items), "results": self.done}))

    def affordable(self, tests: list[Reach]) -> list[Reach]:
        """Return the first of `tests` that together cost no more than the budget, and at least one of them."""
        totals = itertools.accumulate(test.calls for test in tests)
        return [test for test, total in zip(tests, totals, strict=True) if total <= self.budget_calls] or tests[:1]

    def ordered(self, function: str) -> list[Reach]:
        """Return the tests that reach a function: those first that have killed most of its mutants so far."""
        kills = self.kills.setdefault(function, Counter())
        return sorted(self.reached[function], key=lambda test: (-kills[test.index], test))

    def child(self, name: str, tests: list[Reach], writing: int) -> None:
        """Run the tests of one mutant until one fails, and write its number; never returns. Exit code 0: all passed."""
        quiet = os.open(os.devnull, os.O_WRONLY)
        os.dup2(quiet, 1)
        os.dup2(quiet, 2)
        # In CPU time: an endless loop ends whatever else the machine does, and a loaded machine kills no mutant.
        signal.signal(signal.SIGPROF, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_PROF, LEAST_CPU_S + TIMES_SLOWER * sum(test.cpu_s for test in tests))
        function, _, mutant = name.partition("__mutmut_")
        chosen, mutants = switches[function]
        chosen[0] = mutants[f"{function.partition('.')[2]}__mutmut_{mutant}"]
        code = 1
        try:
            killer = next((test.index for test in tests if fails(self.items[test.index])), None)
            code = 0 if killer is None else 1
            os.write(writing, b"" if killer is None else str(killer).encode())
        finally:
            os._exit(code)

    def reap(self) -> None:
        """Wait for one mutant. One that a signal ended ran into an endless loop, or crashed: killed."""
        pid, status = os.wait()
        name, reading = self.running.pop(pid)
        with os.fdopen(reading) as pipe:
            killer = pipe.read()
        by = self.items[int(killer)].nodeid if killer else "signal" if os.WIFSIGNALED(status) else ""
        if killer:
            self.kills[name.partition("__mutmut_")[0]][int(killer)] += 1
        self.done[name] = {"killed": status != 0, "by": by}


def fails(item: pytest.Item) -> bool:
    """Run one test with its fixtures and return whether it failed."""
    reports = runtestprotocol(item, log=False, nextitem=None)
    return any(report.failed for report in reports)


@pytest.hookimpl(tryfirst=True)
def pytest_ignore_collect(collection_path: Path) -> bool | None:
    """Leave out what cannot run on mutants."""
    return True if collection_path.name in LEFT_OUT else None


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session: pytest.Session) -> bool:
    """Run mutants instead of tests."""
    if session.testsfailed:
        return False
    job = json.loads(Path("job.json").read_text())
    runner = Runner(session.items, job["jobs"], job["budget_calls"])
    runner.learn()
    gc.freeze()
    runner.run(job["wanted"])
    return True
