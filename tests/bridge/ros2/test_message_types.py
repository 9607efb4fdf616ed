"""Types of an installed ROS 2, by generated classes made by hand."""

import sys
from types import ModuleType
from typing import Any

import pytest

from simconsole.bridge.ros2.message_types import describe, load


def made(**fields: str) -> Any:
    """A class as rosidl generates them."""
    return type("Made", (), {"get_fields_and_field_types": classmethod(lambda cls: fields)})


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch) -> None:
    point = made(x="double", y="double")
    reached = made(at="made_msgs/Point", path="sequence<made_msgs/Point>")
    classes = {
        "made_msgs.msg": {"Point": point, "Reached": reached},
        "made_msgs.srv": {"Ask": type("Ask", (), {"Request": made(why="string"), "Response": reached})},
        "made_msgs.action": {"Go": type("Go", (), {"Goal": point, "Result": made(), "Feedback": point})},
    }
    monkeypatch.setitem(sys.modules, "made_msgs", ModuleType("made_msgs"))
    for name, found in classes.items():
        module = ModuleType(name)
        vars(module).update(found)
        monkeypatch.setitem(sys.modules, name, module)


@pytest.mark.usefixtures("installed")
def test_message_is_described_with_all_that_it_is_made_of_once_each() -> None:
    found = describe("made_msgs/msg/Reached")
    assert found is not None
    assert [definition.name for definition in found] == ["made_msgs/msg/Reached", "made_msgs/msg/Point"]
    assert [field.name for field in found[1].fields] == ["x", "y"]


@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize(
    ("kind", "names"),
    [
        ("srv/Ask", {"Ask_Request", "Ask_Response", "Point"}),
        ("action/Go", {"Go_Goal", "Go_Result", "Go_Feedback"}),
    ],
)
def test_service_and_action_are_described_part_by_part(kind: str, names: set[str]) -> None:
    found = describe(f"made_msgs/{kind}")
    assert found is not None
    assert {definition.name.rpartition("/")[2] for definition in found} == names


@pytest.mark.usefixtures("installed")
def test_what_is_not_installed_is_none() -> None:
    for name in ("made_msgs/msg/Other", "made_msgs/none/Point", "other_msgs/msg/Point"):
        assert load(name) is None
        assert describe(name) is None


@pytest.mark.parametrize(
    "name", ["a/b/c/d", "a", "", "os/srv/Path", "json/msg/Tool", "made_msgs/msg/__doc__", "this/msg/Poem"]
)
def test_nothing_but_interfaces_is_imported_whatever_a_client_names(name: str) -> None:
    sys.modules.pop("this", None)
    assert load(name) is None
    assert "this" not in sys.modules
