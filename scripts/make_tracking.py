"""Write docs/tracking.md: how trackers hold random courses, every number measured anew.

`python scripts/make_tracking.py [--courses N] [--seed N] [PAGE]`; 4 CPU seconds for each course of each row.
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

ROOT: Final = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tests.drives.random_courses import Tracked, random_course, tracked  # noqa: E402  # after the path

PAGE: Final = ROOT / "docs" / "tracking.md"
NOISE: Final = "position_noise_m: 0.02, yaw_noise_deg: 0.2"
DRIFT: Final = f"{NOISE}, position_drift_m: 0.3, yaw_drift_deg: 0.3"
NAMES: Final = {"preview": "preview", "pure_pursuit": "pure pursuit", "stanley": "Stanley"}

HEAD: Final = """# How the trackers hold a course

Written by `scripts/make_tracking.py --courses {count} --seed {seed}`, which measures every number on this page. What
the numbers must be is asserted by `tests/drives/test_random_courses.py`, with `--long` on 50 fresh courses a row.

Each row is {count} random courses: 500 to 1200 m, bends of 8 to 60 m radius to both sides, curvature ramps of 3 to
15 m, speed limits of 30 to 80 km/h. A simulated person drives off and hands over to `simconsole autopilot`, a program
of its own that is connected by a WebSocket and drives behind the console's gate. Odometry comes at 50 Hz with white
noise of 2 cm and 0.2 degrees; commands act the given time after the state that they answer. With drift, odometry
wanders by 0.3 m and 0.3 degrees (standard deviations) within 20 s, and errors are those against odometry without its
white noise; elsewhere they are the true ones. All rows of one car drive the same courses at the same planned speed. A
stop is a lap that was not driven to its end: by the console's safe stop, or a take-over.

"preview" is the autopilot's own tracker (`drivers/path_tracker`, decision 12), designed with each car's own model.
Pure pursuit (0.6 s, at least 4 m ahead) and Stanley (gain 1.5 /s) are plain: they take odometry as it comes and know
nothing of delay, tyres or gate. A session chooses by `features.tracker`, a program by `simconsole autopilot --tracker`.

"""
COLUMNS: Final = (
    "Tracker",
    "Car",
    "Link",
    "RMS, all",
    "RMS at most",
    "Max",
    "Stops",
    "Within 2.5 m/s2",
    "Within -2.0 to 1.6 m/s2 and 3 m/s3",
    "Angle reached behind the gate",
)


LABELS = {"hatchback": "hatchback", "light_van": "light van", "commonroad_bmw320i": "BMW 320i"}


class Row(NamedTuple):
    """What one row of the table measures."""

    tracker: str
    vehicle: str
    delay_ms: int
    localisation: str = NOISE

    @property
    def link(self) -> str:
        """The link, in words."""
        return f"{self.delay_ms} ms" + (", drift" if self.localisation == DRIFT else "")


ROWS: Final = (
    Row("preview", "hatchback", 40),
    Row("pure_pursuit", "hatchback", 40),
    Row("stanley", "hatchback", 40),
    Row("preview", "hatchback", 100),
    Row("pure_pursuit", "hatchback", 100),
    Row("stanley", "hatchback", 100),
    Row("preview", "hatchback", 40, DRIFT),
    Row("preview", "light_van", 40),
    Row("preview", "commonroad_bmw320i", 40),
)


def measured(row: Row, count: int, seed: int, folder: Path) -> Iterator[Tracked]:
    """Drive the courses of a row."""
    rng = np.random.default_rng(seed)
    for number in range(count):
        course_seed = int(rng.integers(2**53))
        world = random_course(np.random.default_rng(course_seed))
        link = f"{{seed: {course_seed}, delay_ms: {row.delay_ms}, localisation: {{{row.localisation}}}}}"
        yield tracked(world, row.vehicle, link, folder / str(number), row.tracker)


def line(row: Row, done: list[Tracked]) -> str:
    """Return a row of the table."""
    driven_s = sum(one.driven_s for one in done)

    def share(name: str) -> str:
        return f"{sum(getattr(one, name) * one.driven_s for one in done) / driven_s:.2%}".replace("%", " %")

    rms = (sum(one.rms_cm**2 * one.driven_s for one in done) / driven_s) ** 0.5
    cells = (
        NAMES[row.tracker],
        LABELS[row.vehicle],
        row.link,
        f"{rms:.2f} cm",
        f"{max(one.rms_cm for one in done):.2f} cm",
        f"{max(one.max_cm for one in done):.1f} cm",
        str(sum(one.stopped for one in done)),
        share("lateral_kept"),
        share("longitudinal_kept"),
        share("reached"),
    )
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Measure and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", nargs="?", type=Path, default=PAGE)
    parser.add_argument("--courses", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    lines = [f"| {' | '.join(COLUMNS)} |", "|" + " --- |" * len(COLUMNS)]
    for row in ROWS:
        with tempfile.TemporaryDirectory() as folder:
            lines.append(line(row, list(measured(row, options.courses, options.seed, Path(folder)))))
        print(lines[-1], flush=True)
    head = HEAD.format(count=options.courses, seed=options.seed)
    options.page.write_text(head + "\n".join(lines) + "\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
