import pytest

from simconsole.bridge.messages import Definition, standard_registry
from simconsole.bridge.messages.definition import FieldType
from simconsole.bridge.messages.rosidl_types import definition_of, field_type, is_same_layout
from simconsole.values.errors import BridgeError


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("double", FieldType("float64", "", 0, 0)),
        ("float", FieldType("float32", "", 0, 0)),
        ("boolean", FieldType("bool", "", 0, 0)),
        ("octet", FieldType("byte", "", 0, 0)),
        ("int8", FieldType("int8", "", 0, 0)),
        ("string", FieldType("string", "", 0, 0)),
        ("string<10>", FieldType("string", "", 0, 10)),
        ("double[36]", FieldType("float64", "fixed", 36, 0)),
        ("sequence<uint8>", FieldType("uint8", "unbounded", 0, 0)),
        ("sequence<double, 3>", FieldType("float64", "bounded", 3, 0)),
        ("sequence<string<4>>", FieldType("string", "unbounded", 0, 4)),
        ("sequence<string<4>, 3>", FieldType("string", "bounded", 3, 4)),
        ("string<4>[2]", FieldType("string", "fixed", 2, 4)),
        ("geometry_msgs/Point", FieldType("geometry_msgs/msg/Point", "", 0, 0)),
        ("sequence<geometry_msgs/Point>", FieldType("geometry_msgs/msg/Point", "unbounded", 0, 0)),
    ],
)
def test_spelled_types(text: str, expected: FieldType) -> None:
    assert field_type(text) == expected


def test_other_words_are_refused() -> None:
    with pytest.raises(BridgeError, match="'set<int8>' is not a type as rosidl spells it"):
        field_type("set<int8>")


def test_an_odometry_is_the_one_known_here() -> None:
    spelled = {
        "header": "std_msgs/Header",
        "child_frame_id": "string",
        "pose": "geometry_msgs/PoseWithCovariance",
        "twist": "geometry_msgs/TwistWithCovariance",
    }
    registry = standard_registry()
    found = definition_of("nav_msgs/msg/Odometry", spelled)
    assert is_same_layout(found, registry.definition("nav_msgs/Odometry"))
    assert not is_same_layout(found, registry.definition("nav_msgs/Path"))
    assert definition_of("std_msgs/msg/Empty", {}) == Definition("std_msgs/msg/Empty", (), {})


def test_the_names_of_an_octet_are_one_layout() -> None:
    registry = standard_registry()
    for name in ("Byte", "Char"):
        known = registry.definition(f"std_msgs/{name}")
        assert is_same_layout(definition_of(known.name, {"data": "uint8"}), known)
    assert not is_same_layout(definition_of("x", {"data": "int8"}), registry.definition("std_msgs/Byte"))
