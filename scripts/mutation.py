"""Mutation score of simconsole/control: is there a test that fails for every small change of the code?

mutmut makes the mutants. They are run here, not by `mutmut run`: pytest collects once, then every mutant gets a forked
process in which the tests that reach its function run, fastest first, until one fails. That is some hundred times
faster than a pytest per mutant. The copy in out/mutation is plain Python: kernels are not compiled.

Usage: `make mutation`, or `python scripts/mutation.py [MODULE...] [--survivors] [--jobs N]`. Exits with 1 if the score
is below the bar or a survivor is not explained in docs/mutation.md. A run of all mutants writes that page anew and
keeps its reasons; a run of some of them only prints what it found.
"""

import argparse
import contextlib
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
HOUSE = ROOT / "out" / "mutation"
ROOM = Path("simconsole/control")
RESULTS = HOUSE / "results.json"
PAGE = ROOT / "docs" / "mutation.md"
BAR_PERCENT = 95.0
BUDGET_CALLS = 1_000_000
GENERATED_IMPORT = "from mutmut.mutation.trampoline import wrap_in_trampoline as _mutmut_mutated, MutantDict"
OWN_IMPORT = "from mutation_runner import switch as _mutmut_mutated; MutantDict = dict"
UNEXPLAINED = "not explained yet"  # the run counts it as not good
HEAD = """# Mutation score of the arbitration

Written by one run of `make mutation`: [mutmut](https://github.com/boxed/mutmut) changes `simconsole/control` in one
small place at a time, and a test of `tests/control` must fail. A mutant runs against the tests that reach its function,
its module's own first, until they have called {budget_calls} functions; tests that drive for seconds (every pair of
mode and event, reaction times, the million random steps) are left out: so the score is a lower bound. The bar is 95 %;
every survivor is named below, with the reason why no test tells it. Edit the reasons here: the next run keeps them.
"""
SETTINGS = """[tool.mutmut]
source_paths = ["simconsole"]
[tool.pytest.ini_options]
addopts = "--import-mode=importlib"
"""


def build() -> dict[str, dict[str, str]]:
    """Fill out/mutation with a copy whose control/ holds every mutant, and return {mutant: {function, before, after}}.

    A mutant's name is `module.x_function__mutmut_N`.
    """
    from mutmut.mutation.file_mutation import mutate_file_contents

    shutil.rmtree(HOUSE / "simconsole", ignore_errors=True)
    shutil.rmtree(HOUSE / "tests", ignore_errors=True)
    skip = shutil.ignore_patterns("__pycache__", "messages")
    shutil.copytree(ROOT / "simconsole", HOUSE / "simconsole", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(ROOT / "tests" / "control", HOUSE / "tests" / "control", ignore=skip)
    for name in ("paths.py", "samples.py"):
        shutil.copy(ROOT / "tests" / name, HOUSE / "tests")
    shutil.copytree(ROOT / "docs", HOUSE / "docs", dirs_exist_ok=True)
    shutil.copy(ROOT / "scripts" / "mutation_runner.py", HOUSE)
    (HOUSE / "pyproject.toml").write_text(SETTINGS)
    mutants: dict[str, dict[str, str]] = {}
    for path in sorted((ROOT / ROOM).rglob("*.py")):
        place = path.relative_to(ROOT)
        source = path.read_text().replace("@kernel\n", "")
        with contextlib.chdir(HOUSE):  # mutmut reads its settings there
            mutated = mutate_file_contents(str(place), source)
        (HOUSE / place).write_text(mutated.code.replace(GENERATED_IMPORT, OWN_IMPORT))
        lines = mutated.code.splitlines()
        bodies = {
            name: [line.replace(f"x_{name.partition('x_')[2]}(", "(") for line in lines[span.start - 1 : span.end]]
            for name, span in mutated.line_span_by_function_name.items()
        }
        for name in mutated.mutant_names:
            function = name.partition("__mutmut_")[0]
            before, after = difference(bodies[f"{function}__mutmut_orig"], bodies[name])
            mutants[f"{path.stem}.{name}"] = {
                "function": f"{path.stem}.{function.removeprefix('x_')}",
                "before": before,
                "after": after,
                "of": hashlib.sha256("\n".join(bodies[f"{function}__mutmut_orig"]).encode()).hexdigest()[:12],
            }
    return mutants


def difference(before: list[str], after: list[str]) -> tuple[str, str]:
    """Return the part that differs of two versions of a function, each on one line."""
    first = next(n for n in range(len(before)) if n >= len(after) or before[n] != after[n])
    last = next(n for n in range(1, len(before) + 1) if n > len(after) or before[-n] != after[-n])
    return tuple(  # type: ignore[return-value]
        " ".join(" ".join(version[first : len(version) - last + 1]).split()) for version in (before, after)
    )


def reasons() -> dict[tuple[str, str, str], str]:
    """Return why each survivor that docs/mutation.md names may survive, by (function, before, after)."""
    if not PAGE.exists():
        return {}
    rows = re.findall(r"^\| `([^`]+)` \| `([^`]+)` \| `([^`]+)` \| ([^|]+) \|$", PAGE.read_text(), re.MULTILINE)
    return {tuple(cell.replace(r"\|", "|") for cell in row[:3]): row[3] for row in rows}


def page(
    mutants: dict[str, dict[str, str]], results: dict[str, dict[str, Any]], tests: int, budget_calls: int
) -> tuple[str, bool]:
    """Return docs/mutation.md for these results, and whether the bar is met and every survivor explained."""
    table: dict[str, list[int]] = {}
    survivors = []
    for name in filter(results.__contains__, mutants):
        row = table.setdefault(name.partition(".")[0], [0, 0])
        row[0] += 1
        row[1] += results[name]["killed"]
        if not results[name]["killed"]:
            mutant = mutants[name]
            survivors.append((mutant["function"], mutant["before"], mutant["after"]))
    count, killed = (sum(row[at] for row in table.values()) for at in (0, 1))
    known = reasons()
    lines = [HEAD.format(budget_calls=budget_calls)]
    lines += [f"{count} mutants run against {tests} tests, {killed} killed: {100.0 * killed / count:.2f} %.", ""]
    lines += ["| module | mutants | killed | score |", "|---|---|---|---|"]
    lines += [f"| {name} | {made} | {dead} | {100.0 * dead / made:.1f} % |" for name, (made, dead) in table.items()]
    lines += ["", "## Survivors", "", "| function | as it is | as it may be | why no test can or need tell |"]
    lines += ["|---|---|---|---|"]
    for survivor in sorted(set(survivors)):
        cells = " | ".join(f"`{cell}`" for cell in (text.replace("|", r"\|") for text in survivor))
        lines.append(f"| {cells} | {known.get(survivor, UNEXPLAINED)} |")
    explained = all(known.get(survivor, UNEXPLAINED) != UNEXPLAINED for survivor in survivors)
    return "\n".join((*lines, "")), 100.0 * killed / count >= BAR_PERCENT and explained


def main() -> int:
    """Run the mutants that are asked for and tell the score."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("modules", nargs="*", metavar="MODULE", help="only these modules of control/")
    parser.add_argument("--survivors", action="store_true", help="only those that survived the last time")
    parser.add_argument("--budget-calls", type=int, default=BUDGET_CALLS, help="of functions under test per mutant")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    arguments = parser.parse_args()
    HOUSE.mkdir(parents=True, exist_ok=True)
    mutants = build()
    known: dict[str, dict[str, Any]] = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    known = {name: result for name, result in known.items() if result["mutant"] == mutants.get(name)}
    wanted = [name for name in mutants if not arguments.modules or name.partition(".")[0] in arguments.modules]
    if arguments.survivors:
        wanted = [name for name in wanted if not known.get(name, {"killed": False})["killed"]]
    job = HOUSE / "job.json"
    job.write_text(json.dumps({"wanted": wanted, "jobs": arguments.jobs, "budget_calls": arguments.budget_calls}))
    command = [sys.executable, "-m", "pytest", "-q", "-p", "mutation_runner", "-p", "no:timeout", "tests/control"]
    command += ["--assert=plain", "--tb=no"]  # it is enough that a test fails: words would cost most of the time
    subprocess.run(command, cwd=HOUSE, env={**os.environ, "PYTHONPATH": str(HOUSE)}, check=True)
    done: dict[str, Any] = json.loads((HOUSE / "done.json").read_text())
    results = {name: {**result, "mutant": mutants[name]} for name, result in done["results"].items()}
    RESULTS.write_text(json.dumps(known | results, indent=1))
    text, good = page(mutants, results, done["tests"], arguments.budget_calls)
    if len(results) == len(mutants):
        PAGE.write_text(text)
    print(text)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
