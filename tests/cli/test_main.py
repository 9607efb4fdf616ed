"""The commands as a person meets them: what they print, how they end, what they load."""

import pytest

from simconsole.cli.main import parser
from tests.drives.console import simconsole

COMMANDS = {
    "demo",
    "drive",
    "replay",
    "verify",
    "compare",
    "export",
    "import",
    "check",
    "report",
    "video",
    "view",
    "devices",
    "bridge",
    "can",
    "autopilot",
    "new",
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
