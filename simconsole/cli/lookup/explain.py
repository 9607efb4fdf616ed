"""`simconsole explain`: what a key of a profile means, and the schemas of profiles for editors."""

import json
from argparse import Namespace
from pathlib import Path
from typing import Any

from simconsole.cli.outcome import Outcome, table
from simconsole.profiles.keys.catalogue import REQUIRED, Key
from simconsole.profiles.keys.finding import find_keys, keys_below, places, top_keys
from simconsole.profiles.keys.kinds import KINDS
from simconsole.profiles.keys.schemas import SUFFIX, schema_of
from simconsole.profiles.keys.shipped_values import example_of
from simconsole.values.errors import ProfileError

_SHOWN = 70


def explain(options: Namespace) -> Outcome:
    """Explain a key, the top keys of a kind of file, or of all kinds; or write the schemas.

    Raises:
        ProfileError: no key is called so, or the folder of the schemas cannot be written.
    """
    if options.schemas is not None:
        return _write_schemas(Path(options.schemas))
    if options.key is None or options.key in KINDS:
        return _kinds([options.key] if options.key else list(KINDS))
    found = find_keys(options.key)
    if len({key.path for key in found}) == 1:  # no more of a path would tell them apart
        facts = [_facts(key) for key in found]
        texts = [_key_text(key, known) for key, known in zip(found, facts, strict=True)]
        return Outcome(0, {"keys": facts}, "\n\n".join(texts))
    rows = table([(key.path + _of(key), _short(key.description)) for key in found])
    text = f"{options.key}: {len(found)} keys\n{rows}\nsimconsole explain with more of a path tells all of one key"
    return Outcome(0, {"keys": [_facts(key) for key in found]}, text)


def _kinds(kinds: list[str]) -> Outcome:
    found = {kind: top_keys(kind) for kind in kinds}
    parts = [
        f"{kind} ({KINDS[kind].page})\n{table([(key.name + _of(key), _short(key.description)) for key in keys])}"
        for kind, keys in found.items()
    ]
    return Outcome(0, {kind: [_described(key) for key in keys] for kind, keys in found.items()}, "\n\n".join(parts))


def _described(key: Key) -> dict[str, Any]:
    return {name: value for name, value in key._asdict().items() if name != "owner"}


def _facts(key: Key) -> dict[str, Any]:
    """Return all that is known of a key, for people and programs."""
    example = example_of(key)
    return _described(key) | {
        "also_at": places(key)[1:],
        "example": None if example is None else example._asdict(),
        "keys": [one.path for one in keys_below(key)],
    }


def _key_text(key: Key, facts: dict[str, Any]) -> str:
    example = facts["example"]
    rows = [
        ("file", key.kind + (f", where its section is {', '.join(key.where)}" if key.where else "")),
        ("type", key.type),
        ("unit", key.unit),
        ("bounds", key.bounds),
        ("default", "none: it must be given" if key.default == REQUIRED else _short(key.default)),
        ("example", f"{_short(json.dumps(example['value']))} in profiles/{example['file']}" if example else ""),
        ("also at", "\n           ".join(facts["also_at"])),
        ("page", key.page),
    ]
    below = [(one.name + _of(one), _short(one.description)) for one in keys_below(key)]
    inner = f"\nkeys\n{table(below)}" if below else ""
    return f"{key.path}\n{key.description}\n{table([row for row in rows if row[1]])}{inner}"


def _of(key: Key) -> str:
    """Return for which kinds of its section a key is, where it is not for all."""
    return f" ({', '.join(key.where)})" if key.where else ""


def _short(text: str) -> str:
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."


def _write_schemas(folder: Path) -> Outcome:
    paths = {folder / f"{KINDS[kind].schema}{SUFFIX}": schema_of(kind) for kind in KINDS}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for path, schema in paths.items():
            path.write_text(json.dumps(schema, indent=1) + "\n", "utf-8")
    except OSError as error:
        raise ProfileError(f"{folder}: cannot be written: {error.strerror}") from None
    return Outcome(0, {"files": [str(path) for path in paths]}, "\n".join(str(path) for path in paths))
