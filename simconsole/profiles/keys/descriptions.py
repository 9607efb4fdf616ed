"""The description of each key: the text that stands right under its field in the source of its struct.

Python drops such a text when it compiles a module, so that it costs nothing until it is read here.
"""

import ast
import inspect
import sys
from functools import cache
from typing import Any


def described(struct: type[Any]) -> dict[str, str]:
    """Return the description of each field of a struct, inherited ones included; a field without one is left out."""
    found: dict[str, str] = {}
    for owner in reversed(struct.__mro__):
        if owner.__module__.startswith("simconsole."):
            found |= _of_module(owner.__module__).get(owner.__name__, {})
    return found


def about(struct: type[Any]) -> str:
    """Return the first paragraph of a struct's own text, on one line."""
    return " ".join((inspect.getdoc(struct) or "").partition("\n\n")[0].split())


@cache
def _of_module(name: str) -> dict[str, dict[str, str]]:
    """Return the descriptions in a module by class and field."""
    classes = ast.parse(inspect.getsource(sys.modules[name])).body
    return {node.name: _of_class(node) for node in classes if isinstance(node, ast.ClassDef)}


def _of_class(node: ast.ClassDef) -> dict[str, str]:
    found = {}
    for field, text in zip(node.body, node.body[1:], strict=False):
        if (
            isinstance(field, ast.AnnAssign)
            and isinstance(field.target, ast.Name)
            and isinstance(text, ast.Expr)
            and isinstance(text.value, ast.Constant)
        ):
            found[field.target.id] = " ".join(str(text.value.value).split())
    return found
