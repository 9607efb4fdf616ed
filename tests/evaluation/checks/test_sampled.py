"""What a check makes of a golden: with tolerances, too, one that shows less than the drive is no golden of it."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.checks.golden import head, line
from simconsole.evaluation.checks.sampled import Accepting, Comparing
from simconsole.profiles.scenario import Tolerance
from simconsole.recording.framing import START_OF_CHAIN
from simconsole.values.errors import ProfileError

COLUMNS = ("a", "b")
HZ = 10
ACCEPTED, DRIVEN = START_OF_CHAIN.hex(), "1f" * len(START_OF_CHAIN)
NEAR = (Tolerance(columns="*", absolute=0.5),)


def golden(folder: Path, ticks: range, tick_hz: int = HZ) -> Path:
    path = folder / "s.csv"
    path.write_text(head(ACCEPTED, tick_hz, COLUMNS) + "".join(line(tick, row(tick)) for tick in ticks))
    return path


def row(tick: int, more: float = 0.0) -> np.ndarray:
    return np.array([tick + more, 0.0])


def judged(path: Path, ticks: range, more: float = 0.1, tolerances: tuple[Tolerance, ...] = NEAR) -> list[str]:
    with Comparing(path, HZ, COLUMNS, tolerances) as comparing:
        for tick in ticks:
            comparing.see(tick, row(tick, more))
        return comparing.end(DRIVEN)


@pytest.mark.parametrize(
    ("accepted", "driven", "told"),
    [
        (range(1, 7), range(1, 7), None),
        (range(1, 7), range(1, 5), "tick 5: tick: driven 4.0, accepted 5.0"),
        (range(1, 5), range(1, 7), "tick 5: driven, and no sample of it was accepted"),
        (range(2, 7, 2), range(1, 7), "tick 1: driven, and no sample of it was accepted"),
        (range(0), range(1, 7), "tick 1: driven, and no sample of it was accepted"),
        (range(0), range(0), f"hash {DRIVEN}, accepted {ACCEPTED}; no sample to hold the tolerances against"),
    ],
    ids=["as long", "shorter", "longer", "finer", "nothing accepted", "nothing at all"],
)
def test_within_tolerances_only_what_was_accepted_passes(
    accepted: range, driven: range, told: str | None, tmp_path: Path
) -> None:
    path = golden(tmp_path, accepted)
    assert judged(path, driven) == ([] if told is None else [f"{path}: {told}"])


def test_a_golden_of_another_tick_is_no_golden(tmp_path: Path) -> None:
    path = golden(tmp_path, range(1, 7), tick_hz=20)
    assert judged(path, range(1, 7), 0.0) == [f"{path}: tick_hz 10, accepted 20"]


def test_both_ways_to_accept_are_named(tmp_path: Path) -> None:
    (told,) = judged(tmp_path / "none.csv", range(1, 3))
    assert told.endswith("no golden; accept one with --update-golden (of pytest: --simconsole-update-golden)")


def test_what_is_accepted_passes_without_tolerances(tmp_path: Path) -> None:
    path = tmp_path / "golden" / "s.csv"
    with Accepting(path, HZ, COLUMNS) as accepting:
        for tick in range(1, 7):
            accepting.see(tick, row(tick))
        assert accepting.end(DRIVEN) == []
    assert judged(path, range(1, 7), 0.0, ()) == []


def test_a_golden_that_cannot_be_read_is_closed(tmp_path: Path) -> None:
    path = tmp_path / "s.csv"
    path.write_text("tick,a\n")
    with pytest.raises(ProfileError, match=r"s\.csv: line 1: not a golden"), Comparing(path, HZ, COLUMNS):
        pass
