"""What the tests of the fault catalogue saw, from the reports of a run to docs/faults.md and the terminal."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Final, NamedTuple

from tests.faults.catalogue import CATALOGUE, tested
from tests.paths import ROOT

PAGE: Final = ROOT / "docs" / "faults.md"
HEAD: Final = "| id | fault | promised | tested in | measured |\n|---|---|---|---|---|\n"
BREAK: Final = "<br>"
AT_LENGTH: Final = 12
"""So many cases with figures are listed in the terminal; of more, only how many they are."""


class Seen(NamedTuple):
    """Of one case: tests that passed, and figures by what was measured."""

    tests: int
    figures: Mapping[str, str]

    @property
    def cell(self) -> str:
        """As it stands in the table."""
        return BREAK.join((f"{self.tests} tests passed", *(f"{what}: {seen}" for what, seen in self.figures.items())))


def seen(properties: Iterable[Sequence[tuple[str, object]]]) -> dict[str, Seen]:
    """Return what the tests saw, by case, of the user properties of each test that passed."""
    tests: dict[str, int] = {}
    figures: dict[str, dict[str, str]] = {}
    for each in properties:
        for name, value in each:
            if name == "case":
                tests[str(value)] = tests.get(str(value), 0) + 1
            elif name == "fault":
                case, what, figure, bar = (part.strip() for part in str(value).replace("\n", " ").split(" | "))
                figures.setdefault(case, {})[what] = f"{figure} ({bar})" if bar else figure
    return {case: Seen(tests.get(case, 0), figures.get(case, {})) for case in sorted(tests | figures)}


def table(cells: Mapping[str, str]) -> str:
    """Return the table of all cases, `cells` in its last column."""
    files = tested()
    lines = (
        f"| {case.number} | {case.fault} | {case.promised} | {', '.join(files.get(case.number, ()))} "
        f"| {cells.get(case.number, '-')} |\n"
        for case in CATALOGUE
    )
    return HEAD + "".join(lines)


def cells(page: str) -> dict[str, str]:
    """Return the last column of the table in a page, by case."""
    _, _, body = page.partition(HEAD)
    rows = (line.strip("| ").split(" | ") for line in body.splitlines() if line.startswith("| "))
    return {row[0]: row[-1] for row in rows}


def updated(before: Mapping[str, str], found: Mapping[str, Seen], whole: bool) -> dict[str, str]:
    """Return the last column after a run; without `whole`, figures of tests that it left out stay."""
    after = dict(before)
    for case, entry in found.items():
        if not whole and case in before:
            tests, *lines = before[case].split(BREAK)
            kept = dict(line.split(": ", 1) for line in lines) | dict(entry.figures)
            after[case] = BREAK.join((tests, *(f"{what}: {figure}" for what, figure in kept.items())))
        else:
            after[case] = entry.cell
    return after


def write(found: Mapping[str, Seen], whole: bool) -> None:
    """Write docs/faults.md anew: the drives are driven again, the figures are those of this run."""
    from tests.faults.cases import page

    before = cells(PAGE.read_text("utf-8")) if PAGE.exists() else {}
    PAGE.write_text(page() + table(updated(before, found, whole)), "utf-8")


def lines(found: Mapping[str, Seen], whole: bool) -> Iterator[str]:
    """Yield what the terminal shows of it: one line, and one for each case with figures if these are few or `whole`."""
    if not found:
        return
    tests, figures = sum(entry.tests for entry in found.values()), sum(len(entry.figures) for entry in found.values())
    with_figures = {case: entry.figures for case, entry in found.items() if entry.figures}
    at_length = whole or len(with_figures) <= AT_LENGTH
    told = "" if at_length else "; -v or --write-faults tells them"
    yield f"faults: {len(found)} of {len(CATALOGUE)} cases, {tests} tests passed, {figures} figures{told}"
    if at_length:
        for case, by_what in with_figures.items():
            yield f"  {case} " + "; ".join(f"{what}: {figure}" for what, figure in by_what.items())


if __name__ == "__main__":  # the drives and the marks anew, the figures as they are
    write({}, whole=False)
