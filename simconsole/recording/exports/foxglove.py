"""The layout with which Foxglove and Lichtblick show an export: the shipped one, under the drive's names of topics."""

import json
from pathlib import Path
from typing import Any, Final

LAYOUT: Final = Path(__file__).with_name("foxglove_layout.json")


def foxglove_layout(names: dict[str, str]) -> bytes:
    """Return the layout as JSON text; `names` is what each standard topic is called in the export."""
    layout = json.loads(LAYOUT.read_text("utf-8"))
    return json.dumps(_renamed(layout, names), indent=2).encode() + b"\n"


def topic_paths(layout: Any) -> list[str]:
    """Return what a layout shows: topics, or fields of them as `/topic.field`."""
    if isinstance(layout, dict):
        keys = [key for key in layout if key.startswith("/")]
        return keys + [path for value in layout.values() for path in topic_paths(value)]
    if isinstance(layout, list):
        return [path for value in layout for path in topic_paths(value)]
    return [layout] if isinstance(layout, str) and layout.startswith("/") else []


def _renamed(layout: Any, names: dict[str, str]) -> Any:
    if isinstance(layout, dict):
        return {_path(key, names): _renamed(value, names) for key, value in layout.items()}
    if isinstance(layout, list):
        return [_renamed(value, names) for value in layout]
    return _path(layout, names) if isinstance(layout, str) else layout


def _path(text: str, names: dict[str, str]) -> str:
    topic, dot, field = text.partition(".")
    return names.get(topic, topic) + dot + field
