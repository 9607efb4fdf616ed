from pathlib import Path

import pytest

from tests.drives.console import results, simconsole, within
from tests.world.nets import STRAIGHT
from tests.world.sumo.test_netconvert import OSM


def test_list_names_every_world_with_its_kind() -> None:
    done = simconsole("world", "list", "--json")
    kinds = {one["name"]: one["kind"] for one in results(done)["worlds"]}
    assert kinds["urban"] == "course"
    assert kinds["urban_signals"] == kinds["motorway"] == kinds["country"] == kinds["skid_pad"] == "roads"
    assert "Urban course" in done.stderr


def test_show_says_what_a_world_holds() -> None:
    found = results(within("world", "show", "urban_signals", "--json"))
    assert found["counts"]["roundabouts"] == 1
    assert found["not_read"] == []
    assert found["along the route"] == "1 roundabout, 1 traffic lights, 6 crossing"
    assert results(within("world", "show", "urban", "--json"))["length_m"] == 2600.0


def test_show_of_a_map_says_what_was_not_read(tmp_path: Path) -> None:
    path = tmp_path / "m.net.xml"
    path.write_text(STRAIGHT.replace("</net>", "<odd/></net>"))
    done = within("world", "show", str(path))
    assert done.returncode == 0
    assert "  not read: line 17: <odd>: not an element that is read" in done.stdout


def test_import_writes_a_world_that_can_be_shown(tmp_path: Path) -> None:
    source = tmp_path / "vienna.osm"
    source.write_bytes(OSM)
    done = within("world", "import", str(source), "--out", str(tmp_path / "new"))
    assert done.returncode == 0
    assert "  lost: " in done.stdout
    assert within("world", "show", str(tmp_path / "new" / "vienna.yaml")).returncode == 0
    again = within("world", "import", str(source), "--out", str(tmp_path / "new"))
    assert again.returncode == 2
    assert "value taken" in again.stderr


@pytest.mark.parametrize("words", [("show", "none"), ("import", "none.osm"), ("show", "x.net.xml")])
def test_what_cannot_be_shown_is_one_line(words: tuple[str, ...]) -> None:
    done = within("world", *words)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1


def test_an_arena_is_exported_as_a_ros_map_and_imported_again(tmp_path: Path) -> None:
    done = within("world", "export", "arena", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "arena.pgm").stat().st_size > 20_000
    done = within("world", "import", str(tmp_path / "arena.yaml"), "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert "9.05 x 6.05 m" in done.stdout
    again = within("world", "import", str(tmp_path / "arena.yaml"), "--out", str(tmp_path))
    assert again.returncode == 2
    assert "taken" in again.stderr
    shown = within("world", "show", "arena")
    assert "9.00 x 6.00 m" in shown.stdout
    assert "A B C D E" in shown.stdout


@pytest.mark.parametrize(("words", "told"), [(("urban",), "kind: value course"), (("arena", "--resolution", "9"), "9")])
def test_what_is_no_arena_is_not_exported(words: tuple[str, ...], told: str, tmp_path: Path) -> None:
    done = within("world", "export", *words, "--out", str(tmp_path))
    assert done.returncode == 2
    assert told in done.stderr
