"""Which bundles `simconsole replay` takes: those that are named, else the newest below out."""

import json
import os
import shutil
from pathlib import Path

import pytest

from simconsole.cli.lookup.bundles import newest_bundle
from simconsole.cli.main import main
from simconsole.values.errors import RecordingError


def bundle(folder: Path, began_s: int) -> Path:
    folder.mkdir(parents=True)
    for name in ("manifest.json", "session.json"):
        (folder / name).touch()
    os.utime(folder / "session.json", (began_s, began_s))
    return folder


def test_the_newest_is_the_one_that_began_last_however_deep(tmp_path: Path) -> None:
    older = bundle(tmp_path / "demo-2", 1000)
    assert newest_bundle(tmp_path) == older
    newer = bundle(tmp_path / "turtlebot-1" / "bundle", 2000)
    bundle(newer / "robot_2", 3000)
    (tmp_path / "sweep").mkdir()
    os.utime(older / "manifest.json", (9000, 9000))  # packed or signed since
    assert newest_bundle(tmp_path) == newer
    bundle(older / "robot_2", 4000)
    assert newest_bundle(tmp_path) == newer, "a platform's bundle is part of another"


def test_without_any_it_says_how_to_make_one(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="no bundle below it: name one, or drive first: simconsole demo"):
        newest_bundle(tmp_path / "out")


def test_replay_takes_the_newest_or_all_that_are_named(
    short: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    others = shutil.ignore_patterns("scene.rrd*", "report.html*")  # tests beside this one write them anew
    for name in ("drive-1", "drive-2"):
        shutil.copytree(short, tmp_path / "out" / name, ignore=others)
    monkeypatch.chdir(tmp_path)
    os.utime("out/drive-1/session.json", (1, 1))
    assert main(["replay"]) == 0
    assert capsys.readouterr().out.startswith("out/drive-2: 750 ticks replayed, every hash equal")
    assert main(["replay", "out/drive-1", "out/drive-2", "out/drive-3", "--json"]) == 2
    found = json.loads(capsys.readouterr().out.splitlines()[-1])["bundles"]
    assert [found[f"out/drive-{number}"].get("hashes_equal") for number in (1, 2, 3)] == [True, True, None]
    assert "out/drive-3" in found["out/drive-3"]["error"]


def test_only_one_is_driven_again_with_a_value_changed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replay", "a", "b", "--set", "body.mass_kg=1600"]) == 2
    assert "--set: value of 2 bundles: of one bundle" in capsys.readouterr().err
