"""The programs' words, and what a user can do wrong."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.drivers.robots.nodes import navigation_node, program, slam_node
from simconsole.values.errors import ProfileError
from simconsole.world.arena.occupancy import OCCUPIED, Grid
from simconsole.world.tools.ros_maps import read_ros_map

NOWHERE = ("--url", "ws://127.0.0.1:9", "--wait", "0.1")


@pytest.mark.parametrize("name", ["slam", "navigate"])
def test_without_a_server_one_line_says_so(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert program.main([name, *NOWHERE]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith(f"{name}: ws://127.0.0.1:9: cannot connect")
    assert len(told.err.splitlines()) == 1


@pytest.mark.parametrize("words", [("--robot", "hatchback"), ("--robot", "none"), ("--arena", "urban")])
def test_what_is_no_robot_or_no_arena_is_refused(words: tuple[str, str], capsys: pytest.CaptureFixture[str]) -> None:
    assert program.main(["navigate", *words, *NOWHERE]) == ProfileError.exit_code
    assert words[1] in capsys.readouterr().err


@pytest.mark.parametrize("text", ["1,2", "a,b,c", "1,2,nan"])
def test_a_start_is_three_numbers(text: str) -> None:
    with pytest.raises(SystemExit):
        program.main(["slam", "--start", text])


def test_the_map_is_saved_as_map_server_reads_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    cells = np.zeros((20, 30), dtype=np.int8)
    cells[[0, -1], :] = OCCUPIED
    told: dict[str, Any] = {}

    def run(url: str, start: Any, **words: Any) -> slam_node.Mapped:
        told.update(words, start=start)
        return slam_node.Mapped([], Grid(cells, 0.05, -0.5, 0.25), "stopped")

    monkeypatch.setattr(slam_node, "run", run)
    assert program.main(["slam", "--start", "0.8,0.8,90", "--namespace", "/tb3_0", "--out", str(tmp_path)]) == 0
    assert told["start"] == pytest.approx((0.8, 0.8, 0.5 * math.pi))
    assert told["namespace"] == "/tb3_0"
    assert json.loads(capsys.readouterr().out)["map"] == str(tmp_path / "map.yaml")
    assert len(read_ros_map(tmp_path / "map.yaml", "mapped").walls) >= 2


def test_a_mission_has_the_targets_of_its_arena(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    told: list[Any] = []

    def run(url: str, navigator: Any, mission: Any, **words: Any) -> navigation_node.Navigated:
        told.append((mission, words))
        return navigation_node.Navigated([], 0.0, None, 0, "stopped")

    monkeypatch.setattr(navigation_node, "run", run)
    assert program.main(["navigate", "--arena", "arena", "--lockstep"]) == 0
    assert program.main(["navigate"]) == 0
    assert told[0][0] is not None
    assert told[0][1]["lockstep"]
    assert told[1][0] is None
    assert [target.name for target in program.targets_of("arena")] == ["A", "B", "C", "D", "E"]
    assert json.loads(capsys.readouterr().out.splitlines()[-1])["ended"] == "stopped"
