"""`simconsole world list | show | import | export`: the worlds that can be driven in."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from simconsole.cli.outcome import Outcome, table
from simconsole.profiles.files.loader import read_bytes
from simconsole.profiles.files.titles import listed
from simconsole.profiles.files.world_files import MAX_MAP_BYTES, load_world
from simconsole.profiles.validation import PROFILE_FILES
from simconsole.profiles.world import ArenaProfile, RoadsProfile, WorldProfile
from simconsole.values.errors import ProfileError
from simconsole.values.units import KMH_PER_MPS
from simconsole.world.arena.outlines import bounds, outlines_of
from simconsole.world.kinds.worlds import open_map, open_world
from simconsole.world.roads.road_map import MapReport, RoadMap

_NET = (".net.xml", ".net.xml.gz")
_IMPORTED = """# Made by `simconsole world import` from {source}.
schema: 1
kind: roads
title: {title}
map: {{name: {net}}}
route: {{by: random, seed: 1, length_m: 2000}}
"""


def world(options: Namespace) -> Outcome:
    """Do one of them.

    Raises:
        ProfileError: a profile or a map cannot be used.
    """
    if options.action == "list":
        worlds = listed("worlds")
        return Outcome(
            0, {"worlds": worlds}, table([(one["name"], f"{one['kind']:<7} {one['title']}") for one in worlds])
        )
    if options.action == "show":
        return _show(options.name)
    out = Path(options.out)
    if options.action == "export":
        return _export(options.name, out, options.resolution)
    source = Path(options.name)
    return _import_ros_map(source, out) if source.suffix in PROFILE_FILES else _import(source, out)


def _kind(profile: WorldProfile) -> str:
    return str(profile.__struct_config__.tag)


def _show(name: str) -> Outcome:
    if name.endswith(_NET):
        from simconsole.world.sumo.net_reader import read_net

        return _told({"map": name}, read_net(read_bytes(Path(name), MAX_MAP_BYTES), name), [])
    profile = load_world(name)
    route = open_world(profile).route
    facts = {
        "world": name,
        "kind": _kind(profile),
        "title": profile.title,
        "route": f"{route.length_m:.1f} m, {'closed' if route.closed else 'open'}",
        "limits": " ".join(f"{limit * KMH_PER_MPS:.0f}" for limit in sorted(set(route.limit.tolist()))) + " km/h",
        "tightest bend": f"{1.0 / max(float(abs(route.curvature).max()), 1e-6):.1f} m",
        "along the route": _landmarks([mark.kind for mark in route.landmarks]),
    }
    if isinstance(profile, RoadsProfile):
        return _told(facts, open_map(profile), [])
    if isinstance(profile, ArenaProfile):
        facts = _arena_facts(facts, profile)
    return Outcome(0, {**facts, "length_m": route.length_m}, table(list(facts.items())))


def _arena_facts(facts: dict[str, str], profile: ArenaProfile) -> dict[str, str]:
    west, south, east, north = bounds(outlines_of(profile))
    return {
        **{key: facts[key] for key in ("world", "kind", "title", "route")},
        "size": f"{east - west:.2f} x {north - south:.2f} m",
        "walls": f"{sum(len(wall.sides) for wall in profile.walls)} straight pieces, {len(profile.pillars)} pillars",
        "starts": " ".join(spot.name for spot in profile.starts),
        "targets": " ".join(spot.name for spot in profile.targets) or "none",
    }


def _landmarks(kinds: list[str]) -> str:
    return ", ".join(f"{kinds.count(kind)} {kind}" for kind in dict.fromkeys(kinds)) or "nothing"


def _told(facts: dict[str, str], road_map: RoadMap, losses: list[str]) -> Outcome:
    report, geo = road_map.report, road_map.geo
    rows = [*facts.items(), *((name, str(count)) for name, count in report.counts)]
    rows.append(("fixed things", _landmarks([thing.kind for thing in road_map.obstacles])))
    rows.append(("on the earth", "not said" if geo.projection == "!" else geo.projection))
    lines = [table(rows), *(f"  lost: {loss}" for loss in losses), *_not_read(report)]
    results: dict[str, Any] = {
        **facts,
        "counts": dict(report.counts),
        "obstacles": len(road_map.obstacles),
        "not_read": [part._asdict() for part in report.skipped],
        "losses": losses,
    }
    return Outcome(0, results, "\n".join(lines))


def _not_read(report: MapReport) -> list[str]:
    return [f"  not read: line {part.place}: <{part.element}>: {part.reason}" for part in report.skipped]


def _import(source: Path, folder: Path) -> Outcome:
    from simconsole.world.sumo.netconvert import convert

    done = convert(read_bytes(source, MAX_MAP_BYTES), str(source))
    name = source.name.split(".")[0]
    net, profile = folder / f"{name}.net.xml", folder / f"{name}.yaml"
    for path in (net, profile):
        if path.exists():
            raise ProfileError(f"{path}: file: value taken: a name that is free")
    title = _title(name)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        net.write_bytes(done.net)
        text = _IMPORTED.format(source=ascii(source.name)[1:-1], title=f'"{title}"', net=f'"{net.name}"')
        profile.write_text(text, encoding="utf-8")
    except OSError as error:
        raise ProfileError(f"{folder}: file: {error.strerror}: a folder that can be written to") from None
    return _told({"world": str(profile), "map": str(net)}, done.road_map, list(done.losses))


def _title(name: str) -> str:
    return "".join(letter if letter.isalnum() else " " for letter in name).strip() or "map"


def _import_ros_map(source: Path, folder: Path) -> Outcome:
    from simconsole.world.tools.ros_maps import arena_text, read_ros_map

    name = source.name.split(".")[0]
    profile = folder / f"{name}.arena.yaml"
    if profile.exists():
        raise ProfileError(f"{profile}: file: value taken: a name that is free")
    arena = read_ros_map(source, _title(name))
    try:
        folder.mkdir(parents=True, exist_ok=True)
        profile.write_text(arena_text(arena, ascii(source.name)[1:-1]), encoding="utf-8")
    except OSError as error:
        raise ProfileError(f"{folder}: file: {error.strerror}: a folder that can be written to") from None
    return _show(str(profile))


def _export(name: str, folder: Path, resolution_m: float) -> Outcome:
    from simconsole.world.tools.ros_maps import write_ros_map

    profile = load_world(name)
    if not isinstance(profile, ArenaProfile):
        raise ProfileError(f"{name}: kind: value {_kind(profile)}: arena: a road map is no occupancy grid")
    if not 0.005 <= resolution_m <= 1.0:
        raise ProfileError(f"command line: --resolution: value {resolution_m:g}: 0.005 to 1")
    described, image = write_ros_map(profile, folder, _stem(name), resolution_m)
    facts = {"map": str(described), "image": str(image)}
    return Outcome(0, facts, table(list(facts.items())))


def _stem(name: str) -> str:
    return Path(name).name.split(".")[0]
