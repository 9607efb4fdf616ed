"""Plain values to a typed profile, with errors of one line: file, key, value, what is allowed.

msgspec names the path and the type but neither the value nor both bounds, so they are added here by walking the
values and the type along the path.
"""

import re
from typing import Annotated, Any, Final, TypeVar

import msgspec
import msgspec.inspect

from simconsole.values.errors import ProfileError, did_you_mean

T = TypeVar("T")

PROFILE_FILES: Final = (".yaml", ".yml")


def worded(pattern: str, allowed: str, *, min_length: int | None = None, max_length: int | None = None) -> msgspec.Meta:
    """Return the bounds of a text, and what a message calls them: nobody has to read a pattern.

    Args:
        pattern: a regular expression that every such text matches.
        allowed: the same, and the lengths, in words.
        min_length: in characters, where the pattern says nothing of it.
        max_length: likewise.
    """
    return msgspec.Meta(pattern=pattern, min_length=min_length, max_length=max_length, extra={"allowed": allowed})


_PROFILE: Final = worded(
    r"^([A-Za-z0-9][A-Za-z0-9_-]{0,63}|.{1,1000}\.ya?ml)$", "a name of letters, digits, _ and -, or a .yaml file"
)
ProfileName = Annotated[str, _PROFILE]
"""A shipped profile's bare name, or a file in the folder of the session or scenario that names it."""
_REGISTERED: Final = worded(r"^[a-z][a-z0-9_]{0,60}$", "lower-case letters, digits and _, up to 61, a letter first")
RegisteredName = Annotated[str, _REGISTERED]
"""What another package has registered under an entry point."""

_LOCATED: Final = re.compile(r"(?P<what>.*?)(?: - at (?:`(?P<key>key)` in )?`\$(?P<path>.*)`)?", re.DOTALL)
_STEP: Final = re.compile(r"\.(?P<name>[^.\[]+)|\[(?P<index>\d+|\.\.\.)\]")
_UNKNOWN: Final = re.compile(r"Object contains unknown field `(?P<name>.*)`", re.DOTALL)
_MISSING: Final = re.compile(r"Object missing required field `(?P<name>.*)`")
_OF_A_TEXT: Final = "Expected `str` "
"""How msgspec begins to tell that a text is too long or does not match."""
_SHOWN: Final = 60

Path = tuple[str | int, ...]


def convert(values: object, struct: type[T], origin: str) -> T:
    """Return `values` (from `strict_yaml.parse`) as `struct`; `origin` (a file name) opens the message.

    Raises:
        ProfileError: `FILE: KEY: value VALUE: what is allowed`, for the first thing that does not fit.
    """
    try:
        return msgspec.convert(values, struct)
    except msgspec.ValidationError as error:
        raise ProfileError(f"{origin}: {_explain(str(error), values, struct)}") from error


def _explain(message: str, values: object, struct: type[Any]) -> str:
    located = _LOCATED.fullmatch(message)
    assert located is not None, message
    what = located["what"]
    path = _resolve(message, located["path"] or "", values, struct)
    types = _types_at(path, struct, values)
    if unknown := _UNKNOWN.fullmatch(what):
        return _unknown_key((*path, unknown["name"]), types, _value_at((*path, unknown["name"]), values))
    if missing := _MISSING.fullmatch(what):
        path = (*path, missing["name"])
        return f"{_dotted(path)}: value missing: {_allowed(_types_at(path, struct, values), 'required')}"
    if located["key"]:
        keys = [key for kind in types for key in _members(getattr(kind, "key_type", None))]
        guilty = _guilty_key(message, path, values, struct)
        return f"{_dotted(path)}: key {_shown(guilty)}: {_allowed(keys, what)}"
    return f"{_dotted(path)}: value {_shown(_value_at(path, values))}: {_allowed(types, what)}"


def _resolve(message: str, text: str, values: object, struct: type[Any]) -> Path:
    """Turn msgspec's path into steps. It writes `[...]` for a mapping's value; the guilty key is found by trial."""
    path: Path = ()
    for step in _STEP.finditer(text):
        if step["name"]:
            path = (*path, step["name"])
        elif step["index"] != "...":
            path = (*path, int(step["index"]))
        else:
            path = (*path, _guilty_key(message, path, values, struct))
    return path


def _guilty_key(message: str, path: Path, values: object, struct: type[Any]) -> str:
    """Return the key whose value alone is refused in the same words; other keys may be refused for other reasons."""
    mapping = _value_at(path, values)
    assert isinstance(mapping, dict)
    for key, value in mapping.items():
        try:
            msgspec.convert(_with_value(values, path, {key: value}), struct)
        except msgspec.ValidationError as error:
            if str(error) == message:
                return str(key)
    return "..."


def _with_value(values: Any, path: Path, value: object) -> Any:
    if not path:
        return value
    copy = values.copy()
    copy[path[0]] = _with_value(values[path[0]], path[1:], value)
    return copy


def _value_at(path: Path, values: Any) -> Any:
    for step in path:
        values = _stepped(values, step)
    return values


def _types_at(path: Path, struct: type[Any], values: Any) -> list[Any]:
    """Return the types that may stand at `path`: several where the profile allows a union that no tag decides."""
    types = _members(msgspec.inspect.type_info(struct))
    for step in path:
        types = _tagged(types, values)
        types = [member for outer in types for inner in _inner(outer, step) for member in _members(inner)]
        values = _stepped(values, step)
    return types


def _tagged(types: list[Any], value: Any) -> list[Any]:
    """Return the one struct that the value's tag names, all types where it names none."""
    return [
        kind
        for kind in types
        if getattr(kind, "tag_field", None) and isinstance(value, dict) and value.get(kind.tag_field) == kind.tag
    ] or types


def _stepped(values: Any, step: str | int) -> Any:
    try:
        return values[step]
    except (KeyError, IndexError, TypeError):
        return None


def _members(kind: Any) -> list[Any]:
    if isinstance(kind, msgspec.inspect.UnionType):
        return [member for inner in kind.types for member in _members(inner)]
    if isinstance(kind, msgspec.inspect.Metadata) and not kind.extra:  # what a text may be is told by its extra
        return _members(kind.type)
    return [kind]


def _inner(kind: Any, step: str | int) -> list[Any]:
    if isinstance(kind, msgspec.inspect.StructType):
        if kind.tag_field == step:
            return [msgspec.inspect.LiteralType((kind.tag,))]
        return [field.type for field in kind.fields if field.encode_name == step]
    if isinstance(kind, msgspec.inspect.DictType):
        return [kind.value_type]
    if isinstance(kind, msgspec.inspect.TupleType):
        return [kind.item_types[step]] if isinstance(step, int) and step < len(kind.item_types) else []
    item = getattr(kind, "item_type", None)
    return [] if item is None else [item]


def _unknown_key(path: Path, types: list[Any], value: object) -> str:
    known = [field.encode_name for kind in types for field in getattr(kind, "fields", ())]
    return f"{_dotted(path)}: value {_shown(value)}: unknown key, {did_you_mean(str(path[-1]), known)}"


def _allowed(types: list[Any], what: str) -> str:
    kinds = [kind for kind in types if not isinstance(kind, msgspec.inspect.NoneType)]
    if len(kinds) > 1 and all(isinstance(kind, msgspec.inspect.LiteralType) for kind in kinds):
        kinds = [msgspec.inspect.LiteralType(tuple(value for kind in kinds for value in kind.values))]
    kind = kinds[0] if len(kinds) == 1 else None
    or_null = " or null" if len(kinds) < len(types) else ""
    if isinstance(kind, msgspec.inspect.FloatType | msgspec.inspect.IntType):
        noun = "a number" if isinstance(kind, msgspec.inspect.FloatType) else "a whole number"
        return f"{noun}{_bounds(kind)}{or_null}"
    if isinstance(kind, msgspec.inspect.LiteralType):
        return f"one of {', '.join(str(value) for value in kind.values)}{or_null}"
    texts = [one.extra["allowed"] for one in kinds if isinstance(one, msgspec.inspect.Metadata) and one.extra]
    if texts and (kind or what.startswith(_OF_A_TEXT)):
        return f"{', or '.join(texts)}{or_null}"
    if isinstance(kind, msgspec.inspect.EnumType):
        return f"one of {', '.join(str(member.value) for member in kind.cls)}{or_null}"
    return _plain(what)


def _bounds(kind: Any) -> str:
    low = f"{kind.ge:g} or more" if kind.ge is not None else f"above {kind.gt:g}" if kind.gt is not None else ""
    high = f"{kind.le:g} or less" if kind.le is not None else f"below {kind.lt:g}" if kind.lt is not None else ""
    if kind.ge is not None and kind.le is not None:
        return f" from {kind.ge:g} to {kind.le:g}"
    return f", {' and '.join(part for part in (low, high) if part)}" if low or high else ""


def _plain(what: str) -> str:
    text = what.replace("`", "").replace("\n", " ")
    return (text[0].lower() + text[1:] if text else text).replace("object", "mapping").replace("array", "list")


def _shown(value: object) -> str:
    text = msgspec.json.encode(value).decode()
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."


def _dotted(path: Path) -> str:
    text = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path)
    return " ".join(text.removeprefix(".").split()) or "file"
