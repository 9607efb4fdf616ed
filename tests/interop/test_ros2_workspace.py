"""The workspace in examples/ros2_ws: its nodes drive a car of ours, and its files fit together.

There is no `launch` in the package index: the launch file runs with stand-ins for its classes, which
record what it makes.
"""

import ast
import importlib.util
import json
import re
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import pytest
import yaml

from tests.interop.programs import program
from tests.interop.ros2 import PYTHON, domain, needs_ros2
from tests.paths import ROOT
from tests.patience import PATIENCE_S
from tests.ports import free_port

PACKAGE = ROOT / "examples/ros2_ws/src/simconsole_controllers"
NAME = PACKAGE.name
PARAMETERS = PACKAGE / "config/controllers.yaml"
SESSION = """
schema: 1
title: Driven by the ROS side
environment:
  world: urban
scenario:
  vehicle: hatchback
  start: {{x_m: 289.0, y_m: 445.954, yaw_deg: 180.0}}
  duration_s: 28
features:
  control:
    person_required: false
outputs:
  bridge:
    port: {port}
    namespace: /ego
    ros2: {ros2}
  hud: null
  scene: null
  report: false
devices:
  driver: none
mode:
  pacing: lockstep
  answer_timeout_s: 60
"""


@needs_ros2
@pytest.mark.parametrize("node", ["graph_controller", "rosbridge_controller"])
def test_a_node_follows_the_course(node: str, tmp_path: Path, record_property: Callable[[str, object], None]) -> None:
    port = free_port()
    session = tmp_path / "session.yaml"
    session.write_text(SESSION.format(port=port, ros2="{}" if node == "graph_controller" else "null"))
    around = domain()
    around["PYTHONPATH"] += f":{PACKAGE}"
    console = [PYTHON, "-m", "simconsole", "drive", str(session), "--out", str(tmp_path / "bundle"), "--json"]
    console += ["--no-pack"]
    controller = [PYTHON, "-m", f"{NAME}.{node}", "--ros-args", "--params-file", str(PARAMETERS)]
    controller += ["-p", f"port:={port}", "-p", "namespace:=/ego"]
    with program(around, *console) as drive, program(around, *controller):
        output, complaint = drive.communicate(timeout=PATIENCE_S)
    assert drive.returncode == 0, complaint
    results = json.loads(output.splitlines()[-1])
    distance_m, lateral_m = results["distance_m"], results["autonomous"]["lateral_max_m"]
    record_property(node, f"{distance_m:.0f} m of the course, at most {100.0 * lateral_m:.0f} cm beside it")
    assert distance_m > 150.0  # through a corner of 15 m to the right, and one of 13 m to the left
    assert lateral_m < 0.2


def imports(path: Path) -> set[str]:
    found = set()
    for statement in ast.walk(ast.parse(path.read_text())):
        if isinstance(statement, ast.Import):
            found |= {alias.name.partition(".")[0] for alias in statement.names}
        elif isinstance(statement, ast.ImportFrom):
            found.add(str(statement.module).partition(".")[0])
    return found


def set_up(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What setup.py tells setuptools."""
    told: dict[str, Any] = {}
    setuptools = ModuleType("setuptools")
    setuptools.setup = lambda **words: told.update(words)  # type: ignore[attr-defined]  # a module made here
    monkeypatch.setitem(sys.modules, "setuptools", setuptools)
    exec(compile((PACKAGE / "setup.py").read_text(), "setup.py", "exec"), {})
    return told


def test_what_is_installed_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    told = set_up(monkeypatch)
    assert told["name"] == NAME
    installed = {file for _, files in told["data_files"] for file in files}
    files = {
        str(path.relative_to(PACKAGE))
        for path in PACKAGE.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert installed == files - {"setup.py", "setup.cfg"} - {file for file in files if file.startswith(f"{NAME}/")}
    for script in told["entry_points"]["console_scripts"]:
        program_name, module, function = re.fullmatch(r"(\w+) = ([\w.]+):(\w+)", script).groups()  # type: ignore[union-attr]  # it matches
        source = PACKAGE / f"{module.replace('.', '/')}.py"
        assert program_name == source.stem
        assert function in {
            part.name for part in ast.parse(source.read_text()).body if isinstance(part, ast.FunctionDef)
        }


def test_the_manifest_names_what_is_imported() -> None:
    manifest = ElementTree.parse(PACKAGE / "package.xml").getroot()
    assert manifest.findtext("name") == NAME
    assert manifest.findtext("export/build_type") == "ament_python"
    depends = {depend.text for depend in manifest.findall("exec_depend")}
    sources = [*PACKAGE.glob("launch/*.py"), *(PACKAGE / NAME).glob("*.py")]
    imported = set().union(*map(imports, sources)) - sys.stdlib_module_names - {NAME, "roslibpy"}
    assert depends == imported


def test_parameters_are_those_that_nodes_declare() -> None:
    given = yaml.safe_load(PARAMETERS.read_text())["/**"]["ros__parameters"]
    declared: dict[str, object] = {}
    for source in (PACKAGE / NAME).glob("*_controller.py"):
        for name, default in re.findall(r'declare_parameter\("(\w+)", ([^)]*)\)', source.read_text()):
            assert declared.setdefault(name, ast.literal_eval(default)) == ast.literal_eval(default)
    assert given == declared


class _Made:
    """A stand-in for a class of launch: what it was made of."""

    def __init__(self, *words: Any, **named: Any) -> None:
        self.words, self.named = words, named


def launched(monkeypatch: pytest.MonkeyPatch, share: Path) -> list[_Made]:
    """The entities of the launch file's description."""
    classes = {
        "launch": ["LaunchDescription"],
        "launch.actions": ["DeclareLaunchArgument"],
        "launch.substitutions": ["LaunchConfiguration"],
        "launch_ros": [],
        "launch_ros.actions": ["Node"],
    }
    for module_name, names in classes.items():
        module = ModuleType(module_name)
        for name in names:
            setattr(module, name, type(name, (_Made,), {}))
        monkeypatch.setitem(sys.modules, module_name, module)
    index = ModuleType("ament_index_python.packages")
    index.get_package_share_directory = lambda package: str(share) if package == NAME else ""  # type: ignore[attr-defined]  # a module made here
    monkeypatch.setitem(sys.modules, "ament_index_python", ModuleType("ament_index_python"))
    monkeypatch.setitem(sys.modules, "ament_index_python.packages", index)
    specification = importlib.util.spec_from_file_location("launched", PACKAGE / "launch/controller.launch.py")
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    description: _Made = module.generate_launch_description()
    entities: list[_Made] = description.words[0]
    return entities


def test_the_launch_file_starts_what_is_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    scripts = [script.partition(" ")[0] for script in set_up(monkeypatch)["entry_points"]["console_scripts"]]
    *arguments, node = launched(monkeypatch, PACKAGE)
    declared = {argument.words[0]: argument.named for argument in arguments}
    assert set(declared["controller"]["choices"]) == set(scripts)
    assert declared["controller"]["default_value"] in scripts
    assert Path(declared["parameters"]["default_value"]) == PARAMETERS
    assert node.named["package"] == NAME
    assert node.named["executable"].words == ("controller",)
    assert [each.words for each in node.named["parameters"]] == [("parameters",)]


def test_the_container_installs_the_roslibpy_that_is_tested() -> None:
    pinned = re.search(r"^roslibpy==\S+$", (ROOT / "constraints.txt").read_text(), re.MULTILINE)
    assert pinned is not None
    for file in ("Containerfile", "README.md"):
        assert pinned[0] in (ROOT / "examples/ros2_ws" / file).read_text()
