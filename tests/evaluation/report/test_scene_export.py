"""The process that writes a scene: what ends it, and what it leaves."""

import shutil
from pathlib import Path

import pytest

from simconsole.evaluation.report.scene_export import SCENE, main, scene_process
from simconsole.values.errors import WorkerError
from tests.drives.console import Running
from tests.drives.fixtures import Demo
from tests.drives.private_memory import children, private
from tests.patience import wait_until

DRAFT = f"{SCENE}.new"


@pytest.fixture
def bare(short: Path, tmp_path: Path) -> Path:
    """A bundle without a scene."""
    folder = Path(shutil.copytree(short, tmp_path / "bare"))
    (folder / SCENE).unlink()
    return folder


def test_a_scene_is_whole_when_it_was_waited_for(bare: Path) -> None:
    told: list[float] = []
    with scene_process(bare, told.append) as wait:
        wait()
    assert told[-1] == 1.0
    assert (bare / SCENE).stat().st_size > 1000
    assert not (bare / DRAFT).exists()


def test_one_to_which_nothing_is_added_is_ended(bare: Path) -> None:
    with (
        pytest.raises(WorkerError, match=r"scene\.rrd: the scene was not written: nothing was added to it for 0 s"),
        scene_process(bare, lambda share: None, stall_s=0.0) as wait,
    ):
        wait()
    assert not (bare / SCENE).exists()
    assert not (bare / DRAFT).exists()


def test_one_that_nobody_waits_for_is_ended(bare: Path) -> None:
    with pytest.raises(ZeroDivisionError), scene_process(bare, lambda share: None):
        raise ZeroDivisionError
    assert not (bare / SCENE).exists()
    assert not (bare / DRAFT).exists()


def test_an_interrupt_ends_it_at_once_and_leaves_nothing_half_made(demo: Demo, tmp_path: Path) -> None:
    bundle = Path(shutil.copytree(demo.bundle, tmp_path / "bundle", ignore=shutil.ignore_patterns("scene.rrd")))
    before = {path.name: path.read_bytes() for path in bundle.iterdir()}
    with Running(tmp_path / "said", "view", "--no-open", bundle) as running:
        wait_until((bundle / DRAFT).exists, "the scene begins")
        (scene,) = children(running.process.pid)
        running.interrupt_group()
        assert running.end().returncode == 130
    wait_until(lambda: not private(scene).all, "the scene's process is gone")
    assert {path.name: path.read_bytes() for path in bundle.iterdir()} == before


def test_what_is_no_bundle_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert str(tmp_path) in said
    assert said.count("\n") == 1
    assert main([]) == 2
    assert "usage" in capsys.readouterr().err
