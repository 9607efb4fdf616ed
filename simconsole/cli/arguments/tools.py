"""The commands for worlds, templates and machines, and the one that lists names."""

from typing import Any, Final

from simconsole.cli.arguments.subparser import actions, command

NEW_KINDS: Final = {
    "controller": ("a controller as a function, driven in lockstep", "follower"),
    "driver": ("a package that registers a controller, which a session names", "keeper"),
    "scenario": ("a scripted drive with its golden", "roundabout"),
    "vehicle": ("a car's parameters, begun from the hatchback's", "van"),
    "platform": ("a package that registers a vehicle of its own equations", "tractor"),
    "metric": ("a package that registers figures of a drive", "comfort"),
    "world": ("a course as a list of elements", "yard"),
    "place": ("a package that registers a kind of world", "quarry"),
    "session": ("a session that drives at once", "evening"),
    "example": ("a copy of one of the project's examples", "lab"),
}
"""Kinds of templates, what each is, and a name for the page of help."""


def tools(commands: Any) -> None:
    """Add world, new, doctor and list."""
    _world(commands)
    kinds = actions(commands, "new", "a template that runs at once, with a test beside it, or an example", "kind")
    for kind, (summary, name) in NEW_KINDS.items():
        new = command(kinds, kind, "new.new_command:new", summary, name)
        new.add_argument(
            "name", metavar="NAME", help="of an example" if kind == "example" else "lower-case letters, digits and _"
        )
        new.add_argument("--out", metavar="DIR", default=".", help="where (default: here)")
    command(commands, "doctor", "doctor:doctor", "what this machine has and lacks", "")
    names = "names of sessions, worlds, vehicles, scenarios, cockpits, languages"
    listing = command(commands, "list", "lookup.listing:listing", names, "", "worlds", "scenarios --json")
    listing.add_argument("kind", nargs="?", metavar="KIND", help="only those of one kind (default: all)")
    about = "what a key of a profile means, and its schemas"
    explain = command(commands, "explain", "lookup.explain:explain", about, "", "steering.ratio", "--schemas schemas")
    explain.add_argument(
        "key", nargs="?", metavar="KEY", help="steering.ratio, session.vehicle, session (default: the kinds of files)"
    )
    explain.add_argument("--schemas", metavar="DIR", help="write the JSON Schemas of all kinds of files, for editors")


def _world(commands: Any) -> None:
    group = actions(commands, "world", "worlds to drive in: list, show, import or export a map")
    command(group, "list", "world:world", "every world with its kind and title", "")
    show = command(group, "show", "world:world", "what a world holds", "urban")
    show.add_argument("name", metavar="WORLD", help="by name, or a .yaml or .net.xml file")
    into = command(
        group, "import", "world:world", "make a world of a map", "town.osm --out worlds", "arena.yaml --out worlds"
    )
    into.add_argument("name", metavar="MAP", help="an .xodr or .osm file (extra `sumo`), or a ROS map's map.yaml")
    out = command(group, "export", "world:world", "write an arena as a ROS map", "arena --out maps")
    out.add_argument("name", metavar="WORLD", help="an arena, by name or a .yaml file")
    for one in (into, out):
        one.add_argument("--out", metavar="DIR", default=".", help="where (default: here)")
    out.add_argument("--resolution", type=float, default=0.05, metavar="M", help="size of a cell (0.05)")
