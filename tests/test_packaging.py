"""The wheel: what is in it, and a drive from an installation of it that cannot see the checkout.

The libraries come from the environment that runs the tests (at the versions of constraints.txt), through one line in
the new environment's site-packages; simconsole itself comes from the wheel and from nowhere else.
"""

import email
import json
import os
import re
import subprocess
import sys
import sysconfig
import tomllib
import venv
import zipfile
from pathlib import Path
from typing import NamedTuple

import pytest
from packaging.requirements import Requirement

from simconsole import __version__
from simconsole.cli.main import parser
from simconsole.cli.new.examples import EXAMPLES
from tests.paths import ROOT


class Installation(NamedTuple):
    """An environment with the wheel in it, and an empty folder to work in."""

    folder: Path
    work: Path

    def run(self, *words: str | Path) -> subprocess.CompletedProcess[str]:
        """Run a program of the environment from the empty folder; the checkout is not on any path."""
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        program, *rest = words
        command = [self.folder / "bin" / program, *rest]
        return subprocess.run(command, cwd=self.work, env=environment, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder), str(ROOT)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installation(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Installation:
    folder = tmp_path_factory.mktemp("elsewhere")
    venv.create(folder / "venv", with_pip=False)
    python = folder / "venv" / "bin" / "python"
    pip = [sys.executable, "-m", "pip", "--python", str(python)]
    command = [*pip, "install", "--quiet", "--no-compile", "--no-deps", "--no-index", str(wheel)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    packages = folder / "venv" / "lib" / version / "site-packages"
    (packages / "libraries.pth").write_text(sysconfig.get_path("purelib") + "\n")
    (folder / "work").mkdir()
    return Installation(folder / "venv", folder / "work")


def tracked(pattern: str) -> set[str]:
    """Files of the checkout that match, without caches."""
    return {path.relative_to(ROOT).as_posix() for path in ROOT.glob(pattern) if path.is_file()}


DATA = (
    "simconsole/py.typed",
    "simconsole/bridge/messages/definitions/*/*/*",
    "simconsole/recording/exports/*.json",
)


def test_wheel_holds_the_package_and_every_profile_and_nothing_else(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name}
        profiles = {f"simconsole/_{name}" for name in tracked("profiles/**/*")}
        examples = {f"simconsole/_{path}" for name in EXAMPLES for path in tracked(f"examples/{name}/**/*")}
        examples = {path for path in examples if "/__pycache__/" not in path}
        assert names == tracked("simconsole/**/*.py").union(*map(tracked, DATA)) | profiles | examples
        for name in profiles:
            assert archive.read(name) == (ROOT / name.removeprefix("simconsole/_")).read_bytes()


def test_metadata_names_licence_python_and_libraries(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        metadata = email.message_from_string(archive.read(name).decode())
        assert any(entry.endswith("/LICENSE") for entry in archive.namelist())
    assert metadata["Version"] == __version__
    assert metadata["License-Expression"] == "Apache-2.0"
    assert metadata["Requires-Python"] == "<3.15,>=3.11"
    assert "# simconsole" in str(metadata.get_payload())


def test_metadata_says_who_made_it_and_what_it_is(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        metadata = email.message_from_string(archive.read(name).decode())
    assert metadata["Author"]
    assert "driving simulator" in metadata["Keywords"]
    assert {"Typing :: Typed", "Operating System :: POSIX :: Linux"} <= set(metadata.get_all("Classifier", []))


def test_container_copies_files_that_are_there_and_all_that_the_package_is_built_from() -> None:
    lines = (ROOT / "Containerfile").read_text().splitlines()
    copied = [source for line in lines if line.startswith("COPY ") for source in line.split()[1:-1]]
    assert all((ROOT / source).exists() for source in copied), copied
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    hatch = project["tool"]["hatch"]
    needed = {"pyproject.toml", "README.md", "constraints.txt", "scripts/metadata.py"}
    needed |= {*hatch["build"]["targets"]["wheel"]["packages"], *hatch["build"]["targets"]["wheel"]["force-include"]}
    needed |= set(project["project"]["license-files"])
    assert [path for path in needed if not {path, path.partition("/")[0]} & {one.rstrip("/") for one in copied}] == []
    commands = [line for line in lines if line.startswith(("ENTRYPOINT", "CMD"))]
    words = [word for line in commands for word in json.loads(line.partition(" ")[2])]
    assert words[0] in project["project"]["scripts"]
    assert parser().options_of(words[1:]).command == "demo"
    (image,) = [line for line in lines if line.startswith("FROM ")]
    assert re.search(r"python:3\.1[1-4]\b", image)


def test_every_library_is_pinned_at_a_version_that_fits() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    lines = (ROOT / "constraints.txt").read_text().split()
    pins = {normalised(name): version for name, version in (line.split("==") for line in lines)}
    assert len(pins) == len(lines)
    for text in (*project["dependencies"], *project["optional-dependencies"]["dev"]):
        requirement = Requirement(text)
        assert requirement.specifier.contains(pins[normalised(requirement.name)]), text


def test_extra_sumo_is_one_version_of_all() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    parts = {one.name: str(one.specifier) for one in map(Requirement, extras["sumo"])}
    assert set(parts) == {"eclipse-sumo", "libsumo", "traci"}
    assert len(set(parts.values())) == 1
    assert all(pin.startswith("==") for pin in parts.values())
    assert set(extras["sumo"]) <= set(extras["dev"]), "the one that the tests run"


def normalised(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def test_installed_package_and_its_profiles_come_from_the_wheel(installation: Installation) -> None:
    script = (
        "import json, simconsole, sys\n"
        "from simconsole.profiles.files import loader as files\n"
        "kinds = ('devices', 'vehicles', 'worlds', 'sessions', 'scenarios')\n"
        "names = {kind: files.names(kind) for kind in kinds}\n"
        "print(json.dumps([simconsole.__file__, str(files.profiles_folder()), names, sys.path]))"
    )
    done = installation.run("python", "-c", script)
    assert done.returncode == 0, done.stderr
    package, profiles, names, path = json.loads(done.stdout)
    assert Path(package).is_relative_to(installation.folder)
    assert Path(profiles).is_relative_to(installation.folder)
    assert str(ROOT) not in path
    for kind, found in names.items():
        assert found == sorted(file.stem for file in (ROOT / "profiles" / kind).glob("*.yaml"))


def test_installed_command_writes_every_example(installation: Installation) -> None:
    for name in EXAMPLES:
        done = installation.run("simconsole", "new", "example", name)
        assert done.returncode == 0, done.stderr
        written = {path.name for path in (installation.work / name).rglob("*") if path.is_file()}
        assert written == {
            path.name for path in (ROOT / "examples" / name).rglob("*") if path.suffix != ".pyc" and path.is_file()
        }


def test_installed_command_drives_and_replays_from_another_folder(installation: Installation) -> None:
    drive = installation.run(
        *("simconsole", "drive", "--headless", "--driver", "none", "--for", "2", "--out", "driven", "--json")
    )
    assert drive.returncode == 0, drive.stderr
    results = json.loads(drive.stdout.splitlines()[-1])
    assert results["ticks"] == 500
    assert {"report.html", "scene.rrd"} <= {path.name for path in (installation.work / "driven").iterdir()}
    replay = installation.run("simconsole", "replay", "driven")
    assert replay.returncode == 0, replay.stdout + replay.stderr
    assert "500 ticks" in replay.stdout
