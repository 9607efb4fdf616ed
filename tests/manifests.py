"""Manifests as a forger writes them: changed, and their own checksum made right again."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from simconsole.recording.bundles.manifest import MANIFEST
from simconsole.recording.bundles.sealing import KEY, sealed


def content_of(folder: Path) -> dict[str, Any]:
    """What a manifest holds, less its own checksum."""
    content: dict[str, Any] = json.loads((folder / MANIFEST).read_bytes())
    content.pop(KEY, None)
    return content


def forge(folder: Path, change: Callable[[dict[str, Any]], object]) -> None:
    """Write what `change` makes of a manifest's content, so that it vouches for itself again."""
    content = content_of(folder)
    change(content)
    (folder / MANIFEST).write_bytes(sealed(content))
