"""How much is said, and in which colours."""

import io

import pytest

from simconsole.cli import doctor
from simconsole.cli.main import main
from simconsole.cli.outcome import Outcome
from simconsole.cli.terminal.talk import Talk, coloured, level, say, talking
from simconsole.values.errors import ProfileError


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def coloured_terminal(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    return Terminal()


def test_verdicts_are_coloured_on_a_terminal(coloured_terminal: Terminal) -> None:
    assert coloured("pass  a\nFAIL  b\na pass", coloured_terminal) == (
        "\x1b[32mpass\x1b[0m  a\n\x1b[31mFAIL\x1b[0m  b\na pass"
    )


@pytest.mark.parametrize(("name", "value"), [("NO_COLOR", "1"), ("TERM", "dumb")])
def test_nobody_gets_colours_who_wants_none(
    name: str, value: str, coloured_terminal: Terminal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(name, value)
    assert coloured("FAIL  b", coloured_terminal) == "FAIL  b"


def test_a_pipe_gets_no_colours(coloured_terminal: Terminal) -> None:
    assert coloured("FAIL  b", io.StringIO()) == "FAIL  b"


def test_quiet_keeps_remarks_back_and_the_level_ends_with_its_block(capsys: pytest.CaptureFixture[str]) -> None:
    with talking(Talk.QUIET):
        say("something")
        assert level() is Talk.QUIET
    say("something else")
    assert capsys.readouterr().err == "simconsole: something else\n"


@pytest.mark.parametrize(("code", "said"), [(0, ""), (1, "three fields differ\n")])
def test_a_quiet_command_tells_only_what_failed(
    code: int, said: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(doctor, "doctor", lambda options: Outcome(code, {}, "three fields differ"))
    assert main(["doctor", "--quiet"]) == code
    assert capsys.readouterr().out == said


@pytest.mark.parametrize(("option", "lines"), [("-q", 1), ("-v", 2)])
def test_an_error_is_one_line_and_at_length_if_asked(
    option: str, lines: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(options: object) -> Outcome:
        raise ProfileError("a.yaml: title: value missing: required")

    monkeypatch.setattr(doctor, "doctor", fails)
    assert main(["doctor", option]) == 2
    said = capsys.readouterr().err
    assert ("Traceback" in said) == (lines > 1)
    assert said.splitlines()[-1] == "simconsole doctor: a.yaml: title: value missing: required"
