"""The published JSON Schema of vehicle profiles is that of the profiles."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from simconsole import profile_text
from simconsole.profile_files import names, read_text

ROOT = Path(__file__).resolve().parents[2]


def test_the_published_schema_is_the_present_one(tmp_path: Path) -> None:
    subprocess.run([sys.executable, ROOT / "scripts" / "make_schemas.py", tmp_path], check=True)
    for path in tmp_path.iterdir():
        published = ROOT / "docs" / "schemas" / path.name
        assert published.read_text() == path.read_text(), "run: python scripts/make_schemas.py"


def test_shipped_profiles_use_only_keys_of_the_schema() -> None:
    schema = json.loads((ROOT / "docs" / "schemas" / "vehicle.schema.json").read_text())

    def check(value: Any, kind: dict[str, Any]) -> int:
        if "$ref" in kind:
            kind = schema["$defs"][kind["$ref"].rpartition("/")[2]]
        for low, high in (("minimum", "maximum"),):
            if low in kind:
                assert kind[low] <= value <= kind[high]
        if isinstance(value, dict):
            assert set(kind["required"]) <= set(value) <= set(kind["properties"])
            return sum(check(part, kind["properties"][key]) for key, part in value.items())
        if isinstance(value, list) and "items" in kind:
            return sum(check(part, kind["items"]) for part in value)
        return 1

    for name in names("vehicles"):
        profile = profile_text.parse(read_text("vehicles", f"{name}.yaml"), name)
        assert isinstance(profile, dict)
        kind = schema["discriminator"]["mapping"][profile["platform"]]
        assert check(profile, {"$ref": kind}) >= len(profile)
