"""The commands as a person meets them: what they print, how they end, what they load."""

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


def test_version_is_one_line() -> None:
    done = simconsole("--version")
    assert done.returncode == 0
    assert done.stdout.startswith("simconsole 0.")
    assert len(done.stdout.splitlines()) == 1
