from pathlib import Path

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.standard_types import DEFINITIONS, definition_files

PARTS = {"msg": ("",), "srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}


def test_each_shipped_file_is_a_type_and_each_type_has_a_file() -> None:
    shipped = [path for path in DEFINITIONS.rglob("*") if path.is_file()]
    assert sorted(shipped) == definition_files(DEFINITIONS)
    names = [f"{path.parent.parent.name}/msg/{path.stem}{part}" for path in shipped for part in PARTS[path.parent.name]]
    assert tuple(sorted(names)) == standard_registry().names()


def test_registries_do_not_share_what_is_added() -> None:
    first, second = standard_registry(), standard_registry()
    first.add("own_msgs/One", "float64 one")
    assert "own_msgs/msg/One" not in second.names()


def test_only_files_laid_out_as_ros_packages_are_found(tmp_path: Path) -> None:
    for name in ("b/msg/B.msg", "a/srv/A.srv", "a/msg/A.msg", "a/msg/A.srv", "a/A.msg", "a/msg/more/A.msg", "A.msg"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    found = [path.relative_to(tmp_path).as_posix() for path in definition_files(tmp_path)]
    assert found == ["a/msg/A.msg", "a/srv/A.srv", "b/msg/B.msg"]
