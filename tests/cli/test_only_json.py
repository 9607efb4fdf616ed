"""`--json`: standard output is one JSON object, of every command, whether it succeeds or not."""

import json
import shutil
import sys
from pathlib import Path

import pytest

from simconsole.cli.arguments.tools import NEW_KINDS
from simconsole.cli.main import main, parser
from tests.paths import ROOT
from tests.ports import free_port

NOT_THERE = "not/there"
WORDS = {
    "drive": ("{plain}", "--headless", "--driver", "none", "--for", "1", "--out", "{new}"),
    "check": (NOT_THERE,),
    "scenario import": (NOT_THERE,),
    "turtlebot": ("--session", NOT_THERE),
    "sweep": (NOT_THERE,),
    "autopilot": ("--wait", "0", "--url", "{url}"),
    "replay": ("{short}",),
    "verify": ("{short}",),
    "sign": ("--new-key", "{new}"),
    "report": ("{copy}",),
    "view": ("{copy}", "--no-open"),
    "pack": ("{copy}",),
    "unpack": ("{copy}",),
    "compare": ("{short}", "{short}"),
    "export": ("{short}", "--to", "csv", "--out", "{new}"),
    "import": (NOT_THERE,),
    "video": (NOT_THERE,),
    "devices list": (),
    "devices check": ("--for", "0.1"),
    "devices calibrate": ("--out", "{new}"),
    "devices feel": (),
    "devices identify": (),
    "devices accept": ("--cockpit", NOT_THERE),
    "devices record": ("--out", "{new}"),
    "devices speakers": ("--device", NOT_THERE),
    "world list": (),
    "world show": ("urban",),
    "world import": (NOT_THERE,),
    "world export": ("arena", "--out", "{new}"),
    "bridge check": ("{url}",),
    "bridge bench": ("{url}", "--for", "0.01"),
    "bridge cert": ("--out", "{new}"),
    "can monitor": ("--for", "0.2", "--interface", "virtual", "--channel", "here"),
    "can send": ("--for", "0.2", "--interface", "virtual", "--channel", "here"),
    "can replay": ("--file", NOT_THERE, "--interface", "virtual", "--channel", "here"),
    "doctor": (),
    "list": ("worlds",),
    "explain": ("steering.ratio",),
    **{f"new {kind}": ("evening", "--out", "{new}") for kind in NEW_KINDS},
    **{f"operate {act}": ("--url", "{url}") for act in parser().commands["operate"].commands},
}
TRIED_ELSEWHERE = {"demo": "tests/drives/fixtures.py", "bridge serve": "tests/cli/test_rosbridge.py"}
"""Those that take long, and are run with --json for other tests: `results` there reads all of standard output."""


@pytest.fixture
def places(plain: Path, short: Path, tmp_path: Path) -> dict[str, str]:
    copy = shutil.copytree(short, tmp_path / "copy")
    paths = {"plain": plain, "copy": copy, "short": short, "new": tmp_path / "new"}
    port = str(free_port())
    return {**{name: str(path) for name, path in paths.items()}, "port": port, "url": f"ws://127.0.0.1:{port}"}


def test_every_command_is_tried() -> None:
    for command, path in TRIED_ELSEWHERE.items():
        text = (ROOT / path).read_text()
        assert ", ".join(f'"{word}"' for word in command.split()) in text
        assert '"--json"' in text
    assert {*WORDS, *TRIED_ELSEWHERE} == {
        page.prog.removeprefix("simconsole ") for page in parser().pages() if not page.commands
    }


@pytest.mark.parametrize("command", WORDS)
def test_standard_output_is_one_json_object(
    command: str, places: dict[str, str], capfd: pytest.CaptureFixture[str]
) -> None:
    code = main([*command.split(), *(word.format(**places) for word in WORDS[command]), "--json"])
    said = capfd.readouterr()
    (line,) = said.out.splitlines()
    results = json.loads(line)
    assert isinstance(results, dict)
    if code == 2:
        assert "error" in results or "failures" in results
        assert said.err or "failures" in results


def test_of_a_command_line_that_cannot_be_read_too(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["drive", "--headles", "--json"])
    assert ended.value.code == 2
    assert json.loads(capfd.readouterr().out) == {"error": "not known here: --headles; did you mean --headless?"}


def test_what_a_command_prints_while_it_works_goes_elsewhere(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    from simconsole.cli import doctor
    from simconsole.cli.outcome import Outcome

    def chatty(options: object) -> Outcome:
        sys.stdout.write("a library talks\n")
        return Outcome(0, {"good": True}, "all is well")

    monkeypatch.setattr(doctor, "doctor", chatty)
    assert main(["doctor", "--json"]) == 0
    said = capfd.readouterr()
    assert (said.out, said.err) == ('{"good":true}\n', "a library talks\nall is well\n")
    assert main(["doctor"]) == 0
    assert capfd.readouterr().out == "a library talks\nall is well\n"
    assert main(["doctor", "--quiet"]) == 0
    assert main(["doctor", "--quiet", "--json"]) == 0
    said = capfd.readouterr()
    assert (said.out, said.err) == ('{"good":true}\n', "")
