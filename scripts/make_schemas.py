"""Write the JSON Schema of every kind of profile: `python scripts/make_schemas.py [docs/schemas]`.

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
from simconsole.profiles.world import WorldProfile

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "schemas"
KINDS = {
    "device": CockpitProfile,
    "scenario": ScenarioProfile,
    "session": SessionProfile,
    "vehicle": VehicleProfile,
    "world": WorldProfile,
}
"""By the folder of `profiles/`, less its s."""


def schemas() -> dict[str, str]:
    """Return the text of each schema by its file name."""
    dialect = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    return {
        f"{kind}.schema.json": json.dumps(dialect | unindented(msgspec.json.schema(profile)), indent=1) + "\n"
        for kind, profile in KINDS.items()
    }


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
