"""Write the JSON Schema of profiles and of a bundle's files: `python scripts/make_schemas.py [docs/schemas]`.

An editor that knows the schema completes keys and shows bounds:
`# yaml-language-server: $schema=docs/schemas/vehicle.schema.json` as the first line of a profile.
"""

import argparse
import inspect
import json
from pathlib import Path
from typing import Any

import msgspec

from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.profiles.view import LanguageProfile
from simconsole.profiles.world import WorldProfile
from simconsole.recording.bundles.manifest import Manifest
from simconsole.recording.bundles.sealing import KEY
from simconsole.recording.bundles.signing import Signature

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "schemas"
KINDS = {
    "device": CockpitProfile,
    "language": LanguageProfile,
    "scenario": ScenarioProfile,
    "session": SessionProfile,
    "vehicle": VehicleProfile,
    "world": WorldProfile,
}
"""By the folder of `profiles/`, less its s."""
SEALED = {"manifest": Manifest, "signature": Signature}
"""Files of a bundle, which hold their own checksum."""


def schemas() -> dict[str, str]:
    """Return the text of each schema by its file name."""
    dialect = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    found = {kind: msgspec.json.schema(profile) for kind, profile in KINDS.items()}
    with_default_kind(found["world"])
    found |= {kind: with_checksum(msgspec.json.schema(record)) for kind, record in SEALED.items()}
    return {
        f"{kind}.schema.json": json.dumps(dialect | unindented(schema), indent=1) + "\n"
        for kind, schema in found.items()
    }


def with_default_kind(schema: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of worlds: one that names no kind is a course."""
    schema["$defs"]["CourseProfile"]["required"].remove("kind")
    return schema


def with_checksum(schema: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a record as it lies in its file, its own checksum first."""
    record = schema["$defs"][schema["$ref"].rpartition("/")[2]]
    checksum = {
        "type": "string",
        "pattern": "^[0-9a-f]{64}$",
        "description": "SHA-256 of the file without its second line, which this is.",
    }
    record["properties"] = {KEY: checksum} | record["properties"]
    record["required"] = [KEY, *record["required"]]
    return schema


def unindented(part: Any) -> Any:
    """Return a part of a schema, its descriptions without their docstrings' indentation: Python 3.12 keeps that."""
    if isinstance(part, dict):
        return {
            key: inspect.cleandoc(value) if key == "description" and isinstance(value, str) else unindented(value)
            for key, value in part.items()
        }
    return [unindented(one) for one in part] if isinstance(part, list) else part


def main() -> None:
    """Write every schema."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?", default=FOLDER)
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    for name, text in schemas().items():
        (given.folder / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
