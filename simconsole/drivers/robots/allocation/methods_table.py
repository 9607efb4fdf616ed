"""Methods side by side: best allocation cost, average computing time, and deviation from the optimum.

The columns are those of the paper's Table I. The paper gives no positions, so its figures stand beside ours as its own.
"""

from collections.abc import Sequence
from typing import Final, NamedTuple

PAPER: Final = "the paper's own scene: 12.76 m, 1.04 s, deviation 3 %; its positions are not published"


class MethodRow(NamedTuple):
    """What one method did with one problem, or with many."""

    method: str
    best_m: float
    optimum_m: float
    costs_m: tuple[float, ...]  # of each run
    times_s: tuple[float, ...]  # of each run

    @property
    def mean_time_s(self) -> float:
        """The average computing time."""
        return sum(self.times_s) / len(self.times_s)

    @property
    def deviation(self) -> float:
        """By which share the runs' mean cost is above the optimum, which none is below but by rounding."""
        mean_m = sum(self.costs_m) / len(self.costs_m)
        return max(0.0, mean_m / self.optimum_m - 1.0) if self.optimum_m else 0.0


def methods_table(title: str, rows: Sequence[MethodRow]) -> str:
    """Return the table as text."""
    lines = [title, f"{'method':<22}{'best cost':>12}{'computing time':>18}{'deviation':>12}"]
    for row in rows:
        time_ms = f"{1000.0 * row.mean_time_s:.3f} ms"
        lines.append(f"{row.method:<22}{row.best_m:>10.2f} m{time_ms:>18}{100.0 * row.deviation:>10.2f} %")
    return "\n".join((*lines, f"({PAPER})"))
