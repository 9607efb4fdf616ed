"""JSON Schemas of the kinds of files, for editors: with the descriptions, units, bounds and defaults of their keys."""

import inspect
from typing import Any, Final

import msgspec

from simconsole.profiles.keys.catalogue import tag_text
from simconsole.profiles.keys.descriptions import described
from simconsole.profiles.keys.key_units import key_unit
from simconsole.profiles.keys.kinds import KINDS

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"
SUFFIX: Final = ".schema.json"


def schema_of(kind: str) -> dict[str, Any]:
    """Return the schema of a kind of file, a name of `KINDS`."""
    schema = explained(KINDS[kind].profile, f"simconsole {kind}")
    if kind == "world":  # one that names no kind is a course
        schema["$defs"]["CourseProfile"]["required"].remove("kind")
    return schema


def explained(profile: Any, title: str) -> dict[str, Any]:
    """Return the schema of a struct, or of a union of several, in which every key has its description."""
    (schema,), parts = msgspec.json.schema_components([profile], ref_template="#/$defs/{name}")
    structs = {struct.__name__: struct for struct in _structs(msgspec.inspect.type_info(profile), {})}
    for name, part in parts.items():
        _explain(part, structs[name])
    return {"$schema": DIALECT, "title": title, **schema, "$defs": _unindented(parts)}


def _explain(part: dict[str, Any], struct: Any) -> None:
    texts, config = described(struct), struct.__struct_config__
    names = dict(zip(struct.__struct_encode_fields__, struct.__struct_fields__, strict=True))
    for key, value in part["properties"].items():
        unit = key_unit(key) if "number" in str(value) or "integer" in str(value) else ""
        text = tag_text(config.tag, struct) if key == config.tag_field else texts.get(names[key], "")
        value["description"] = f"{text} Unit: {unit}." if unit else text


def _structs(info: Any, found: dict[type[Any], None]) -> dict[type[Any], None]:
    """Return every struct that a type has inside, itself included."""
    if isinstance(info, msgspec.inspect.StructType):
        if info.cls in found:
            return found
        found[info.cls] = None
        for field in info.fields:
            _structs(field.type, found)
    for inner in ("type", "item_type", "value_type"):
        if hasattr(info, inner):
            _structs(getattr(info, inner), found)
    for one in (*getattr(info, "types", ()), *getattr(info, "item_types", ())):
        _structs(one, found)
    return found


def _unindented(part: Any) -> Any:
    """Return a part of a schema, its descriptions without their docstrings' indentation: Python 3.12 keeps that."""
    if isinstance(part, dict):
        return {
            key: inspect.cleandoc(value) if key == "description" and isinstance(value, str) else _unindented(value)
            for key, value in part.items()
        }
    return [_unindented(one) for one in part] if isinstance(part, list) else part
