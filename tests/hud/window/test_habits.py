"""How a window was left is remembered for its profile; no state file can do harm."""

from pathlib import Path

import pytest
from msgspec.structs import replace

from simconsole.hud.window.habits import STATE_FILE, Habits, HabitsFile, habits_of, state_folder
from simconsole.profiles.view import HudProfile

PROFILE = HudProfile(display=1)
LEFT = Habits(display=2, fullscreen=True, vsync=False, size_px=(800, 600))


def test_the_profile_says_how_a_window_first_opens(tmp_path: Path) -> None:
    profile = HudProfile(display=3, fullscreen=True, vsync=False)
    assert HabitsFile(tmp_path / "none.json").load(profile) == Habits(display=3, fullscreen=True, vsync=False)


def test_what_was_changed_is_there_the_next_time(tmp_path: Path) -> None:
    HabitsFile(tmp_path / STATE_FILE).save(PROFILE, LEFT)
    assert HabitsFile(tmp_path / STATE_FILE).load(PROFILE) == LEFT
    assert [path.name for path in (tmp_path / STATE_FILE).parent.iterdir()] == ["window.json"]


@pytest.mark.parametrize("changed", [{"display": 0}, {"fullscreen": True}, {"vsync": False}, {"width_px": 1280}])
def test_a_profile_that_has_changed_since_wins(changed: dict[str, int], tmp_path: Path) -> None:
    memory = HabitsFile(tmp_path / "window.json")
    memory.save(PROFILE, LEFT)
    other = replace(PROFILE, **changed)
    assert memory.load(other) == habits_of(other)


@pytest.mark.parametrize("content", ["", "{}", "[1]", '{"profile": "x", "habits": {"display": -1}}', "\x00"])
def test_a_broken_state_file_is_as_none(content: str, tmp_path: Path) -> None:
    path = tmp_path / "window.json"
    path.write_text(content)
    assert HabitsFile(path).load(PROFILE) == habits_of(PROFILE)


def test_a_folder_that_cannot_be_written_is_told_and_nothing_else(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "simconsole").write_text("a file")
    HabitsFile(tmp_path / STATE_FILE).save(PROFILE, LEFT)
    assert "window.json: not remembered" in capsys.readouterr().err


def test_state_is_kept_where_the_desktop_keeps_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert state_folder() == tmp_path
    monkeypatch.delenv("XDG_STATE_HOME")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert state_folder() == tmp_path / ".local" / "state"
