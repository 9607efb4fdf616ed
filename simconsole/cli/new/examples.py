"""`simconsole new example NAME`: one of the project's examples as a folder of one's own."""

import shutil
from pathlib import Path
from typing import Final

import simconsole
from simconsole.cli.outcome import Outcome
from simconsole.values.errors import ProfileError

EXAMPLES: Final = ("controllers", "lab", "notebook", "own_controller", "own_course", "regression", "roll_a_ball")
"""Those that travel with the package; the others need more than Python, and stand in the repository alone."""
_NOT_COPIED: Final = shutil.ignore_patterns("__pycache__", ".*", "out")


def examples_folder() -> Path:
    """Return where the examples are: in the installed package, or beside it in a checkout."""
    package = Path(simconsole.__file__).parent
    installed = package / "_examples"
    return installed if installed.is_dir() else package.with_name("examples")


def write_example(out: Path, name: str) -> Outcome:
    """Copy an example to the folder `name` below `out`, which must not be there yet.

    Raises:
        ProfileError: no such example, or its folder is there already or cannot be written.
    """
    if name not in EXAMPLES:
        raise ProfileError(f"command line: NAME: value {name}: one of {', '.join(EXAMPLES)}")
    folder = out / name
    if folder.exists():
        raise ProfileError(f"{folder}: is there already")
    try:
        shutil.copytree(examples_folder() / name, folder, ignore=_NOT_COPIED)
    except (OSError, shutil.Error) as error:
        raise ProfileError(f"{folder}: cannot be written: {getattr(error, 'strerror', None) or error}") from None
    files = sorted(str(path) for path in folder.rglob("*") if path.is_file())
    return Outcome(0, {"files": files}, "\n".join(files))
