"""`simconsole new KIND NAME`: a template that runs at once, and a test beside it."""

import re
from argparse import Namespace
from pathlib import Path
from string import Template
from typing import Final

from simconsole.cli.new import driver_texts, metric_texts, platform_texts, texts, world_texts
from simconsole.cli.new.examples import write_example
from simconsole.cli.outcome import Outcome
from simconsole.profiles.files.loader import find
from simconsole.values.errors import ProfileError

_PROJECT: Final = """\
[build-system]
requires = ["hatchling"]
build-backend = "hatchling.build"

[project]
name = "$name"
version = "0.1.0"
dependencies = ["simconsole"]

[project.entry-points."$group"]
$name = "$name:$registered"

[tool.hatch.build.targets.wheel]
only-include = ["$name.py"]
"""


def _project(group: str, registered: str) -> str:
    """Return the pyproject.toml of a package of one module, which registers what stands in it."""
    return Template(_PROJECT).safe_substitute(group=group, registered=registered)


KINDS: Final = {
    "controller": {"$name.py": texts.CONTROLLER, "test_$name.py": texts.TEST_CONTROLLER},
    "driver": {
        "pyproject.toml": _project(*driver_texts.ENTRY),
        "$name.py": driver_texts.DRIVER,
        "$name.yaml": driver_texts.SESSION,
        "test_$name.py": driver_texts.TEST,
    },
    "scenario": {"$name.yaml": texts.SCENARIO, "test_$name.py": texts.TEST_SCENARIO},
    "vehicle": {"test_$name.py": texts.TEST_VEHICLE},
    "platform": {
        "pyproject.toml": _project(*platform_texts.ENTRY),
        "$name.py": platform_texts.PLATFORM,
        "$name.yaml": platform_texts.PROFILE,
        "test_$name.py": platform_texts.TEST,
    },
    "metric": {
        "pyproject.toml": _project(*metric_texts.ENTRY),
        "$name.py": metric_texts.METRIC,
        "test_$name.py": metric_texts.TEST,
    },
    "world": {"$name.plan.yaml": texts.WORLD_PLAN, "test_$name.py": texts.TEST_WORLD},
    "place": {
        "pyproject.toml": _project(*world_texts.ENTRY),
        "$name.py": world_texts.WORLD,
        "$name.yaml": world_texts.PROFILE,
        "test_$name.py": world_texts.TEST,
    },
    "session": {"$name.yaml": texts.SESSION, "test_$name.py": texts.TEST_SESSION},
}
"""Files of each kind; a vehicle's profile, a world and a golden are made from what is there."""
SCHEMAS: Final = {
    **{"driver": "session", "scenario": "scenario", "vehicle": "vehicle", "platform": "vehicle"},
    **{"world": "plan", "place": "world", "session": "session"},
}
"""Of the YAML file of each kind: the name of its schema, as `simconsole explain --schemas` writes it."""
BEGUN: Final = "hatchback"
_NAME: Final = re.compile(r"[a-z][a-z0-9_]{0,40}")


def new(options: Namespace) -> Outcome:
    """Write the files of a kind, or of an example; none that is there is replaced.

    Raises:
        ProfileError: a name that is none, a file that is there already or cannot be written.
    """
    if options.kind == "example":
        return write_example(Path(options.out), options.name)
    folder, name = Path(options.out), str(options.name)
    if not _NAME.fullmatch(name):
        raise ProfileError(f"command line: NAME: value {name}: lower-case letters, digits and _, up to 41")
    files = {
        Template(file).substitute(name=name): Template(text).safe_substitute(name=name)
        for file, text in KINDS[options.kind].items()
    }
    if options.kind == "vehicle":
        files[f"{name}.yaml"] = _vehicle(name)
    files = {file: _schema_line(options.kind, folder) * file.endswith(".yaml") + text for file, text in files.items()}
    made = [*files, *({"world": [f"{name}.yaml"], "scenario": [f"golden/{name}.csv"]}.get(options.kind, []))]
    for file in made:
        if (folder / file).exists():
            raise ProfileError(f"{folder / file}: is there already")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for file, text in files.items():
            (folder / file).write_text(text, "utf-8")
    except OSError as error:
        raise ProfileError(f"{folder}: cannot be written: {error.strerror}") from None
    _complete(options.kind, folder, name)
    paths = sorted(str(folder / file) for file in made)
    return Outcome(0, {"files": paths}, "\n".join((*paths, f"pytest {folder / f'test_{name}.py'}")))


def _schema_line(kind: str, folder: Path) -> str:
    """Return the line that tells editors the schema of a YAML file, where the folder has it; else nothing."""
    schema = f"schemas/{SCHEMAS.get(kind)}.schema.json"
    return f"# yaml-language-server: $schema={schema}\n" if (folder / schema).is_file() else ""


def _vehicle(name: str) -> str:
    """Return the shipped vehicle under a new head."""
    lines = find("vehicles", BEGUN).read_text("utf-8").splitlines(keepends=True)
    first = next(at for at, line in enumerate(lines) if not line.startswith("#"))
    return Template(texts.VEHICLE_HEAD.format(begun=BEGUN)).substitute(name=name) + "".join(lines[first:])


def _complete(kind: str, folder: Path, name: str) -> None:
    """Make what is made from the files that were written: the world of a plan, the golden of a scenario."""
    if kind == "world":
        from simconsole.world.tools.generate import generate

        generate(str(folder / f"{name}.plan.yaml"), str(folder / f"{name}.yaml"))
    if kind == "scenario":
        from simconsole.evaluation.checks.scenario_check import check_scenario

        check_scenario(str(folder / f"{name}.yaml"), update_golden=True)
