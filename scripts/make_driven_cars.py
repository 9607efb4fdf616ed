"""Write docs/driven_cars.md, every figure driven anew: `python scripts/make_driven_cars.py [docs/driven_cars.md]`.

Some minutes. With --json the figures are also printed as one JSON object.
"""

import argparse
import json
from pathlib import Path

from validation.driven import CARS, FIGURES, NOT_MODELLED, SOURCES, Figure, inside, measured

PAGE = Path(__file__).resolve().parents[1] / "docs" / "driven_cars.md"

INTRODUCTION = """# The driven cars

Written by `scripts/make_driven_cars.py`, which drives every manoeuvre anew through the whole console; nobody types a
figure. Beside each stands a range of the class, and where it was read (numbers: below the table); where nothing was
found, that is said, and the range is an estimate. "Computed" is by `scripts/validation/single_track.py`, from what was
measured of real cars. A figure out of range is marked 🔴. Hatchback and light van are nobody's cars; the BMW 320i is
the car of CommonRoad's models, with their gaps: neutral steer, no anti-dive, no driver aids, nothing at the rim (n/a),
no losses (so it does not roll down to the speed at which braking begins: none), and the hatchback's engine and brakes.
Its red figures are theirs.

| Figure | Hatchback | Light van | BMW 320i | cars | vans | source of the range |
| --- | --- | --- | --- | --- | --- | --- |
"""

NAMES = dict(zip(CARS, ("hatchback", "light van", "BMW 320i"), strict=True))

Found = dict[str, dict[str, dict[str, float]]]


def value_of(found: Found, car: str, figure: Figure) -> float | None:
    """Return a figure; None: the car could not be driven to it."""
    value = found[car][figure.manoeuvre].get(figure.value)
    return None if value is None else value * figure.factor


def cell(found: Found, car: str, figure: Figure) -> str:
    """Return one figure as the page shows it."""
    if (car, figure.value) in NOT_MODELLED:
        return "n/a"
    value = value_of(found, car, figure)
    shown = "none" if value is None else f"{value:.3g} {figure.unit}".strip()
    return shown if inside(figure, car, value) else f"🔴 {shown}"


def page(found: Found) -> str:
    """Return the page."""
    rows = []
    for figure in FIGURES:
        cells = [cell(found, car, figure) for car in CARS]
        ranges = [f"{low:g} to {high:g} {figure.unit}".strip() for low, high in (figure.car, figure.van)]
        rows.append(f"| {' | '.join((figure.label, *cells, *ranges, figure.source))} |")
    sources = [f"{number}. {source}" for number, source in enumerate(SOURCES, 1)]
    return INTRODUCTION + "\n".join((*rows, "", *(_outside(found, car) for car in CARS), "", *sources, ""))


def _outside(found: Found, car: str) -> str:
    """Return the sentence that says what of a car is out of range."""
    cells = {figure.label: cell(found, car, figure) for figure in FIGURES}
    red = [f"{label} {shown.removeprefix('🔴 ')}" for label, shown in cells.items() if shown.startswith("🔴")]
    return f"- Out of range, {NAMES[car]}: {'; '.join(red) or 'nothing'}."


def main() -> None:
    """Drive and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", type=Path, nargs="?", default=PAGE)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    found = {car: measured(car) for car in CARS}
    given.page.write_text(page(found), encoding="utf-8")
    if given.json:
        print(json.dumps(found))


if __name__ == "__main__":
    main()
