"""What differs between two drives, as text and as plain values; and the tolerances that a user gives in a file."""

import math
from collections.abc import Sequence
from typing import Annotated, Any, Final, Literal

import msgspec

from simconsole.profiles.files.loader import load
from simconsole.recording.differences import FieldDifference

SHOWN_FIELDS: Final = 12
"""Fields whose ticks around the first difference are printed; the table names all, `--json` has the ticks of all."""

Tolerance = Annotated[float, msgspec.Meta(ge=0.0)] | Literal["ignore"]


def read_tolerances(path: str | None) -> dict[str, float]:
    """Return the tolerances in a file that maps fields or patterns to absolute differences, or to `ignore`.

    Raises:
        ProfileError: the file cannot be read, or a value is neither a number of 0 or more nor `ignore`.
    """
    if path is None:
        return {}
    given = load("tolerances", path, dict[str, Tolerance])
    return {pattern: math.inf if value == "ignore" else float(value) for pattern, value in given.items()}


def plain_differences(found: Sequence[FieldDifference], names: tuple[str, str]) -> list[dict[str, Any]]:
    """Return differences as JSON values; `names` tells what the two drives are, as `recorded` and `replayed`.

    A value that is no finite number is null.
    """
    plain = []
    for difference in found:
        values = difference._asdict()
        values["around"] = [{"tick": tick, names[0]: one, names[1]: two} for tick, one, two in difference.around]
        plain.append({**values, **dict(zip(names, difference.values, strict=True))})
    return plain


def differences_text(found: Sequence[FieldDifference], names: tuple[str, str]) -> str:
    """Return a table of the fields that differ, and the ticks around the first difference of each."""
    width = max(len(difference.field) for difference in found)
    head = (
        f"{'field':<{width}}  {'unit':<7}  {'first tick':>10}  {'largest difference':>18}  {'at tick':>8}  {'ticks':>8}"
    )
    lines = [head]
    for one in found:
        where = f"{one.first_tick:>10}  {one.largest:>18.6g}  {one.largest_tick:>8}  {one.ticks:>8}"
        lines.append(f"{one.field:<{width}}  {one.unit:<7}  {where}")
    for one in found[:SHOWN_FIELDS]:
        lines += _around(one, names)
    if len(found) > SHOWN_FIELDS:
        lines += ["", f"the ticks around the first difference of {len(found) - SHOWN_FIELDS} more fields: --json"]
    return "\n".join(lines)


def columns_text(columns: Sequence[str], what: str) -> list[str]:
    """Return one line that names `columns`, none without any."""
    return [f"{what}: {', '.join(columns)}"] if columns else []


def _around(one: FieldDifference, names: tuple[str, str]) -> list[str]:
    width = max(len(name) for name in (*names, "change"))
    ticks = (f"{('>' if tick == one.first_tick else '') + str(tick):>14}" for tick, _, _ in one.around)
    lines = ["", one.field, " " * (width + 2) + "".join(ticks)]
    for at, name in enumerate(names):
        lines.append(f"  {name:<{width}}" + "".join(f"{values[1 + at]:>14.6g}" for values in one.around))
    return [*lines, f"  {'change':<{width}}" + "".join(f"{second - first:>14.3g}" for _, first, second in one.around)]
