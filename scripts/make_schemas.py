"""Write the JSON Schema of profiles and of a bundle's files: `python scripts/make_schemas.py [docs/schemas]`.

Those of profiles are the ones that `simconsole explain --schemas DIR` writes for editors.
"""

import argparse
import json
from pathlib import Path
from typing import Any

from simconsole.profiles.keys.kinds import KINDS
from simconsole.profiles.keys.schemas import SUFFIX, explained, schema_of
from simconsole.recording.bundles.manifest import Manifest
from simconsole.recording.bundles.sealing import KEY
from simconsole.recording.bundles.signing import Signature

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "schemas"
SEALED = {"manifest": Manifest, "signature": Signature}
"""Files of a bundle, which hold their own checksum."""


def schemas() -> dict[str, str]:
    """Return the text of each schema by its file name."""
    found = {file.schema: schema_of(kind) for kind, file in KINDS.items()}
    found |= {name: with_checksum(explained(record, f"simconsole {name}")) for name, record in SEALED.items()}
    return {f"{name}{SUFFIX}": json.dumps(schema, indent=1) + "\n" for name, schema in found.items()}


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
