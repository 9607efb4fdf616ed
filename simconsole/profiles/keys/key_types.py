"""What may stand at a key, in words: its type and its bounds."""

from msgspec import inspect


def type_text(info: inspect.Type) -> str:
    """Return the type of a key: `number or null`, `list of texts`."""
    if isinstance(info, inspect.Metadata):
        return type_text(info.type)
    if isinstance(info, inspect.UnionType):
        words = list(dict.fromkeys(type_text(one) for one in info.types))
        return " or ".join([*(word for word in words if word != "null"), *(["null"] * ("null" in words))])
    if isinstance(info, inspect.VarTupleType | inspect.ListType):
        return f"list of {_many(info.item_type)}"
    if isinstance(info, inspect.TupleType):
        return f"list of {len(info.item_types)} {_many(info.item_types[0])}"
    if isinstance(info, inspect.DictType):
        return f"mapping of {_many(info.value_type)}"
    if isinstance(info, inspect.LiteralType):
        return "whole number" if all(isinstance(value, int) for value in info.values) else "text"
    for kind, word in _WORDS:
        if isinstance(info, kind):
            return word
    return "anything"


def _many(info: inspect.Type) -> str:
    one = type_text(info)
    return f"{one}s" if one in ("number", "whole number", "text", "section") else one


_WORDS: tuple[tuple[type, str], ...] = (
    (inspect.FloatType, "number"),
    (inspect.IntType, "whole number"),
    (inspect.BoolType, "true or false"),
    (inspect.StrType, "text"),
    (inspect.NoneType, "null"),
    (inspect.StructType, "section"),
)


def bounds_text(info: inspect.Type) -> str:
    """Return the bounds of a key, empty where there are none: `1 to 90`, `one of front, rear`, `1 to 7 entries`."""
    if isinstance(info, inspect.Metadata):
        allowed = (info.extra or {}).get("allowed")  # a text's pattern in words (profiles/validation.py)
        return str(allowed) if allowed else bounds_text(info.type)
    if isinstance(info, inspect.UnionType):
        return "; ".join(dict.fromkeys(text for one in info.types if (text := bounds_text(one))))
    if isinstance(info, inspect.LiteralType):
        return (
            f"one of {', '.join(str(value) for value in info.values)}" if len(info.values) > 1 else str(info.values[0])
        )
    if isinstance(info, inspect.FloatType | inspect.IntType):
        return _range(info.ge, info.gt, info.le, info.lt)
    if isinstance(info, inspect.StrType):
        length = _range(info.min_length, None, info.max_length, None)
        return f"{length} characters" if length else ""
    if isinstance(info, inspect.VarTupleType | inspect.ListType):
        count = _range(info.min_length, None, info.max_length, None)
        inner = bounds_text(info.item_type)
        return "; ".join([*([f"{count} entries"] if count else []), *([f"each {inner}"] if inner else [])])
    if isinstance(info, inspect.TupleType):
        inner = bounds_text(info.item_types[0])
        return f"each {inner}" if inner else ""
    if isinstance(info, inspect.DictType):
        inner = bounds_text(info.value_type)
        return f"each {inner}" if inner else ""
    return ""


def _range(ge: float | None, gt: float | None, le: float | None, lt: float | None) -> str:
    if ge is not None and le is not None:
        return f"{ge:.16g} to {le:.16g}"
    low = f"{ge:.16g} or more" if ge is not None else f"above {gt:.16g}" if gt is not None else ""
    high = f"{le:.16g} or less" if le is not None else f"below {lt:.16g}" if lt is not None else ""
    return " and ".join(part for part in (low, high) if part)
