import pytest

from simconsole.bridge.messages.definition import full_name, parse, parse_all
from simconsole.values.errors import BridgeError


def test_fields_keep_order_type_and_default() -> None:
    definition = parse("demo/Thing", "float64 w 1\nint32[] counts [1, 2]\nOther[3] parts\nstring<=4 name 'abc' # x\n")
    assert definition.name == "demo/msg/Thing"
    assert [field.name for field in definition.fields] == ["w", "counts", "parts", "name"]
    w, counts, parts, name = definition.fields
    assert (w.type.base, w.default) == ("float64", 1.0)
    assert (counts.type.array, counts.default) == ("unbounded", [1, 2])
    assert (parts.type.base, parts.type.array, parts.type.size) == ("demo/msg/Other", "fixed", 3)
    assert (name.type.string_limit, name.default) == (4, "abc")


def test_bounded_array_differs_from_fixed() -> None:
    bounded, fixed = parse("demo/A", "uint8[<=3] a\nuint8[3] b").fields
    assert (bounded.type.array, fixed.type.array) == ("bounded", "fixed")
    assert bounded.type.is_octets
    assert fixed.type.is_octets


def test_constants_of_every_kind() -> None:
    text = "uint8 A=1\nint8 B = -0x2 # two\nfloat32 C = 1.5\nbool D=True\nstring E= with # inside\nstring F='q' # no\n"
    assert parse("demo/A", text).constants == {
        "A": 1, "B": -2, "C": 1.5, "D": True, "E": "with # inside", "F": "q",
    }  # fmt: skip


def test_ros1_short_names() -> None:
    header, stamp, wait = parse("demo/A", "Header header\ntime stamp\nduration wait").fields
    assert header.type.base == "std_msgs/msg/Header"
    assert stamp.type.base == "builtin_interfaces/msg/Time"
    assert wait.type.base == "builtin_interfaces/msg/Duration"


def test_two_and_three_part_names_are_one() -> None:
    assert full_name("std_msgs/String") == full_name("std_msgs/msg/String") == "std_msgs/msg/String"


@pytest.mark.parametrize("name", ["", "String", "a/b/c", "a/msg/b/c", "../x/y", "a/ b", "1a/B", "x" * 300])
def test_what_is_no_type_name(name: str) -> None:
    with pytest.raises(BridgeError, match="not a message type name"):
        full_name(name)


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("what is this", "not a message type|not a field|no default|cannot"),
        ("float64", "not a field"),
        ("float64 x\nfloat64 x", "given twice"),
        ("uint8 X=256", "not between 0 and 255"),
        ("int8 X=-129", "not between"),
        ("bool X=maybe", "not a bool"),
        ("bool X=False\nbool Y=2", "not a bool"),
        ("Other X=1", "primitive"),
        ("Other x 1", "cannot have a default"),
        ("int32[] x 1", "must be a list"),
        ("int32[] x {1", "must be a list"),
        ("float64 x abc", "could not convert"),
    ],
)
def test_bad_line_is_named(line: str, complaint: str) -> None:
    with pytest.raises(BridgeError, match=complaint) as caught:
        parse("demo/A", f"# fine\n{line}\n")
    assert str(caught.value).startswith("demo/msg/A: line ")


def test_several_messages_in_one_text() -> None:
    names = [definition.name for definition in parse_all("MSG: a/B\nC c\n====\nMSG: a/msg/C\nfloat64 x\n===\n")]
    assert names == ["a/msg/B", "a/msg/C"]


def test_part_without_a_name_is_refused() -> None:
    with pytest.raises(BridgeError, match="expected 'MSG"):
        parse_all("float64 x\n===\nMSG: a/B\n")
