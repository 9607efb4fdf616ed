import gzip
from pathlib import Path

import pytest

from simconsole.profiles.files.world_files import MAX_MAP_BYTES, enclosed, load_world, located, read_map, with_kind
from simconsole.profiles.world import CourseProfile, MapFile, RoadsProfile
from simconsole.values.errors import ProfileError

HEAD = "schema: 1\nkind: roads\ntitle: t\nroute: {by: random, seed: 1}\n"


def written(folder: Path, name: str = "m.net.xml", content: bytes = b"<net/>") -> RoadsProfile:
    (folder / "m.net.xml").write_bytes(content)
    (folder / "w.yaml").write_text(f"{HEAD}map: {{name: {name}}}\n")
    profile = load_world(str(folder / "w.yaml"))
    assert isinstance(profile, RoadsProfile)
    return profile


def test_worlds_from_before_there_were_kinds_are_courses() -> None:
    assert isinstance(load_world("urban"), CourseProfile)
    assert with_kind({"schema": 1}) == {"schema": 1, "kind": "course"}
    assert with_kind([1]) == [1]


def test_unknown_kinds_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "w.yaml"
    path.write_text(HEAD.replace("roads", "sea"))
    with pytest.raises(ProfileError, match='kind: value "sea"'):
        load_world(str(path))


def test_map_is_named_with_its_hash_and_read_back(tmp_path: Path) -> None:
    profile = written(tmp_path)
    assert profile.map.name == str(tmp_path / "m.net.xml")
    assert read_map(profile.map) == b"<net/>"
    (tmp_path / "m.net.xml").write_bytes(gzip.compress(b"<net/>"))
    assert read_map(profile.map) == b"<net/>"


@pytest.mark.parametrize("name", ["../m.net.xml", "/etc/passwd.xml", "none.net.xml", "m.net.txt"])
def test_map_outside_the_folder_or_missing_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / "inner").mkdir()
    (tmp_path / "m.net.xml").write_bytes(b"<net/>")
    with pytest.raises(ProfileError):
        written(tmp_path / "inner", name)


def test_bomb_of_gzip_is_refused(tmp_path: Path) -> None:
    bomb = gzip.compress(b"\0" * (MAX_MAP_BYTES + 1))
    assert len(bomb) < 100_000
    with pytest.raises(ProfileError, match=f"value larger than {MAX_MAP_BYTES} bytes"):
        written(tmp_path, content=bomb)
    with pytest.raises(ProfileError, match="value cut off"):
        written(tmp_path, content=gzip.compress(b"<net/>")[:-4])
    with pytest.raises(ProfileError, match="value not gzip"):
        written(tmp_path, content=b"\x1f\x8bnot at all")


def test_recorded_world_names_files_beside_it(tmp_path: Path) -> None:
    recorded, files = enclosed(written(tmp_path))
    assert isinstance(recorded, RoadsProfile)
    ((name, content),) = files.items()
    assert recorded.map.name == name
    assert gzip.decompress(content) == b"<net/>"
    assert enclosed(written(tmp_path))[1] == files
    (tmp_path / "bundle").mkdir()
    (tmp_path / "bundle" / name).write_bytes(content)
    found = located(recorded, tmp_path / "bundle")
    assert isinstance(found, RoadsProfile)
    assert read_map(found.map) == b"<net/>"


def test_recorded_name_leads_nowhere_else(tmp_path: Path) -> None:
    recorded, _ = enclosed(written(tmp_path))
    assert isinstance(recorded, RoadsProfile)
    outside = RoadsProfile(schema=1, title="", map=MapFile(name="../../etc/x.xml"), route=recorded.route)
    found = located(outside, tmp_path)
    assert isinstance(found, RoadsProfile)
    assert found.map.name == str(tmp_path / "x.xml")


def test_courses_need_no_files(tmp_path: Path) -> None:
    course = load_world("urban")
    assert enclosed(course) == (course, {})
    assert located(course, tmp_path) is course
