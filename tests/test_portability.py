"""Windows and macOS, as far as Linux can tell: the console's modules without what those systems lack, by their name."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.paths import ROOT

FOREIGN = ROOT / "tests" / "foreign"
SCRIPT = """\
schema: 1
points:
- {time_s: 0.0, throttle: 0, brake: 0, clutch: 1, hand_wheel_deg: 0, gear: 0}
- {time_s: 0.3, clutch: 1, gear: 1, throttle: 0.4}
- {time_s: 1.0, clutch: 0, throttle: 0.4}
"""


@pytest.fixture(params=["win32", "darwin"])
def platform(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def run(platform: str, *words: object, **variables: str) -> "subprocess.CompletedProcess[str]":
    """Run Python on that system (tests/foreign/sitecustomize.py)."""
    environment = {
        **os.environ,
        **variables,
        "SIMCONSOLE_TEST_PLATFORM": platform,
        "PYTHONPATH": f"{FOREIGN}{os.pathsep}{ROOT}",
    }
    return subprocess.run(
        [sys.executable, *map(str, words)], capture_output=True, text=True, check=False, env=environment
    )


def test_the_other_system_is_there(platform: str) -> None:
    """A module of this name sees what a module of the console sees."""
    seen = (
        "import os, sys; print(sys.platform, os.name, hasattr(os, 'getuid'), hasattr(os, 'sched_yield')); import fcntl"
    )
    done = run(platform, "-c", f'exec("{seen}", {{"__name__": "simconsole.x"}})')
    if platform == "win32":
        assert done.stdout.split() == ["win32", "nt", "False", "False"]
        assert "No module named 'fcntl'" in done.stderr
    else:
        assert done.stdout.split() == ["darwin", "posix", "True", "False"]
        assert done.returncode == 0


def test_libraries_see_the_system_that_they_run_on(platform: str, tmp_path: Path) -> None:
    """Wherever the console lies, below a folder of its own name too: they load files of this system."""
    libraries = tmp_path / "simconsole" / ".venv"
    libraries.mkdir(parents=True)
    (libraries / "library.py").write_text("import sys\nprint(sys.platform)\n")
    done = run(platform, "-c", f"import sys; sys.path.append({str(libraries)!r}); import library")
    assert done.stdout.split() == [sys.platform], done.stderr


def test_the_program_itself_is_a_part_of_the_console(platform: str, tmp_path: Path) -> None:
    """What `python -m` runs is no module of the console by name: it is called __main__."""
    package = tmp_path / "simconsole"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "__main__.py").write_text("import sys\nprint(sys.platform)\n")
    as_m_does = "import runpy; runpy.run_module('simconsole', run_name='__main__', alter_sys=True)"
    done = run(platform, "-c", f"import sys; sys.path.insert(0, {str(tmp_path)!r}); {as_m_does}")
    assert done.stdout.split() == [platform], done.stderr


def test_every_module_can_be_imported(platform: str) -> None:
    done = run(platform, FOREIGN / "import_all.py")
    assert done.returncode == 0, done.stdout
    assert int(done.stdout) > 400


def test_a_headless_drive_is_recorded_reported_and_replayed(platform: str, tmp_path: Path) -> None:
    script, bundle = tmp_path / "script.yaml", tmp_path / "bundle"
    script.write_text(SCRIPT)
    console = (platform, "-m", "simconsole")
    drive = run(*console, "drive", "--headless", "--driver", f"script:{script}", "--for", 2, "--out", bundle)
    assert drive.returncode == 0, drive.stderr
    assert {path.name for path in bundle.iterdir()} == {
        "drive.parquet",
        "manifest.json",
        "report.html",
        "scene.rrd",
        "session.json",
    }
    looks = "import sys; from simconsole.cli.main import main; sys.exit(any(main([do, sys.argv[1]]) for do in DO))"
    replay = run(platform, "-c", looks.replace("DO", "('verify', 'replay')"), bundle)
    assert replay.returncode == 0, replay.stderr
    assert f"{bundle}: whole" in replay.stdout
    assert "500 ticks replayed, every hash equal" in replay.stdout


def test_scenarios_in_processes_of_their_own_meet_their_goldens(platform: str) -> None:
    done = run(platform, "-m", "simconsole", "check", "launch_and_stop", "roll_a_ball", "--jobs", 2)
    assert done.returncode == 0, done.stdout + done.stderr


def test_run_folders_of_the_dead_are_swept_and_those_of_the_living_stay(platform: str, tmp_path: Path) -> None:
    sweep = (
        "import os, pathlib, simconsole.processes.shared_memory as memory\n"
        "here = pathlib.Path(os.environ['HERE'])\n"
        "mine = here / f'{memory.PREFIX}{os.getpid()}-a'; mine.mkdir()\n"
        "theirs = here / f'{memory.PREFIX}99999999-b'; theirs.mkdir()\n"  # no process has this number
        "print(memory.sweep(here) == [theirs], mine.is_dir(), theirs.is_dir())"
    )
    done = run(platform, "-c", sweep, HERE=str(tmp_path))
    assert done.stdout.split() == ["True", "True", "False"], done.stderr
