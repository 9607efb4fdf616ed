"""The published JSON Schemas are the present ones; the shipped profiles keep to theirs, and wrong ones do not."""

import copy
import json
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from simconsole.profiles import strict_yaml
from simconsole.profiles.files.loader import MAX_DATA_BYTES, read_text_of
from simconsole.profiles.keys.kinds import KINDS
from simconsole.profiles.keys.schemas import SUFFIX, schema_of
from simconsole.profiles.keys.shipped_values import shipped_files
from tests.paths import ROOT

SWEEP = {"schema": 1, "sessions": ["demo"], "values": {"environment.friction": {"from": 0.2, "to": 1.0, "count": 5}}}
"""No sweep is shipped."""
OUT_OF_BOUNDS: dict[str, tuple[tuple[str | int, ...], object, object]] = {
    "session": (("mode", "control_period_ms"), 0, "20"),
    "scenario": (("duration_s",), 0.0, "30"),
    "vehicle": (("steering_ratio",), 0.5, "15"),
    "world": (("lane_width_m",), 1.9, None),
    "plan": (("speed_limit_kmh",), 201.0, True),
    "cockpit": (("wheel", "lock_to_lock_deg"), 39.0, "900"),
    "language": (("decimal_mark",), ";", 1),
    "script": (("points", 0, "time_s"), -1.0, "0"),
    "sweep": (("timeout_s",), 0.0, "600"),
}
"""By kind: a key, a value of it out of its bounds, and one of another type."""


@cache
def validator(kind: str) -> Draft202012Validator:
    """The stock validator with the schema of a kind."""
    schema = schema_of(kind)
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def profiles(kind: str) -> dict[str, Any]:
    """The shipped profiles of a kind by their names."""
    files = shipped_files(kind)
    found: dict[str, Any] = {
        path.name: strict_yaml.parse(read_text_of(path, MAX_DATA_BYTES), path.name) for path in files
    }
    return found or {"sweep": SWEEP}


def with_value(profile: dict[str, Any], path: tuple[str | int, ...], value: object) -> dict[str, Any]:
    """A profile with another value at a path; sections that it lacks are made."""
    changed = copy.deepcopy(profile)
    at: Any = changed
    for step in path[:-1]:
        at = at[step] if isinstance(step, int) else at.setdefault(step, {})
    at[path[-1]] = value
    return changed


def test_the_published_schema_is_the_present_one(tmp_path: Path) -> None:
    subprocess.run([sys.executable, ROOT / "scripts" / "make_schemas.py", tmp_path], check=True)
    published = {path.name: path.read_text() for path in (ROOT / "docs" / "schemas").iterdir()}
    present = {path.name: path.read_text() for path in tmp_path.iterdir()}
    assert published == present, "run: python scripts/make_schemas.py"


@pytest.mark.parametrize("kind", KINDS)
def test_shipped_profiles_keep_to_their_schema(kind: str) -> None:
    for name, profile in profiles(kind).items():
        assert [error.message for error in validator(kind).iter_errors(profile)] == [], name


@pytest.mark.parametrize("kind", KINDS)
def test_a_wrong_key_type_or_value_is_refused(kind: str) -> None:
    path, beyond, other = OUT_OF_BOUNDS[kind]
    shipped = profiles(kind)
    profile = shipped.get("ball.yaml") or shipped.get("urban.yaml") or next(iter(shipped.values()))
    check = validator(kind)
    assert check.is_valid(profile)
    assert not check.is_valid(profile | {"wheelbaes_m": 2.6})
    assert not check.is_valid(dict.fromkeys(profile))
    assert not check.is_valid(with_value(profile, path, beyond))
    assert not check.is_valid(with_value(profile, path, other))
    assert not check.is_valid(with_value(profile, (*path[:-1], "wheelbaes_m"), 1.0))


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_of_a_schema_says_what_it_is(kind: str) -> None:
    schema = schema_of(kind)
    assert schema["title"] == f"simconsole {kind}"
    assert schema["$schema"].endswith("/2020-12/schema")
    keys = [(name, key, value) for name, part in schema["$defs"].items() for key, value in part["properties"].items()]
    assert [(name, key) for name, key, value in keys if not value["description"]] == []


def test_a_schema_has_unit_bounds_and_default() -> None:
    key = schema_of("session")["$defs"]["ModeSection"]["properties"]["control_period_ms"]
    assert key["description"].endswith("Unit: ms.")
    assert (key["minimum"], key["maximum"], key["default"]) == (1, 1000, 20)


def test_the_text_of_a_schema_has_no_indentation() -> None:
    assert "\n    " not in json.dumps(schema_of("session")).replace("\\n", "\n")
    assert SUFFIX == ".schema.json"
