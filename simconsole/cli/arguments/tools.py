"""The commands for cockpits, worlds, bridges, buses and machines."""

from typing import Any, Final

from simconsole.cli.arguments.subparser import command

NEW_KINDS: Final = ("controller", "driver", "scenario", "vehicle", "platform", "metric", "world", "place", "session")
"""Kinds of templates; driver, platform, metric and place are packages that register themselves."""


def tools(commands: Any) -> None:
    """Add devices, world, bridge, new and doctor."""
    _devices(commands)
    _world(commands)
    _bridge(commands)
    new = command(
        commands, "new", "new.new_command:new", "a template that runs at once, with a test beside it, or an example"
    )
    new.add_argument("kind", choices=(*NEW_KINDS, "example"))
    new.add_argument("name", metavar="NAME", help="lower-case letters, digits and _; of an example: its name")
    new.add_argument("--out", metavar="DIR", default=".", help="where (default: here)")
    command(commands, "doctor", "doctor:doctor", "what this machine has and lacks")


def _devices(commands: Any) -> None:
    devices = command(commands, "devices", "devices:devices", "the cockpit: accept a new one, or one step of it")
    devices.add_argument(
        "action", choices=("list", "check", "calibrate", "feel", "identify", "accept", "record", "speakers")
    )
    devices.add_argument("--cockpit", default="t500rs_th8rs", metavar="PROFILE", help="a name, or a .yaml file")
    devices.add_argument("--virtual", action="store_true", help="attach the cockpit's devices as virtual ones first")
    devices.add_argument(
        "--for",
        dest="duration_s",
        type=float,
        default=10.0,
        metavar="S",
        help="check, record: for how long (default: 10)",
    )
    devices.add_argument("--strength", type=int, metavar="PERCENT", help="feel, identify: of the motor's torque")
    devices.add_argument("--weight", type=float, metavar="KG", help="identify, accept: on the rim, gives the scale")
    devices.add_argument("--radius", type=float, default=0.14, metavar="M", help="... so far from the hub (0.14)")
    devices.add_argument("--device", metavar="NAME", help="speakers: a sound device by name (default: the system's)")
    devices.add_argument("--out", metavar="FILE", help="record: trace.csv; accept: its folder; else the new profile")


def _world(commands: Any) -> None:
    world = command(commands, "world", "world:world", "worlds to drive in: list, show, import or export a map")
    world.add_argument("action", choices=("list", "show", "import", "export"))
    world.add_argument(
        "name",
        nargs="?",
        metavar="WORLD",
        help="`show`: by name, a .yaml or .net.xml file; `import`: an .xodr or .osm file (extra `sumo`), or "
        "a ROS map's map.yaml; `export`: an arena, as a ROS map",
    )
    world.add_argument("--out", metavar="DIR", help="where `import` and `export` write (default: here)")
    world.add_argument("--resolution", type=float, default=0.05, metavar="M", help="export: size of a cell (0.05)")


def _bridge(commands: Any) -> None:
    bridge = command(commands, "bridge", "rosbridge:bridge", "rosbridge: serve it alone, check any server")
    bridge.add_argument("action", choices=("serve", "check", "bench", "cert"))
    bridge.add_argument(
        "url", nargs="?", metavar="URL", help="the server to `check` (a token: SIMCONSOLE_TOKEN) or `bench`"
    )
    bridge.add_argument("--host", default="127.0.0.1", metavar="H")
    bridge.add_argument("--port", type=int, default=9090, metavar="P")
    bridge.add_argument("--for", dest="duration_s", type=float, metavar="S")
    bridge.add_argument("--tokens", metavar="FILE", help="lines of `ROLE TOKEN`: view, publish or control")
    bridge.add_argument("--certificate", metavar="FILE", help="speak TLS only; its key stands beside it as .key")
    bridge.add_argument("--messages", metavar="DIR", help="own types: PACKAGE/msg/NAME.msg, .srv, .action")
    bridge.add_argument("--ros2", action="store_true", help="join the ROS 2 graph of this machine too (needs rclpy)")
    bridge.add_argument(
        "--transport",
        choices=("websockets", "picows"),
        default="websockets",
        metavar="LIBRARY",
        help="what carries clients: websockets, or picows (extra `picows`)",
    )
    bridge.add_argument(
        "--origin",
        action="append",
        default=[],
        metavar="ORIGIN",
        help="`serve` pages from there too: https://lab.example, file://, null, app://-",
    )
    bridge.add_argument(
        "--limit",
        action="append",
        default=[],
        metavar="NAME=NUMBER",
        help="`serve` with another limit of the profile's outputs.bridge.limits: message_bytes=20000000",
    )
    bridge.add_argument("--trust-network", action="store_true", help="other machines need no token and no TLS")
    bridge.add_argument("--out", metavar="DIR", default=".", help="where `cert` writes")


def can(commands: Any) -> None:
    """Add can."""
    can = command(commands, "can", "can:can", "the CAN bus: watch it, be an ECU on it, play a log back")
    can.add_argument("action", choices=("monitor", "send", "replay"))
    can.add_argument("--interface", metavar="I", help="a back end of python-can (default: udp_multicast)")
    can.add_argument("--channel", metavar="C", help="what that back end calls its channel")
    can.add_argument("--port", type=int, metavar="P", help="UDP port of udp_multicast")
    can.add_argument("--bitrate", type=int, metavar="BPS")
    can.add_argument("--for", dest="duration_s", type=float, metavar="S", help="monitor, send: end after S seconds")
    can.add_argument("--file", metavar="FILE", help="replay: the log (.blf, .log); monitor: keep one there")
    can.add_argument("--node", choices=("ECU", "CONSOLE"), default="ECU", help="replay: whose messages")
    can.add_argument("--speed", type=float, default=1.0, metavar="X", help="replay: times as fast")
    can.add_argument("--road-wheel-deg", type=float, default=0.0, metavar="DEG", help="send: left-positive")
    can.add_argument("--accel", dest="accel_mps2", type=float, default=0.0, metavar="MPS2", help="send")
    can.add_argument("--hold", dest="speed_mps", type=float, metavar="MPS", help="send: hold this speed instead")
    can.add_argument("--direction", choices=("drive", "neutral", "reverse"), default="drive", help="send")
    can.add_argument("--turn-indicators", choices=("left", "off", "right"), default="off", help="send")
    can.add_argument("--hazard-lights", action="store_true", help="send")
    can.add_argument("--engage", action="store_true", help="send: ask for autonomy until it is granted")
    requests = ("REQUEST_MANUAL", "REQUEST_SHARED", "REQUEST_TAKEOVER", "EMERGENCY_STOP", "RESET", "MARK")
    can.add_argument("--request", choices=requests, help="send: ask for this once")


def lookup(commands: Any) -> None:
    """Add list and explain."""
    names = "names of sessions, worlds, vehicles, scenarios, cockpits, languages"
    listing = command(commands, "list", "lookup.listing:listing", names)
    listing.add_argument("kind", nargs="?", metavar="KIND", help="only those of one kind (default: all)")
    explain = command(commands, "explain", "lookup.explain:explain", "what a key of a profile means, and its schemas")
    explain.add_argument(
        "key", nargs="?", metavar="KEY", help="steering.ratio, session.vehicle, session (default: the kinds of files)"
    )
    explain.add_argument("--schemas", metavar="DIR", help="write the JSON Schemas of all kinds of files, for editors")
