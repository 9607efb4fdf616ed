"""SUMO's netconvert, where it is installed: other formats in, and networks built from plain files.

Neither OpenDRIVE nor OpenStreetMap says all that a road map holds: what was guessed or dropped is told as losses.
"""

import os
import re
import shutil
import subprocess
import tempfile
from collections import Counter
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Final, NamedTuple

from simconsole.values.errors import ProfileError
from simconsole.world.roads.road_map import RoadMap
from simconsole.world.sumo.net_reader import read_net
from simconsole.world.sumo.plain_xml import PlainNetwork
from simconsole.world.sumo.xml_guard import Element, read_elements

ROOTS: Final = {".xodr": "OpenDRIVE", ".osm": "osm"}
"""Ending of a file to the first element that it must have."""
MAX_S: Final = 300.0
MOST_WARNINGS: Final = 10

_OSM_OPTIONS: Final = (
    "--geometry.remove",
    "--ramps.guess",
    "--junctions.join",
    "--tls.guess-signals",
    "--tls.discard-simple",
    "--sidewalks.guess",
    "--crossings.guess",
    "--walkingareas",
    "--osm-files",
)
_OPTIONS: Final = {".xodr": ("--opendrive-files",), ".osm": _OSM_OPTIONS}
"""The last one names the file."""
_BUILD_OPTIONS: Final = ("--walkingareas", "--offset.disable-normalization", "--junctions.corner-detail", "5")
_ALWAYS: Final = ("--xml-validation", "never", "--no-turnarounds", "--junctions.internal-link-detail", "12")
_COMMENT: Final = re.compile(rb"<!--.*?-->\s*", re.DOTALL)
"""Holds the time and the paths of the run, which would make equal networks differ."""
_QUOTED: Final = re.compile(r"'[^']*'|\d+(\.\d+)?")
_ALWAYS_LOST: Final = {
    "OpenDRIVE": (
        "signal programs: OpenDRIVE has none; those of the map are netconvert's",
        "superelevation and road marks: not carried over",
    ),
    "osm": (
        "lane widths, turn lanes and rights of way: guessed by netconvert where tags say nothing",
        "signal programs: OpenStreetMap has none; those of the map are netconvert's",
    ),
}


class Converted(NamedTuple):
    """A converted map: its text, what was read of it, and what was lost on the way, one line each."""

    net: bytes
    road_map: RoadMap
    losses: tuple[str, ...]


def netconvert() -> str | None:
    """Return the program, of the path or of the Python package eclipse-sumo; None where it is not installed."""
    found = shutil.which("netconvert")
    if found is not None:
        return found
    package = find_spec("sumo")
    for folder in [] if package is None else package.submodule_search_locations or ():
        program = Path(folder) / "bin" / ("netconvert.exe" if os.name == "nt" else "netconvert")
        if program.is_file():
            return str(program)
    return None


def convert(content: bytes, origin: str) -> Converted:
    """Return the map of an OpenDRIVE or OpenStreetMap file.

    Args:
        content: the file.
        origin: its name, which opens every message and whose ending says the format.

    Raises:
        ProfileError: not such a file, netconvert is missing or refuses it, or no car can drive on what comes out.
    """
    suffix = Path(origin).suffix.lower()
    if suffix not in ROOTS:
        raise ProfileError(f"{origin}: file: value {suffix or 'without an ending'}: one of {', '.join(sorted(ROOTS))}")
    source: Counter[str] = Counter()
    root = ROOTS[suffix]
    read_elements(content, origin, root, lambda element: _count(source, element))
    with tempfile.TemporaryDirectory(prefix="simconsole-net-") as folder:
        path = Path(folder) / f"source{suffix}"
        path.write_bytes(content)
        net, said = _run([*_OPTIONS[suffix], str(path)], Path(folder), origin)
    road_map = read_net(net, origin)
    return Converted(net, road_map, (*_losses(root, source, road_map), *_warnings(said)))


def build(network: PlainNetwork, origin: str) -> bytes:
    """Return the network that netconvert builds from plain files.

    Raises:
        ProfileError: netconvert is missing, or refuses them.
    """
    with tempfile.TemporaryDirectory(prefix="simconsole-net-") as folder:
        options = list(_BUILD_OPTIONS)
        for number, (option, text) in enumerate(network.texts().items()):
            path = Path(folder) / f"plain{number}.xml"
            path.write_text(text, encoding="utf-8")
            options += [option, str(path)]
        net, _ = _run(options, Path(folder), origin)
    return _COMMENT.sub(b"", net)


def _run(options: Sequence[str], folder: Path, origin: str) -> tuple[bytes, str]:
    program = netconvert()
    if program is None:
        raise ProfileError(f"{origin}: netconvert: value missing: install the extra `sumo`, or SUMO itself")
    net = folder / "map.net.xml"
    words = [program, *options, *_ALWAYS, "--output-file", str(net)]
    try:
        done = subprocess.run(words, capture_output=True, cwd=folder, stdin=subprocess.DEVNULL, timeout=MAX_S)
    except subprocess.TimeoutExpired:
        raise ProfileError(f"{origin}: netconvert: value not done after {MAX_S:g} s: a smaller map") from None
    except OSError as error:
        raise ProfileError(f"{origin}: netconvert: {error.strerror}: a program that runs") from None
    said = done.stderr.decode(errors="replace")
    if done.returncode or not net.is_file():
        errors = [line for line in said.splitlines() if line.startswith("Error:")]
        reason = ascii(errors[0].removeprefix("Error: "))[1:-1] if errors else f"it ended with {done.returncode}"
        raise ProfileError(f"{origin}: netconvert: {reason[:200]}")
    return net.read_bytes(), said


def _count(source: Counter[str], element: Element) -> None:
    source[element.name] += 1
    if element.name == "road":
        for part in element.children:
            for one in part.children:
                if part.name == "objects" and one.attributes.get("type") == "crosswalk":
                    source["crosswalk"] += 1
                elif part.name == "signals":
                    source["signal"] += 1
    for tag in element.children if element.name == "node" else ():
        kind = tag.attributes.get("k"), tag.attributes.get("v")
        source["crosswalk"] += kind == ("highway", "crossing")
        source["signal"] += kind == ("highway", "traffic_signals")


def _losses(root: str, source: Counter[str], road_map: RoadMap) -> tuple[str, ...]:
    counts = dict(road_map.report.counts)
    told = list(_ALWAYS_LOST[root])
    if source["crosswalk"] > counts["crossings"]:
        told.append(f"crossings: {counts['crossings']} of {source['crosswalk']}")
    if source["signal"] > counts["signals"]:
        told.append(f"signals: {source['signal']} in the file, {counts['signals']} controls in the map")
    return tuple(told)


def _warnings(said: str) -> list[str]:
    """Return netconvert's warnings, those that differ by names and numbers only once, with their count."""
    texts = [line.removeprefix("Warning: ") for line in said.splitlines() if line.startswith("Warning:")]
    alike = Counter(_QUOTED.sub("..", text) for text in texts)
    most = [f"netconvert, {count} times: {ascii(text)[1:-1][:160]}" for text, count in alike.most_common(MOST_WARNINGS)]
    return most + ([f"netconvert: {len(alike) - MOST_WARNINGS} more kinds"] if len(alike) > MOST_WARNINGS else [])
