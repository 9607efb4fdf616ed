"""The commands as a person meets them: what they print, how they end, what they load."""

import shutil
import sys
from pathlib import Path

import pytest

from simconsole.cli.main import parser
from tests.drives.console import complaint, results, simconsole

COMMANDS = {
    "demo",
    "drive",
    "replay",
    "verify",
    "compare",
    "check",
    "report",
    "view",
    "devices",
    "bridge",
    "can",
    "autopilot",
    "doctor",
}


def test_help_names_every_command_and_what_it_does() -> None:
    done = simconsole("--help")
    assert done.returncode == 0
    assert done.stderr == ""
    assert {line.split()[0] for line in done.stdout.splitlines() if line.startswith("    ")} >= COMMANDS


@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_every_command_explains_itself(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        parser().parse_args([command, "--help"])
    assert ended.value.code == 0
    said = capsys.readouterr().out
    assert f"usage: simconsole {command}" in said
    assert "--json" in said


def test_version_is_one_line() -> None:
    done = simconsole("--version")
    assert done.returncode == 0
    assert done.stdout.startswith("simconsole 0.")
    assert len(done.stdout.splitlines()) == 1


def test_doctor_tells_what_is_there_and_what_is_not() -> None:
    done = simconsole("doctor", "--json")
    assert done.returncode == 0
    found = results(done)
    assert found["python"] == sys.version.split()[0]
    assert found["display"] == "no: no window; PNG works"
    assert found["numba"] != "missing"
    for name in found:
        assert f"  {name} " in done.stdout


def test_devices_list_shows_a_virtual_cockpit() -> None:
    done = simconsole("devices", "list", "--virtual", "--json")
    assert done.returncode == 0, done.stderr
    assert {device["usb_id"]: device["roles"] for device in results(done)["devices"]} == {
        "044f:b65e": ["wheel", "pedals"],
        "044f:b660": ["shifter"],
    }
    assert "044f:b65e" in done.stdout


def test_devices_list_without_a_cockpit_fails_and_says_so() -> None:
    done = simconsole("devices", "list")
    assert done.returncode == 1
    assert "nothing connected for wheel, pedals, shifter" in done.stdout


def test_devices_check_without_a_cockpit_is_one_line() -> None:
    assert "044f:b65e" in complaint(simconsole("devices", "check", "--for", 1))


def test_verify_says_that_a_bundle_is_whole_or_what_is_wrong(short: Path, tmp_path: Path) -> None:
    done = simconsole("verify", short)
    assert done.returncode == 0
    assert done.stdout == f"{short}: whole\n"
    spoilt = Path(shutil.copytree(short, tmp_path / "spoilt"))
    content = bytearray((spoilt / "drive.log").read_bytes())
    content[-2000] ^= 1
    (spoilt / "drive.log").write_bytes(content)
    done = simconsole("verify", spoilt, "--json")
    assert done.returncode == 1
    found = results(done)
    assert not found["good"]
    assert all(str(spoilt / "drive.log") in problem for problem in found["problems"])


def test_compare_finds_a_bundle_equal_to_itself(short: Path) -> None:
    done = simconsole("compare", short, short, "--json")
    assert done.returncode == 0
    assert results(done) == {"equal": True, "ticks": 750, "difference": None, "problems": []}


def test_report_is_written_again(short: Path, tmp_path: Path) -> None:
    short = Path(shutil.copytree(short, tmp_path / "copy"))
    (short / "report.html").unlink()
    done = simconsole("report", short, "--json")
    assert done.returncode == 0, done.stderr
    assert results(done)["duration_s"] == 3.0
    assert str(short / "report.html") in done.stdout
    assert (short / "report.html").read_text("utf-8").startswith("<!DOCTYPE html>")
    assert simconsole("verify", short).returncode == 0


def test_view_writes_the_scene_without_opening_it(short: Path, tmp_path: Path) -> None:
    short = Path(shutil.copytree(short, tmp_path / "copy"))
    (short / "scene.rrd").unlink()
    done = simconsole("view", short, "--no-open", "--json")
    assert done.returncode == 0, done.stderr
    assert results(done) == {"scene": str(short / "scene.rrd"), "problems": []}
    assert (short / "scene.rrd").read_bytes()[:4] == b"RRF2"


def test_autopilot_against_nobody_is_one_line() -> None:
    line = complaint(simconsole("autopilot", "--url", "ws://127.0.0.1:9", "--wait", 0.1))
    assert "ws://127.0.0.1:9: cannot connect: " in line


def test_autopilot_on_an_unknown_course_is_one_line() -> None:
    line = complaint(simconsole("autopilot", "--url", "ws://127.0.0.1:9", "--course", "moon"))
    assert "worlds profile: value 'moon'" in line


def test_a_file_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    done = simconsole("check", "launch_and_stop", "--junit", tmp_path / "nowhere" / "junit.xml")
    assert "No such file or directory" in complaint(done)
