import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.definition import HEADER, Definition, parse
from simconsole.bridge.messages.definition_text import ROS1_HEADER, full_text, text_of

REGISTRY = standard_registry()


def shape(definition: Definition) -> list[tuple[str, str, str]]:
    return [(field.name, field.type.base, field.type.array) for field in definition.fields]


@pytest.mark.parametrize("name", REGISTRY.names())
def test_text_reads_back_as_the_same(name: str) -> None:
    definition = REGISTRY.definition(name)
    assert shape(parse(name, text_of(definition))) == shape(definition)
    assert text_of(parse(name, text_of(definition))) == text_of(definition)


def test_defaults_and_bounds_are_written_for_ros2_only() -> None:
    text = 'bool on true\nstring<=5 word "a"\nint32[<=3] few [1, 2]\nfloat32[2] two\ntime when\nuint8 ONE=1\n'
    definition = parse("demo_msgs/Demo", text)
    assert text_of(definition).splitlines() == [
        "uint8 ONE=1",
        "bool on true",
        'string<=5 word "a"',
        "int32[<=3] few [1,2]",
        "float32[2] two",
        "builtin_interfaces/Time when",
    ]
    old = text_of(definition, ros1=True).splitlines()
    assert old[1:] == ["bool on", "string word", "int32[] few", "float32[2] two", "time when"]


def test_header_of_ros1_has_its_sequence_number() -> None:
    assert text_of(REGISTRY.definition(HEADER), ros1=True) == ROS1_HEADER


def test_full_text_names_what_the_first_uses() -> None:
    text = full_text([REGISTRY.definition("geometry_msgs/PointStamped"), REGISTRY.definition("geometry_msgs/Point")])
    assert text.startswith("std_msgs/Header header\ngeometry_msgs/Point point\n====")
    assert "MSG: geometry_msgs/Point\nfloat64 x\n" in text
