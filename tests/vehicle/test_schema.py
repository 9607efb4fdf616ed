"""The published JSON Schemas are the present ones, and the shipped profiles keep to theirs."""

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from simconsole.profiles import strict_yaml as profile_text
from simconsole.profiles.files.loader import MAX_DATA_BYTES, names, read_text
from tests.paths import ROOT


def test_the_published_schema_is_the_present_one(tmp_path: Path) -> None:
    subprocess.run([sys.executable, ROOT / "scripts" / "make_schemas.py", tmp_path], check=True)
    for path in tmp_path.iterdir():
        published = ROOT / "docs" / "schemas" / path.name
        assert published.read_text() == path.read_text(), "run: python scripts/make_schemas.py"


TYPES: dict[str, tuple[type, ...]] = {
    **{"object": (dict,), "array": (list,), "string": (str,), "boolean": (bool,), "null": (type(None),)},
    **{"number": (int, float), "integer": (int,)},
}


def fits(value: Any, kind: dict[str, Any] | bool, schema: dict[str, Any]) -> bool:
    """Return whether a value is what the schema allows, as far as our schemas say it."""
    if kind in (True, False, {}):
        return kind is not False
    assert isinstance(kind, dict)
    if "$ref" in kind:
        return fits(value, schema["$defs"][kind["$ref"].rpartition("/")[2]], schema)
    if "anyOf" in kind:
        return any(fits(value, one, schema) for one in kind["anyOf"])
    if "enum" in kind:
        return value in kind["enum"]
    wanted = TYPES[kind["type"]]
    if not isinstance(value, wanted) or (isinstance(value, bool) and bool not in wanted):
        return False
    if isinstance(value, dict):
        known, more = kind.get("properties", {}), kind.get("additionalProperties", True)
        return set(kind.get("required", [])) <= set(value) and all(
            fits(part, known.get(key, more), schema) for key, part in value.items()
        )
    if isinstance(value, list):
        counted = kind.get("minItems", 0) <= len(value) <= kind.get("maxItems", len(value))
        return counted and all(fits(part, kind.get("items", kind), schema) for part in value)
    if isinstance(value, str):
        return re.search(kind.get("pattern", ""), value) is not None
    if isinstance(value, int | float):
        return bool(kind.get("minimum", value) <= value <= kind.get("maximum", value))
    return True


@pytest.mark.parametrize("kind", ["device", "scenario", "session", "vehicle", "world"])
def test_shipped_profiles_keep_to_their_schema_and_misspelt_ones_do_not(kind: str) -> None:
    schema = json.loads((ROOT / "docs" / "schemas" / f"{kind}.schema.json").read_text())
    found = [name for name in names(f"{kind}s") if "." not in name]  # a plan of a world is no world
    assert found
    for name in found:
        profile = profile_text.parse(read_text(f"{kind}s", f"{name}.yaml", max_bytes=MAX_DATA_BYTES), name)
        assert isinstance(profile, dict)
        assert fits(profile, schema, schema), name
        assert not fits(profile | {"wheelbaes_m": 2.6}, schema, schema)
        assert not fits(dict.fromkeys(profile), schema, schema)
