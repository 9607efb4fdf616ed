"""Write the JSON Schema of vehicle profiles: `python scripts/make_schemas.py [docs/schemas]`.

An editor that knows the schema completes keys and shows bounds:
`# yaml-language-server: $schema=docs/schemas/vehicle.schema.json` as the first line of a profile.
"""

import argparse
import json
from pathlib import Path

import msgspec

from simconsole.profiles.vehicle import VehicleProfile

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "schemas"


def schemas() -> dict[str, str]:
    """Return the text of each schema by its file name."""
    vehicle = {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(VehicleProfile)}
    return {"vehicle.schema.json": json.dumps(vehicle, indent=1) + "\n"}


def main() -> None:
    """Write every schema."""
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("folder", type=Path, nargs="?", default=FOLDER)
    given = words.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    for name, text in schemas().items():
        (given.folder / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
