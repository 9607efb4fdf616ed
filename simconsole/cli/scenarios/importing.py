"""`simconsole scenario import`: an OpenSCENARIO file as a scenario."""

from argparse import Namespace
from pathlib import Path

from simconsole.cli.outcome import Outcome
from simconsole.profiles.files.loader import MAX_DATA_BYTES, read_bytes
from simconsole.profiles.strict_yaml import to_yaml
from simconsole.values.errors import ProfileError

_HEAD = "# Made by `simconsole scenario import` from {source}; `simconsole check {name} --update-golden` accepts it.\n"


def scenario(options: Namespace) -> Outcome:
    """Import a file, and tell what of it was left out.

    Raises:
        ProfileError: it cannot be read, or has elements that are not understood and change the drive.
    """
    from simconsole.evaluation.openscenario.importing import imported

    path = Path(options.name)
    if path.suffix != ".xosc":
        raise ProfileError(f"command line: FILE: value {options.name}: an OpenSCENARIO file, .xosc")
    out = Path(options.out or f"{path.stem}.yaml")
    if out.exists():
        raise ProfileError(f"{out}: is there already")
    found = imported(
        read_bytes(path, MAX_DATA_BYTES),
        str(path),
        ego=options.ego,
        vehicle=options.vehicle,
        lane_m=options.lane_width,
        partly=options.partly,
        parameters=_given(options.parameter),
    )
    lost = [str(one) for one in found.left if one.changes]
    noted = [str(one) for one in found.left if not one.changes]
    text = _HEAD.format(source=path.name, name=out.name)
    text += "".join(f"# Left out: {line}\n" for line in lost) + "".join(f"# Note: {line}\n" for line in noted)
    try:
        out.write_text(text + to_yaml(found.plain), "utf-8")
    except OSError as error:
        raise ProfileError(f"{out}: cannot be written: {error.strerror}") from None
    results = {"file": str(out), "left_out": lost, "notes": noted, "actors": len(found.profile.actors)}
    lines = [str(out), *(f"left out: {line}" for line in lost), *(f"note: {line}" for line in noted)]
    return Outcome(0, results, "\n".join(lines))


def _given(words: list[str]) -> dict[str, str]:
    """Return the values of NAME=VALUE.

    Raises:
        ProfileError: one is none.
    """
    for word in words:
        if not word.partition("=")[0] or "=" not in word:
            raise ProfileError(f"command line: --parameter: value {word}: NAME=VALUE")
    return {name: value for name, _, value in (word.partition("=") for word in words)}
