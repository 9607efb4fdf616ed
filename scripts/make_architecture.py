"""The picture of the rooms in docs/architecture.md: `python scripts/make_architecture.py > docs/images/rooms.svg`.

Drawn from the sources and from the contracts at the end of pyproject.toml, so that it cannot say anything else: rooms
stand in the layers of the first contract, their folders are marked by whether the second counts them as pure, and a
line leads from each room to those that it imports, less those that it reaches through another.
"""

import ast
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
WIDTH_PX = 1180
LAYER_PX = 118
BOX_PX = 78
FOLDER_PX = 15
GAP_PX = 18
PURE, SHELL = "#dcefe0", "#f8e3cf"
STYLE = "font-family: system-ui, sans-serif; font-size: 11px"


class Room(NamedTuple):
    """A package below simconsole: where it is drawn, and its folders with whether they are pure."""

    name: str
    x_px: float
    y_px: float
    width_px: float
    folders: tuple[tuple[str, bool], ...]


def contracts() -> tuple[list[list[str]], list[str]]:
    """Return the layers of rooms from top to bottom, and the patterns of the pure folders."""
    layers, pure, _ = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    return [re.findall(r"\w+", layer) for layer in layers["layers"][1:]], pure["source_modules"]


def is_pure(folder: str, patterns: list[str]) -> bool:
    """Return whether the modules that lie directly in a folder (dotted, below simconsole) are under the contract."""
    name = f"simconsole.{folder}."
    whole = (pattern.removesuffix("**") for pattern in patterns if pattern.endswith(".**"))
    return f"{name}*" in patterns or name.startswith(tuple(whole))


def folders(room: str) -> list[str]:
    """Return the folders of a room that hold modules, dotted: itself first."""
    base = ROOT / "simconsole"
    found = sorted(path.parent for path in (base / room).rglob("__init__.py"))
    holding = [path for path in found if any(file.name != "__init__.py" for file in path.glob("*.py"))]
    return [".".join(path.relative_to(base).parts) for path in holding]


def imported(room: str) -> set[str]:
    """Return the other rooms that the modules of a room import, anywhere in their text."""
    rooms = set()
    for path in (ROOT / "simconsole" / room).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("simconsole."):
                rooms.add((node.module or "").split(".")[1])
    return rooms - {room}


def lines(rooms: list[str]) -> list[tuple[str, str]]:
    """Return the imports between rooms without those that follow from others."""
    direct = {room: imported(room) for room in rooms}

    def reached(room: str) -> set[str]:
        return direct[room].union(*(reached(next_) for next_ in direct[room]))

    through = {room: set().union(*(reached(next_) for next_ in direct[room])) for room in rooms}
    return [(room, target) for room in rooms for target in sorted(direct[room] - through[room])]


def place() -> list[Room]:
    """Return every room where it stands."""
    layers, pure = contracts()
    placed = []
    for row, layer in enumerate(layers):
        room_px = (WIDTH_PX - GAP_PX * (len(layer) + 1)) / len(layer)
        width_px = min(room_px, 330.0)
        indent_px = (WIDTH_PX - len(layer) * width_px - (len(layer) - 1) * GAP_PX) / 2.0
        for column, name in enumerate(layer):
            held = tuple((folder.partition(".")[2] or folder, is_pure(folder, pure)) for folder in folders(name))
            x_px = indent_px + column * (width_px + GAP_PX)
            placed.append(Room(name, x_px, GAP_PX + row * LAYER_PX, width_px, held))
    return placed


def draw() -> Iterator[str]:
    """Yield the lines of the SVG."""
    rooms = {room.name: room for room in place()}
    height_px = max(room.y_px for room in rooms.values()) + BOX_PX + GAP_PX + 24
    yield f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH_PX} {height_px:.0f}" style="{STYLE}">'
    yield f'<rect width="{WIDTH_PX}" height="{height_px:.0f}" fill="white"/>'
    for above, below in lines(list(rooms)):
        upper, lower = rooms[above], rooms[below]
        x1, y1 = upper.x_px + upper.width_px / 2.0, upper.y_px + BOX_PX
        x2, y2 = lower.x_px + lower.width_px / 2.0, lower.y_px
        yield (
            f'<path d="M{x1:.0f} {y1:.0f} C{x1:.0f} {y1 + 24:.0f} {x2:.0f} {y2 - 24:.0f} {x2:.0f} {y2:.0f}" '
            'fill="none" stroke="#8a94a0"/>'
        )
    for room in rooms.values():
        yield from box(room)
    y_px = height_px - 20
    machine = "touches clock, file, socket, thread, window or bus"
    for x_px, colour, text in ((GAP_PX, PURE, "pure"), (110, SHELL, machine)):
        yield f'<rect x="{x_px}" y="{y_px:.0f}" width="12" height="12" fill="{colour}" stroke="#8a94a0"/>'
        yield f'<text x="{x_px + 18}" y="{y_px + 10:.0f}">{text}</text>'
    yield "</svg>"


def box(room: Room) -> Iterator[str]:
    """Yield a room: its name, and its folders in as many columns as fit."""
    yield (
        f'<rect x="{room.x_px:.0f}" y="{room.y_px:.0f}" width="{room.width_px:.0f}" height="{BOX_PX}" '
        'rx="4" fill="white" stroke="#39424e"/>'
    )
    yield (
        f'<text x="{room.x_px + 8:.0f}" y="{room.y_px + 15:.0f}" font-weight="bold" font-size="13">{room.name}/</text>'
    )
    columns = 1 + (len(room.folders) > 3) + (len(room.folders) > 6)
    width_px = (room.width_px - 16.0) / columns
    for index, (folder, pure) in enumerate(room.folders):
        x_px = room.x_px + 8 + (index % columns) * width_px
        y_px = room.y_px + 22 + (index // columns) * (FOLDER_PX + 2)
        yield (
            f'<rect x="{x_px:.0f}" y="{y_px:.0f}" width="{width_px - 3:.0f}" height="{FOLDER_PX}" '
            f'fill="{PURE if pure else SHELL}"/>'
        )
        yield f'<text x="{x_px + 4:.0f}" y="{y_px + 11:.0f}">{folder}</text>'


if __name__ == "__main__":
    print("\n".join(draw()))
