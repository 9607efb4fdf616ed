"""Read `.msg` text: the ROS interface definition language, both dialects, into plain values.

A text may hold several messages, each after a line `MSG: package/Name`, separated by lines of `=`: the form in which
ROS 1 and rosbag write a type together with its dependencies, and in which this package keeps its own.
"""

import re
from typing import Any, Final, Literal, NamedTuple

import orjson

from simconsole.values.errors import BridgeError

Primitive = Literal["bool", "integer", "float", "string", "bytes"]

INTEGER_RANGES: Final[dict[str, tuple[int, int]]] = {
    "byte": (0, 255),
    "char": (0, 255),
    "int8": (-128, 127),
    "uint8": (0, 255),
    "int16": (-(2**15), 2**15 - 1),
    "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
    "uint64": (0, 2**64 - 1),
}
FLOATS: Final = frozenset({"float32", "float64"})
STRINGS: Final = frozenset({"string", "wstring"})
OCTETS: Final = frozenset({"uint8", "byte", "char"})
PRIMITIVES: Final = frozenset({"bool", *INTEGER_RANGES, *FLOATS, *STRINGS})

TIME: Final = "builtin_interfaces/msg/Time"
DURATION: Final = "builtin_interfaces/msg/Duration"
HEADER: Final = "std_msgs/msg/Header"
_SHORT_NAMES: Final = {"time": TIME, "duration": DURATION, "Header": HEADER}

_FIELD = re.compile(
    r"(?P<base>[A-Za-z][\w/]*)(?:<=(?P<limit>\d+))?(?P<array>\[(?P<bounded><=)?(?P<size>\d*)\])?"
    r"\s+(?P<name>[A-Za-z]\w*)\s*(?P<rest>.*)"
)
_TYPE_NAME = re.compile(r"[A-Za-z]\w*/(?:msg/)?[A-Za-z]\w*")
_SEPARATOR = re.compile(r"^=+$", re.MULTILINE)


class FieldType(NamedTuple):
    """The type of one field; `size` is the length of a fixed array or the bound of a bounded one, 0 without."""

    base: str  # a primitive, or a full message name
    array: Literal["", "fixed", "bounded", "unbounded"]
    size: int
    string_limit: int  # 0: none

    @property
    def is_message(self) -> bool:
        """Whether the element is another message."""
        return self.base not in PRIMITIVES

    @property
    def is_octets(self) -> bool:
        """Whether the field is an array of bytes, which JSON carries as base64."""
        return bool(self.array) and self.base in OCTETS


class Field(NamedTuple):
    """One field; `default` is None where the definition gives none."""

    name: str
    type: FieldType
    default: Any


class Definition(NamedTuple):
    """One message type: full name, fields in order, constants, and how each constant was written: type and text."""

    name: str
    fields: tuple[Field, ...]
    constants: dict[str, Any]
    written: tuple[tuple[str, str, str], ...] = ()
    """Type, name and value of each constant as in the text: what ROS 1 takes its hash of."""


def full_name(name: str) -> str:
    """Return the three-part name `package/msg/Name` of a type written in two or three parts.

    Raises:
        BridgeError: `name` is not a type name.
    """
    if not _TYPE_NAME.fullmatch(name):
        raise BridgeError(f"type: {name[:80]!r} is not a message type name, expected package/Name or package/msg/Name")
    package, _, message = name.partition("/")
    return f"{package}/msg/{message.removeprefix('msg/')}"


def parse_all(text: str) -> list[Definition]:
    """Parse a text of several messages, each introduced by `MSG: package/Name`.

    Raises:
        BridgeError: a part has no name, or a line is not a field, a constant or a comment.
    """
    definitions = []
    for part in _SEPARATOR.split(text):
        head, _, body = part.strip().partition("\n")
        if not head:
            continue
        if not head.startswith("MSG:"):
            raise BridgeError(f"message definition: expected 'MSG: package/Name', got {head[:80]!r}")
        definitions.append(parse(full_name(head.removeprefix("MSG:").strip()), body))
    return definitions


def parse(name: str, text: str) -> Definition:
    """Parse the `.msg` text of the message `name`.

    Raises:
        BridgeError: naming the message and the line that cannot be read.
    """
    name = full_name(name)
    package = name.partition("/")[0]
    fields: list[Field] = []
    constants: dict[str, Any] = {}
    written: list[tuple[str, str, str]] = []
    for number, line in enumerate(text.splitlines(), start=1):
        content = line.strip()
        if not content or content.startswith("#"):
            continue
        try:
            _read_line(content, package, fields, constants, written)
        except ValueError as error:
            raise BridgeError(f"{name}: line {number}: {error}: {content[:80]!r}") from None
    return Definition(name, tuple(fields), constants, tuple(written))


def _read_line(
    content: str,
    package: str,
    fields: list[Field],
    constants: dict[str, Any],
    written: list[tuple[str, str, str]],
) -> None:
    match = _FIELD.fullmatch(content)
    if match is None:
        raise ValueError("not a field or constant")
    base, field_name, rest = match["base"], match["name"], match["rest"]
    if rest.startswith("=") and not match["array"]:
        text = rest[1:].strip()
        constants[field_name] = _value(base, text)
        written.append((base, field_name, text if base in STRINGS else text.partition("#")[0].strip()))
        return
    if any(field.name == field_name for field in fields):
        raise ValueError("field given twice")
    size = int(match["size"] or 0)
    array: Literal["", "fixed", "bounded", "unbounded"] = ""
    if match["array"]:
        array = "bounded" if match["bounded"] else "fixed" if match["size"] else "unbounded"
    kind = FieldType(_resolve(base, package), array, size, int(match["limit"] or 0))
    text = "" if rest.startswith("#") else rest
    fields.append(Field(field_name, kind, _default(kind, text) if text else None))


def _resolve(base: str, package: str) -> str:
    if base in PRIMITIVES:
        return base
    if base in _SHORT_NAMES:
        return _SHORT_NAMES[base]
    return full_name(base if "/" in base else f"{package}/{base}")


def _default(kind: FieldType, text: str) -> Any:
    if kind.is_message:
        raise ValueError("a message field cannot have a default")
    if not kind.array:
        return _value(kind.base, text)
    try:
        values = orjson.loads(text.partition("#")[0].strip().replace("'", '"'))
    except orjson.JSONDecodeError:
        raise ValueError("default of an array must be a list") from None
    if not isinstance(values, list):
        raise ValueError("default of an array must be a list")
    return values


def _value(base: str, text: str) -> Any:
    """Read a constant or default. A ROS 1 string constant runs to the end of its line, comment signs included."""
    if base in STRINGS:
        quoted = re.fullmatch(r"""(["'])(.*)\1\s*(?:#.*)?""", text)
        return quoted[2] if quoted else text
    text = text.partition("#")[0].strip()
    if base == "bool":
        if text.lower() in ("true", "1"):
            return True
        if text.lower() in ("false", "0"):
            return False
        raise ValueError("not a bool")
    if base in FLOATS:
        return float(text)
    if base in INTEGER_RANGES:
        value = int(text, 0)
        low, high = INTEGER_RANGES[base]
        if not low <= value <= high:
            raise ValueError(f"not between {low} and {high}")
        return value
    raise ValueError("a constant must be of a primitive type")
