"""What a person can get wrong at the command line: one line, exit code 2, nothing made, nothing lost."""

import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.drives.console import complaint, environment, simconsole, within
from tests.patience import PATIENCE_S

Run = Callable[..., "subprocess.CompletedProcess[str]"]
SESSION = "schema: 1\noutputs: {hud: null, scene: null}\nmode: {pacing: free}\n"


def drive(tmp_path: Path, *arguments: object, run: Run = within) -> str:
    """Drive, expecting a refusal that leaves no trace."""
    before = sorted(tmp_path.rglob("*"))
    line = complaint(run("drive", *arguments, "--headless", "--out", tmp_path / "out" / "bundle"))
    assert sorted(tmp_path.rglob("*")) == before, "nothing was made"
    assert line.startswith("simconsole drive: ")
    return line.removeprefix("simconsole drive: ")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "scenari: {vehicle: hatchback}",
            'scenari: value {"vehicle":"hatchback"}: unknown key, did you mean scenario?',
        ),
        ("scenario: {duration_s: long}", 'scenario.duration_s: value "long": '),
        ("scenario: {duration_s: -3}", "scenario.duration_s: value -3: a number, above 0 and 86400 or less"),
        ("scenario: {duration_s: .nan}", "scenario.duration_s: value .nan: a finite number"),
        ("mode: {tick_hz: 240}", "mode.tick_hz: value 240: one of 50, 100, 125, 200, 250, 500, 1000"),
        ("environment: {friction: 20}", "environment.friction: value 20: a number, above 0 and 2 or less"),
        ("environment: {world: ../../secret}", 'environment.world: value "../../secret": '),
        ("scenario: {vehicle: /etc/passwd}", 'scenario.vehicle: value "/etc/passwd": '),
        ("a: &a [1]\nb: *a", "line 1: anchor &a is not allowed"),
        ("a: !!python/object/apply:os.system ['touch pwned']", "line 1: tag"),
        ("a: [[[[[[[[[[" + "[" * 100, "nesting deeper than 32"),
    ],
)
def test_a_bad_session_names_file_key_value_and_range(tmp_path: Path, text: str, message: str) -> None:
    session = tmp_path / "session.yaml"
    key = text.split(":", 1)[0]
    session.write_text(text + "\n" + "".join(line for line in SESSION.splitlines(True) if not line.startswith(key)))
    line = drive(tmp_path, session, "--driver", "none", "--for", 1)
    assert line.startswith(f"{session}: ")
    assert message in line


@pytest.mark.parametrize("driver", ["script:../secret.yaml", "script:{outside}/secret.yaml", "trace:../secret.csv"])
def test_a_session_cannot_reach_outside_its_folder(tmp_path: Path, driver: str) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    for name in ("secret.yaml", "secret.csv"):
        (tmp_path / name).write_text("points: []\n")
    named = driver.format(outside=tmp_path)
    session = inside / "session.yaml"
    session.write_text(SESSION + f"devices: {{driver: '{named}'}}\n")
    line = drive(tmp_path, session, "--for", 1)
    assert line == f'{session}: devices.driver: value "{named}": a file inside {inside}'


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere"], "sessions profile: value 'nowhere': one of "),
        (["../seated"], "sessions profile: value '../seated': a name without / or a path that ends in "),
        (["--driver", "none", "--for", "nan"], "--for: value nan: a finite number of seconds"),
        (["--driver", "none", "--for", "-1"], "scenario.duration_s: value -1"),
        (["--driver", "none", "--for", "1e9"], "scenario.duration_s: value 1"),
        (["--driver", "telepathy", "--for", "1"], 'devices.driver: value "telepathy"'),
        (["--driver", "script:missing.yaml", "--for", "1"], "missing.yaml"),
        (["--driver", "trace:missing.csv", "--for", "1"], "missing.csv: file: No such file"),
        (["--driver", "keyboard", "--for", "1"], "devices.driver: value keyboard: "),
        (["--driver", "none", "--person", "3", "--for", "1"], "--person: value 3: only with --driver virtual"),
        (["--driver", "virtual", "--person", "-3", "--for", "1"], "devices.person.seed: value -3"),
    ],
)
def test_bad_words_name_the_key(tmp_path: Path, arguments: list[str], message: str) -> None:
    assert message in drive(tmp_path, *arguments)


def test_with_no_wheel_connected_a_seated_drive_names_what_is_missing(tmp_path: Path) -> None:
    line = drive(tmp_path, "--driver", "sdl", "--for", 1, run=simconsole)
    assert "044f:b65e" in line
    assert "wheel" in line
    assert line.endswith("not connected: nothing is; without it: --driver keyboard, or simconsole demo")


def test_a_wheel_in_boot_mode_is_named_with_its_cure(tmp_path: Path) -> None:
    # Virtual devices belong to one process: plug the wheel in, then be the command.
    program = (
        "import sys\n"
        "from simconsole.cli.main import main\n"
        "from simconsole.devices.sources.virtual_joystick import VirtualDevice, VirtualSpec\n"
        'wheel = VirtualDevice(VirtualSpec("Thrustmaster FFB Wheel", 0x044F, 0xB65D, 2, 13, 1))\n'
        "code = main(sys.argv[1:])\n"
        "wheel.close()\n"
        "sys.exit(code)\n"
    )
    out = tmp_path / "bundle"
    words = [sys.executable, "-c", program, "drive", "--headless", "--driver", "sdl", "--for", "1", "--out", str(out)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE_S, env=environment(), check=False)
    line = complaint(done)
    assert "value 044f:b65d (boot mode): 044f:b65e" in line
    assert not out.exists()


def test_an_existing_recording_is_never_written_over(short: Path, script: Path) -> None:
    before = {path.name: path.stat().st_mtime_ns for path in short.iterdir()}
    line = complaint(within("drive", "--headless", "--driver", f"script:{script}", "--for", 1, "--out", short))
    assert line == f"simconsole drive: {short}: cannot be recorded to: the folder is not empty"
    assert {path.name: path.stat().st_mtime_ns for path in short.iterdir()} == before


def test_an_autopilot_needs_lockstep_or_real_time(tmp_path: Path) -> None:
    session = tmp_path / "session.yaml"
    session.write_text(SESSION + "features: {autopilot: urban}\ndevices: {driver: none}\n")
    assert "mode.pacing: value free (with --headless realtime becomes free): lockstep or realtime" in drive(
        tmp_path, session, "--for", 1
    )


@pytest.mark.parametrize("link", ["upstream: {url: 'ws://ros:9090'}", "ros2: {}"])
def test_a_free_drive_refuses_links_that_it_would_not_open(tmp_path: Path, link: str) -> None:
    session = tmp_path / "session.yaml"
    text = SESSION.replace("scene: null", f"scene: null, bridge: {{{link}}}")
    session.write_text(text + "devices: {driver: none}\n")
    said = drive(tmp_path, session, "--for", 1)
    assert said.startswith("mode.pacing: value free ")
    assert f"outputs.bridge.{link.partition(':')[0]}" in said


def test_lockstep_needs_a_bridge(tmp_path: Path) -> None:
    session = tmp_path / "session.yaml"
    session.write_text("schema: 1\ndevices: {driver: none}\nmode: {pacing: lockstep}\n")
    assert "outputs.bridge: value missing: " in drive(tmp_path, session, "--for", 1)


@pytest.mark.parametrize("pacing", ["realtime", "lockstep"])
def test_a_port_that_is_taken_is_one_line(tmp_path: Path, pacing: str) -> None:
    session = tmp_path / "session.yaml"
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        session.write_text(
            f"schema: 1\noutputs: {{bridge: {{port: {port}}}, hud: null, scene: null}}\n"
            f"devices: {{driver: none}}\nmode: {{pacing: {pacing}}}\n"
        )
        line = complaint(within("drive", session, "--for", 1, "--out", tmp_path / "bundle"))
    assert f"cannot listen on 127.0.0.1 port {port}: " in line
    assert not (tmp_path / "bundle").exists()


def test_with_json_the_refusal_is_the_last_line_too(tmp_path: Path) -> None:
    done = simconsole("drive", "nowhere", "--json", "--out", tmp_path / "bundle")
    assert done.returncode == 2
    assert done.stdout.startswith('{"error":"')
    assert len(done.stdout.splitlines()) == len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("arguments", [["drive", "--fast"], ["fly"], [], ["drive", "--for", "soon"]])
def test_words_that_are_no_command_are_usage_and_code_2(arguments: list[str]) -> None:
    done = simconsole(*arguments)
    assert done.returncode == 2
    assert "usage: simconsole" in done.stderr
    assert "Traceback" not in done.stderr
