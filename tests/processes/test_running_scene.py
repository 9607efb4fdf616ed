"""A viewer finds the drives that go on, and no others."""

from pathlib import Path

import pytest

from simconsole.processes import running_scene
from simconsole.processes.running_scene import name_scene, newest_scene, running_scenes, scene_of
from simconsole.processes.shared_memory import make_run_folder, remove_run_folder
from simconsole.values.errors import WorkerError


def test_a_drive_is_found_by_its_bundle_until_it_ends(tmp_path: Path) -> None:
    folders = [make_run_folder() for _ in range(3)]
    try:
        for folder, bundle in zip(folders, ("one", "two"), strict=False):
            name_scene(folder, tmp_path / bundle / "scene.live.rrd")
        found = scene_of(tmp_path / "one")
        assert found is not None
        assert found == (folders[0], tmp_path / "one" / "scene.live.rrd")
        assert found.goes_on
        assert folders[2] not in [scene.folder for scene in running_scenes()], "it keeps no scene"
        assert scene_of(tmp_path / "three") is None
        remove_run_folder(folders[0])
        assert not found.goes_on
        assert scene_of(tmp_path / "one") is None
        assert scene_of(tmp_path / "two") is not None
    finally:
        for folder in folders:
            remove_run_folder(folder)


def test_without_a_drive_one_line_says_what_would_help(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running_scene, "run_folders", list)
    with pytest.raises(WorkerError, match=r"no drive with a scene goes on here.*simconsole view BUNDLE"):
        newest_scene()


def test_the_newest_is_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import os

    for name, written_s in (("b", 200.0), ("a", 300.0), ("c", 100.0)):
        (tmp_path / name).mkdir()
        name_scene(tmp_path / name, tmp_path / name / "scene.live.rrd")
        os.utime(tmp_path / name / "scene.path", (written_s, written_s))
    monkeypatch.setattr(running_scene, "run_folders", lambda: [tmp_path / name for name in "abc"])
    assert newest_scene().folder == tmp_path / "a"
