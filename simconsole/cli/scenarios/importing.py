"""`simconsole scenario import`: an OpenSCENARIO file as a scenario."""

from argparse import Namespace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simconsole.cli.outcome import Outcome
from simconsole.profiles.files.loader import MAX_DATA_BYTES, read_bytes
from simconsole.profiles.strict_yaml import to_yaml
from simconsole.values.errors import ProfileError

if TYPE_CHECKING:
    from simconsole.evaluation.openscenario.importing import Imported

PLAN: Final = "plan.yaml"
_HEAD = "# Made by `simconsole scenario import` from {source}; `simconsole check {name} --update-golden` accepts it.\n"
_PLAN_HEAD = "# Made by `simconsole scenario import` from {source}; `simconsole sweep` drives it.\n"


def scenario(options: Namespace) -> Outcome:
    """Import a file, and tell what of it was left out.

    Raises:
        ProfileError: it cannot be read, or has elements that are not understood and change the drive.
    """
    path = Path(options.name)
    if path.suffix != ".xosc":
        raise ProfileError(f"command line: FILE: value {options.name}: an OpenSCENARIO file, .xosc")
    given = _given(options.parameter)
    if options.values is not None:
        return _with_each(options, path, given)
    out = _new(Path(options.out or f"{path.stem}.yaml"))
    found = _imported(options, path, given)
    _write(out, _text(found, path, out.name))
    lost, noted = _told(found)
    results = {"file": str(out), "left_out": lost, "notes": noted, "actors": len(found.profile.actors)}
    return Outcome(0, results, "\n".join((str(out), *_lines(lost, noted))))


def _with_each(options: Namespace, path: Path, given: dict[str, str]) -> Outcome:
    """Import a file once with each set of values that another one lists, and write the plan that drives all of them."""
    from simconsole.evaluation.openscenario.distributions import value_sets

    values = Path(options.values)
    sets = value_sets(read_bytes(values, MAX_DATA_BYTES), str(values))
    folder = _new(Path(options.out or path.stem))
    found = {f"{path.stem}-{at}.yaml": _imported(options, path, {**given, **one}) for at, one in enumerate(sets)}
    said = {name: ", ".join(map("=".join, one.items())) for name, one in zip(found, sets, strict=True)}
    plan = to_yaml({"schema": 1, "title": path.stem, "scenarios": list(found)})
    for name, one in found.items():
        _write(folder / name, _comment(f"Parameters: {said[name]}") + _text(one, path, name))
    told = "".join(_comment(f"{name}: {values}") for name, values in said.items())
    _write(folder / PLAN, _PLAN_HEAD.format(source=values.name) + told + plan)
    lost, noted = (list(dict.fromkeys(chain(*each))) for each in zip(*map(_told, found.values()), strict=True))
    results = {"plan": str(folder / PLAN), "scenarios": len(found), "left_out": lost, "notes": noted}
    return Outcome(0, results, "\n".join((f"{folder / PLAN}: {len(found)} scenarios", *_lines(lost, noted))))


def _imported(options: Namespace, path: Path, given: dict[str, str]) -> "Imported":
    from simconsole.evaluation.openscenario.importing import imported

    return imported(
        read_bytes(path, MAX_DATA_BYTES),
        str(path),
        ego=options.ego,
        vehicle=options.vehicle,
        lane_m=options.lane_width,
        partly=options.partly,
        parameters=given,
    )


def _told(found: "Imported") -> tuple[list[str], list[str]]:
    """Return what was left out, and what is noted."""
    lost = [str(one) for one in found.left if one.changes]
    return lost, [str(one) for one in found.left if not one.changes]


def _lines(lost: list[str], noted: list[str]) -> list[str]:
    return [*(f"left out: {line}" for line in lost), *(f"note: {line}" for line in noted)]


def _text(found: "Imported", path: Path, name: str) -> str:
    lost, noted = _told(found)
    told = "".join(_comment(f"Left out: {line}") for line in lost) + "".join(
        _comment(f"Note: {line}") for line in noted
    )
    return _HEAD.format(source=path.name, name=name) + told + to_yaml(found.plain)


def _comment(text: str) -> str:
    """Return a line of comment, whatever characters a stranger's values have."""
    return f"# {''.join(letter if letter.isprintable() else '?' for letter in text)}\n"


def _new(out: Path) -> Path:
    if out.exists():
        raise ProfileError(f"{out}: is there already")
    return out


def _write(out: Path, text: str) -> None:
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(text, "utf-8")
    except OSError as error:
        raise ProfileError(f"{out}: cannot be written: {error.strerror}") from None


def _given(words: list[str]) -> dict[str, str]:
    """Return the values of NAME=VALUE.

    Raises:
        ProfileError: one is none.
    """
    for word in words:
        if not word.partition("=")[0] or "=" not in word:
            raise ProfileError(f"command line: --parameter: value {word}: NAME=VALUE")
    return {name: value for name, _, value in (word.partition("=") for word in words)}
