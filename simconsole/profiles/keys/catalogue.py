"""Every key of every kind of file, with its path, its meaning, and what may stand there."""

import inspect as inspection
from collections.abc import Iterator
from functools import cache
from typing import Any, Final, NamedTuple

import msgspec
from msgspec import inspect

from simconsole.profiles.keys.descriptions import about, described
from simconsole.profiles.keys.key_types import bounds_text, type_text
from simconsole.profiles.keys.key_units import key_unit
from simconsole.profiles.keys.kinds import KINDS, page_of

REQUIRED: Final = "required"


class Key(NamedTuple):
    """One key of one kind of file."""

    kind: str
    path: str  # from the kind on: session.scenario.faults[].at_s; `[]` is any of a list, `{}` any of a mapping
    owner: str  # the struct that declares the field; empty where the key says of which kind a section is
    where: tuple[str, ...]  # the kinds of a part that have this key, `unplug`; empty: all have it
    description: str
    type: str
    unit: str  # empty for none
    bounds: str  # empty for none
    default: str  # as JSON, or REQUIRED
    page: str

    @property
    def is_tag(self) -> bool:
        """Whether it says of which kind its section is."""
        return self.owner == ""

    @property
    def name(self) -> str:
        """The last part of the path."""
        return self.path.rpartition(".")[2].removesuffix("[]").removesuffix("{}")


@cache
def catalogue() -> tuple[Key, ...]:
    """Return every key, in the order of the kinds and of their fields."""
    found: dict[tuple[str, str, str], Key] = {}
    for kind, file in KINDS.items():
        for key in _keys(kind, kind, msgspec.inspect.type_info(file.profile)):
            at = (key.path, key.owner, key.description)
            before = found.get(at)
            found[at] = key if before is None else before._replace(where=before.where + key.where)
    kinds = {key.path.rpartition(".")[0]: key.where for key in found.values() if key.is_tag}
    return tuple(
        key._replace(where=()) if set(key.where) == set(kinds.get(key.path.rpartition(".")[0], ())) else key
        for key in found.values()
    )


def _keys(kind: str, path: str, info: inspect.Type) -> Iterator[Key]:
    """Yield the keys of what stands at a path."""
    structs = list(_structs("", info))
    if structs and structs[0][1].tag_field is not None:
        yield _tag(kind, f"{path}{structs[0][0]}", [struct for _, struct in structs])
    for end, struct in structs:
        tag = "" if struct.tag is None else str(struct.tag)
        texts = described(struct.cls)
        below = f"{path}{end}"
        for field in struct.fields:
            at = f"{below}.{field.encode_name}"
            yield Key(
                kind=kind,
                path=at,
                owner=_owner(struct.cls, field.name),
                where=(tag,) if tag else (),
                description=texts.get(field.name, ""),
                type=type_text(field.type),
                unit=key_unit(field.encode_name) if "number" in type_text(field.type) else "",
                bounds=bounds_text(field.type),
                default=_default(field),
                page=page_of(kind, at.partition(".")[2]),
            )
            yield from _keys(kind, at, field.type)


def _tag(kind: str, path: str, structs: list[inspect.StructType]) -> Key:
    """Return the key that says which of several structs it is."""
    at, tags = f"{path}.{structs[0].tag_field}", tuple(str(struct.tag) for struct in structs)
    text = " ".join(("Which of these it is.", *(tag_text(struct.tag, struct.cls) for struct in structs)))
    default = '"course"' if kind == "world" and path == kind else REQUIRED
    return Key(
        kind=kind,
        path=at,
        owner="",
        where=tags,
        description=text,
        type="text",
        unit="",
        bounds=f"one of {', '.join(tags)}",
        default=default,
        page=page_of(kind, at.partition(".")[2]),
    )


def tag_text(tag: object, struct: type[Any]) -> str:
    """Return what a kind of a section is: `unplug`: The device is gone."""
    return f"`{tag}`: {about(struct)}"


def _structs(end: str, info: inspect.Type) -> Iterator[tuple[str, inspect.StructType]]:
    """Yield the structs that may stand there, with what a path adds for lists and mappings."""
    if isinstance(info, inspect.StructType):
        yield end, info
    elif isinstance(info, inspect.Metadata):
        yield from _structs(end, info.type)
    elif isinstance(info, inspect.UnionType):
        for one in info.types:
            yield from _structs(end, one)
    elif isinstance(info, inspect.VarTupleType | inspect.ListType):
        yield from _structs(f"{end}[]", info.item_type)
    elif isinstance(info, inspect.DictType):
        yield from _structs(f"{end}{{}}", info.value_type)


def _owner(struct: type[Any], field: str) -> str:
    """Return the name of the struct that declares a field."""
    return next(one.__name__ for one in struct.__mro__ if field in inspection.get_annotations(one))


def _default(field: inspect.Field) -> str:
    if field.required:
        return REQUIRED
    value = field.default if field.default is not msgspec.NODEFAULT else field.default_factory()
    return msgspec.json.encode(value).decode()
