"""`simconsole can`: its results, and what a user can do wrong: one line and code 2."""

import json
from pathlib import Path

import pytest

from simconsole.canbus.bus.port import open_logs, read_log
from simconsole.cli.main import main

VIRTUAL = ("--interface", "virtual", "--channel", "commands", "--json")


def run(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, dict[str, object], str]:
    code = main(["can", *words, *VIRTUAL])
    captured = capsys.readouterr()
    return code, json.loads(captured.out.splitlines()[-1]), captured.err


def test_send_alone_on_a_bus(capsys: pytest.CaptureFixture[str]) -> None:
    code, results, _ = run(capsys, "send", "--for", "0.1", "--accel", "1")
    assert code == 0
    assert (results["sent"], results["heard"], results["modes"]) == (5, 0, [])


def test_monitor_of_a_silent_bus_has_code_1(capsys: pytest.CaptureFixture[str]) -> None:
    code, results, _ = run(capsys, "monitor", "--for", "0.1")
    assert (code, results["messages"]) == (1, {})


def test_replay_of_an_empty_log_sends_nothing(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "empty.blf"
    for writer in open_logs([path]):
        writer.stop()
    assert read_log(path) == []
    code, results, _ = run(capsys, "replay", "--file", str(path))
    assert (code, results["sent"]) == (0, 0)


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("replay", "--file", "no.blf"), r"no.blf: not a CAN log"),
        (("replay", "--file", "no.txt"), r"no.txt: not a CAN log"),
        (("replay", "--file", "no.blf", "--speed", "0"), "--speed: value 0: 0.01 to 100"),
        (("send", "--road-wheel-deg", "80"), "ECU_COMMAND.ROAD_WHEEL"),
        (("send", "--accel", "nan"), "ECU_COMMAND.ACCEL"),
        (("monitor", "--bitrate", "5"), "bitrate_bps"),
        (("monitor", "--port", "80"), "port"),
        (("monitor", "--file", "/nowhere/x.blf"), "/nowhere/x.blf: cannot be written"),
    ],
)
def test_mistakes_are_one_line(capsys: pytest.CaptureFixture[str], words: tuple[str, ...], complaint: str) -> None:
    code, results, err = run(capsys, *words)
    assert code == 2
    assert complaint in err
    assert err.count("\n") == 1
    assert complaint in str(results["error"])


def test_unknown_interface_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["can", "monitor", "--interface", "smoke"]) == 2
    assert "smoke" in capsys.readouterr().err
