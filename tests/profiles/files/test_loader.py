"""Finding and reading profiles: shipped ones by name, the user's own by path."""

from pathlib import Path
from typing import Annotated

import msgspec
import pytest

from simconsole.profiles.files import loader as profile_files
from simconsole.values.errors import ProfileError


class Tyre(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    friction: Annotated[float, msgspec.Meta(ge=0.05, le=1.5)] = 0.9


@pytest.fixture
def shipped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "profiles"
    (folder / "vehicles").mkdir(parents=True)
    (folder / "vehicles" / "dry.yaml").write_text("friction: 1.0\n")
    (folder / "vehicles" / "wet.yaml").write_text("friction: 0.5\n")
    (folder / "vehicles" / "points.csv").write_text("x_m,y_m\n0,0\n")
    monkeypatch.setattr(profile_files, "profiles_folder", lambda: folder)
    return folder


def test_bare_name_is_a_shipped_profile(shipped: Path) -> None:
    assert profile_files.find("vehicles", "wet") == shipped / "vehicles" / "wet.yaml"
    assert profile_files.load("vehicles", "wet", Tyre) == Tyre(friction=0.5)
    assert profile_files.names("vehicles") == ["dry", "wet"]


def test_path_is_the_users_own_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mine.yaml").write_text("friction: 0.7\n")
    monkeypatch.chdir(tmp_path)
    for path in ("mine.yaml", "./mine.yaml", str(tmp_path / "mine.yaml")):
        assert profile_files.load("vehicles", path, Tyre) == Tyre(friction=0.7)


def test_json_is_read_too(tmp_path: Path) -> None:
    (tmp_path / "mine.json").write_text(profile_files.to_text(Tyre(friction=0.25)))
    assert profile_files.load("vehicles", str(tmp_path / "mine.json"), Tyre) == Tyre(friction=0.25)


def test_reference_inside_a_profile(shipped: Path, tmp_path: Path) -> None:
    session = tmp_path / "own" / "session.yaml"
    (session.parent / "cars").mkdir(parents=True)
    (session.parent / "cars" / "mine.yaml").write_text("friction: 0.3\n")
    assert profile_files.load("vehicles", "cars/mine.yaml", Tyre, referrer=session) == Tyre(friction=0.3)
    assert profile_files.load("vehicles", "dry", Tyre, referrer=session) == Tyre(friction=1.0)


def test_unknown_name_lists_the_known_ones(shipped: Path) -> None:
    with pytest.raises(ProfileError) as caught:
        profile_files.find("vehicles", "dyr")
    assert (
        str(caught.value)
        == "command line: vehicles profile: value 'dyr': did you mean dry? one of dry, wet, or a path to a .yaml file"
    )


def test_data_beside_profiles(shipped: Path) -> None:
    assert profile_files.read_text("vehicles", "points.csv") == "x_m,y_m\n0,0\n"
    for name in ("../vehicles/points.csv", "/etc/hostname", "none.csv", ".csv", "p\0.csv"):
        with pytest.raises(ProfileError, match="a file that simconsole ships"):
            profile_files.read_text("vehicles", name)


def test_byte_order_mark_is_skipped(tmp_path: Path) -> None:
    (tmp_path / "windows.yaml").write_bytes(b"\xef\xbb\xbffriction: 0.7\r\n")
    assert profile_files.load("vehicles", str(tmp_path / "windows.yaml"), Tyre) == Tyre(friction=0.7)


def test_file_that_is_not_text(tmp_path: Path) -> None:
    path = tmp_path / "image.yaml"
    path.write_bytes(b"friction: \xff\xfe")
    with pytest.raises(ProfileError, match=r"image\.yaml: file: value not UTF-8 at byte 10: UTF-8 text$"):
        profile_files.load("vehicles", str(path), Tyre)


def test_shipped_profiles_exist_in_every_kind() -> None:
    assert profile_files.profiles_folder().is_dir()
    for kind in ("devices", "vehicles", "worlds", "sessions", "scenarios"):
        assert profile_files.names(kind), kind
