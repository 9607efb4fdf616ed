"""Message types: `.msg` definitions to generated `msgspec.Struct` classes, and values in and out of them.

A generated class checks types, integer ranges and array lengths and refuses unknown fields; missing fields get the
definition's defaults. Nothing is generated before it is first asked for.
"""

import re
from pathlib import PurePath
from typing import Annotated, Any

import msgspec

from simconsole.bridge.messages.cdr_writer import Writer, message_writer
from simconsole.bridge.messages.conversion import normalise
from simconsole.bridge.messages.definition import (
    FLOATS,
    HEADER,
    INTEGER_RANGES,
    STRINGS,
    Definition,
    Field,
    FieldType,
    full_name,
    parse,
    parse_all,
)
from simconsole.values.errors import BridgeError, RemoteProtocolError

INT64_MAX = 2**63 - 1
_PARTS = re.compile(r"^---[ \t]*$", re.MULTILINE)
_KIND = re.compile(r"/(?:srv|action)/")


class Registry:
    """The message types one side of a bridge knows. User definitions are added beside the standard ones."""

    def __init__(self) -> None:
        """Start empty; `standard_registry` gives one with the usual packages."""
        self._definitions: dict[str, Definition] = {}
        self._structs: dict[str, Any] = {}
        self._full_names: dict[str, str] = {}
        self._cdr_writers: dict[str, Writer] = {}

    def add_all(self, text: str) -> None:
        """Add every message of a text of `MSG: package/Name` parts.

        Raises:
            BridgeError: the text cannot be read, or gives a known type another definition.
        """
        for definition in parse_all(text):
            self.add_definition(definition)

    def add(self, name: str, text: str) -> None:
        """Add one message from its `.msg` text. Raises as `add_all`."""
        self.add_definition(parse(name, text))

    def add_definition(self, definition: Definition) -> None:
        """Add one parsed definition. Raises as `add_all`."""
        known = self._definitions.get(definition.name)
        if known is not None and known != definition:
            raise BridgeError(f"{definition.name}: already defined differently")
        self._definitions[definition.name] = definition

    def add_service(self, name: str, text: str) -> None:
        """Add a service from its `.srv` text. Raises as `add_all`."""
        self._add_parts(name, text, ("Request", "Response"))

    def add_action(self, name: str, text: str) -> None:
        """Add an action from its `.action` text. Raises as `add_all`."""
        self._add_parts(name, text, ("Goal", "Result", "Feedback"))

    def add_file(self, path: PurePath, text: str) -> None:
        """Add what a file `PACKAGE/msg/NAME.msg`, or the like for `srv` and `action`, defines. Raises as `add_all`."""
        package, kind, file = path.parts[-3:]
        add = {"msg": self.add, "srv": self.add_service, "action": self.add_action}[kind]
        add(f"{package}/{file.removesuffix(f'.{kind}')}", text)

    def _add_parts(self, name: str, text: str, parts: tuple[str, ...]) -> None:
        texts = _PARTS.split(text)
        if len(texts) != len(parts):
            raise BridgeError(f"{name}: has {len(texts)} parts divided by ---, expected {len(parts)}")
        for part, body in zip(parts, texts, strict=True):
            self.add(f"{_KIND.sub('/', name)}_{part}", body)

    def part(self, name: str, part: str) -> str | None:
        """Return the type of a service's Request or Response, an action's Goal, Result or Feedback; None if unknown."""
        try:
            return self.resolve(f"{_KIND.sub('/', name)}_{part}")
        except BridgeError:
            return None

    def names(self) -> tuple[str, ...]:
        """Return all known type names, three-part, sorted."""
        return tuple(sorted(self._definitions))

    def resolve(self, name: str) -> str:
        """Return the full name of a known type written in two or three parts.

        Raises:
            BridgeError: not a type name, or a type nobody defined.
        """
        known = self._full_names.get(name)
        if known is None:
            known = full_name(name)
            if known not in self._definitions:
                raise BridgeError(f"type: {known} is not known here")
            self._full_names[name] = known
        return known

    def definition(self, name: str) -> Definition:
        """Return the definition of a type. Raises BridgeError as `resolve`."""
        return self._definitions[self.resolve(name)]

    def with_parts(self, name: str) -> list[Definition]:
        """Return a definition and all it is made of, each once, itself first. Raises BridgeError as `resolve`."""
        found: dict[str, Definition] = {}
        waiting = [self.resolve(name)]
        while waiting:
            current = waiting.pop(0)
            if current not in found:
                found[current] = self.definition(current)
                waiting += [field.type.base for field in found[current].fields if field.type.is_message]
        return list(found.values())

    def struct(self, name: str) -> Any:
        """Return the generated class of a type; constants of the definition are class attributes.

        Raises:
            BridgeError: the type, or one it uses, is not known, or it contains itself.
        """
        full = self.resolve(name)
        if full not in self._structs:
            self._generate(full, ())
        return self._structs[full]

    def cdr_writer(self, name: str) -> Writer:
        """Return what appends a typed message to a body of CDR. Raises BridgeError as `struct`."""
        writer = self._cdr_writers.get(name)
        if writer is None:
            writer = self._cdr_writers[name] = message_writer(self.definition, name)
        return writer

    def from_plain(self, name: str, value: Any, *, gaps: bool = True, now_ns: int = 0) -> Any:
        """Return the typed message of a decoded JSON value.

        Args:
            name: the message type.
            value: dicts, lists and scalars as JSON has them, or already an instance of the type.
            gaps: accept null as NaN for a float.
            now_ns: the time a stamp "now" stands for.

        Raises:
            RemoteProtocolError: the value does not fit; names the path of the field.
            BridgeError: the type is not known.
        """
        struct = self._structs.get(name) or self.struct(name)
        if isinstance(value, struct):
            return value
        try:
            return msgspec.convert(value, struct)
        except msgspec.ValidationError:
            pass
        # Only a value that failed is normalised: messages in our own dialect pay nothing for the other one.
        try:
            return msgspec.convert(normalise(self.definition, self.resolve(name), value, gaps, now_ns), struct)
        except msgspec.ValidationError as error:
            raise RemoteProtocolError(str(error)) from None

    def _generate(self, full: str, parents: tuple[str, ...]) -> Any:
        if full in parents:
            raise BridgeError(f"{full}: contains itself")
        if full not in self._definitions:
            raise BridgeError(f"{parents[-1]}: uses {full}, which is not known here")
        if full not in self._structs:
            definition = self._definitions[full]
            fields = [self._member(field, (*parents, full)) for field in definition.fields]
            clash = {field.name for field in definition.fields} & definition.constants.keys()
            constants = {key: value for key, value in definition.constants.items() if key not in clash}
            self._structs[full] = msgspec.defstruct(
                full.rpartition("/")[2],
                fields,
                namespace={**constants, "__doc__": f"{full}, generated from its definition."},
                forbid_unknown_fields=True,
            )
        return self._structs[full]

    def _member(self, field: Field, parents: tuple[str, ...]) -> tuple[str, Any, Any]:
        kind = field.type
        element = self._generate(kind.base, parents) if kind.is_message else _scalar(kind)
        annotation = element if not kind.array else _array(kind, element)
        if field.default is not None and not kind.array:
            return field.name, annotation, field.default
        try:
            empty = msgspec.convert(field.default, annotation) if field.default is not None else _empty(kind, element)
        except msgspec.ValidationError as error:
            raise BridgeError(f"{parents[-1]}: default of {field.name}: {error}") from None
        if isinstance(empty, list):
            return field.name, annotation, msgspec.field(default_factory=lambda: _copy(empty))
        if kind.is_message:
            return field.name, annotation, msgspec.field(default_factory=element)
        return field.name, annotation, empty


def _copy(values: list[Any]) -> list[Any]:
    return [type(value)() if isinstance(value, msgspec.Struct) else value for value in values]


def _scalar(kind: FieldType) -> Any:
    if kind.base == "bool":
        return bool
    if kind.base in FLOATS:
        return float
    if kind.base in STRINGS:
        return Annotated[str, msgspec.Meta(max_length=kind.string_limit)] if kind.string_limit else str
    low, high = INTEGER_RANGES[kind.base]
    # msgspec bounds end at int64; a uint64 is only held to be positive.
    return Annotated[int, msgspec.Meta(ge=low, le=high if high <= INT64_MAX else None)]


def _array(kind: FieldType, element: Any) -> Any:
    low = kind.size if kind.array == "fixed" else None
    high = kind.size if kind.array != "unbounded" else None
    return Annotated[bytes if kind.is_octets else list[element], msgspec.Meta(min_length=low, max_length=high)]


def _empty(kind: FieldType, element: Any) -> Any:
    count = kind.size if kind.array == "fixed" else 0
    if kind.is_octets:
        return bytes(count)
    zero: Any = {"bool": False, **dict.fromkeys(FLOATS, 0.0), **dict.fromkeys(STRINGS, "")}.get(kind.base, 0)
    if kind.array:
        return [element() if kind.is_message else zero for _ in range(count)]
    return zero


def is_stamped(definition: Definition) -> bool:
    """Return whether a message begins with a std_msgs/Header."""
    return bool(definition.fields) and definition.fields[0].type.base == HEADER and not definition.fields[0].type.array
