"""The command line: arguments in, one command run, an exit code out.

Exit codes: 0 good, 1 the check failed, 2 bad usage or a bad file, 130 interrupted. `--json` makes the last line on
standard output one JSON object with the results. No heavy library is imported here: each command names the function
that does it, loaded when it is called.
"""

import argparse
import os
import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any, TextIO

from simconsole import __version__
from simconsole.drivers.path_tracker.tracker_settings import GATE, TRACKERS
from simconsole.processes.lifetimes import (
    ATTACHED,
    INTERRUPTED,
    SIGNALS,
    act_promptly,
    end_at_once,
    handle,
    handled,
    ignore_signals,
    interrupted,
)
from simconsole.values.errors import SimConsoleError, one_line

_MAX_DELAY_MS = 6000.0  # the longest delay that a session's link may have each way, and its jitter on average
_AT_ONCE = ("demo", "drive", "bridge", "report", "view", "pack", "unpack")
"""Commands that Ctrl-C ends at once unless a drive handles it itself: they leave nothing half made. In the others it
raises KeyboardInterrupt, which for some is the normal way to their result."""


def parser() -> argparse.ArgumentParser:
    """Return the parser of every command."""
    root = argparse.ArgumentParser(
        prog="simconsole", description="A hardware-in-the-loop driving-simulator console.", allow_abbrev=False
    )
    root.add_argument("--version", action="version", version=f"simconsole {__version__}")
    commands = root.add_subparsers(dest="command", required=True, metavar="COMMAND")
    _driving(commands)
    _beside_a_drive(commands)
    _recordings(commands)
    _exchange(commands)
    _video(commands)
    _tools(commands)
    _can(commands)
    return root


def main(arguments: list[str] | None = None) -> int:
    """Run one command and return its exit code. Errors a user can cause are one line on standard error."""
    options = parser().parse_args(arguments)
    signals = SIGNALS if options.command in _AT_ONCE else SIGNALS[1:]
    if arguments is None:
        act_promptly()
        handle(interrupted, signals)
        code = _run(options)
        ignore_signals()  # all is done: a signal must not change the exit code while Python shuts down
        if code == INTERRUPTED:
            end_at_once(code)  # whoever interrupted waits for the end
        return code
    with handled(interrupted, signals):
        return _run(options)


def _run(options: argparse.Namespace) -> int:
    module, function = options.does.split(":")
    try:
        outcome = getattr(import_module(f"simconsole.cli.{module}"), function)(options)
    except SimConsoleError as error:
        _print(f"simconsole {options.command}: {error}", sys.stderr)
        if options.json:
            _print_json({"error": str(error)})
        return error.exit_code
    except (MemoryError, OSError, ImportError) as error:  # limits of the machine, files, libraries: no bug here
        _print(f"simconsole {options.command}: {one_line(error)}", sys.stderr)
        if options.json:
            _print_json({"error": one_line(error)})
        return SimConsoleError.exit_code
    except KeyboardInterrupt:
        return INTERRUPTED
    if outcome.text:
        _print(outcome.text)
    if options.json:
        _print_json(outcome.results)
    return int(outcome.code)


def _print_json(results: dict[str, Any]) -> None:
    import orjson

    _print(orjson.dumps(results, option=orjson.OPT_SERIALIZE_NUMPY).decode())


def _print(text: str, file: TextIO | None = None) -> None:
    stream = sys.stdout if file is None else file
    try:
        print(text, file=stream, flush=True)
    except OSError:  # closed terminal, pipe without a reader: drop this, and what Python flushes at its end
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _command(commands: Any, name: str, does: str, summary: str) -> argparse.ArgumentParser:
    command: argparse.ArgumentParser = commands.add_parser(name, help=summary, description=summary, allow_abbrev=False)
    command.set_defaults(does=does)
    command.add_argument("--json", action="store_true", help="print the results as one JSON object on the last line")
    return command


def _number(least: float, most: float, unit: str) -> Callable[[str], float]:
    """Return what reads a number within bounds."""

    def number(text: str) -> float:
        value = float(text)
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"{text}: {least:g} to {most:g} {unit}")
        return value

    return number


def _driving(commands: Any) -> None:
    demo = _command(commands, "demo", "demo:demo", "the whole way once, with no hardware: person, autopilot, report")
    demo.add_argument("--perfect", action="store_true", help="exact odometry and no delay on the autopilot's link")
    demo.add_argument("--realtime", action="store_true", help="pace it, with every worker in its own process")
    demo.add_argument("--out", metavar="DIR", help="where the bundle goes (default: out/demo-TIME)")

    drive = _command(commands, "drive", "drive:drive", "drive a session")
    drive.add_argument(
        "session", nargs="?", default="seated", metavar="SESSION", help="by name, or a .yaml file (default: seated)"
    )
    drive.add_argument("--headless", action="store_true", help="no window, as fast as it goes")
    drive.add_argument("--choose", action="store_true", help="ask what to drive with, and where")
    drive.add_argument("--driver", metavar="D", help="sdl | virtual | trace:F | script:F | keyboard | none")
    drive.add_argument("--person", type=int, metavar="SEED", help="with the driver virtual: which simulated person")
    drive.add_argument("--commands", metavar="C", help="bag:FILE[:TOPIC]: recorded commands in place of a controller's")
    drive.add_argument("--cockpit", metavar="PROFILE", help="a cockpit by name, or the file that `calibrate` wrote")
    drive.add_argument("--language", metavar="L", help="of the display: english, german, or a .yaml file")
    drive.add_argument("--for", dest="duration_s", type=float, metavar="S", help="end after S simulated seconds")
    drive.add_argument("--out", metavar="DIR", help="where the bundle goes (default: out/drive-TIME)")
    drive.add_argument("--participant", default="", metavar="ID", help="who drives; kept in the bundle from the start")
    drive.add_argument("--trial", default="", metavar="ID", help="which of their drives")
    drive.add_argument("--note", action="append", default=[], metavar="TEXT", help="may be given several times")
    for command in (demo, drive):
        command.add_argument("--no-pack", action="store_true", help="leave the log as it was written")

    check = _command(commands, "check", "check:check", "drive scripted scenarios headless against their goldens")
    check.add_argument("scenarios", nargs="+", metavar="SCENARIO", help="by name, or a .yaml file")
    check.add_argument("--jobs", type=int, default=1, metavar="N", help="drive N at a time")
    check.add_argument("--report", metavar="FILE", help="write values and plots of the test manoeuvres as HTML")
    check.add_argument("--junit", metavar="FILE", help="write a JUnit report")
    check.add_argument("--review", metavar="FILE", help="write accepted and driven over each other, where they differ")
    check.add_argument("--update-golden", action="store_true", help="accept what was driven as the new golden")


def _beside_a_drive(commands: Any) -> None:
    operate = _command(commands, "operate", "operate:operate", "an operator's act in a running drive")
    acts = (
        "start",
        "pause",
        "restart",
        "autonomous",
        "manual",
        "shared",
        "takeover",
        "fault",
        "mark",
        "reset",
        "estop",
        "anti_lock",
        "traction",
        "stability",
    )
    operate.add_argument("act", choices=acts, metavar="ACT", help=", ".join(acts))
    operate.add_argument("--note", default="", metavar="TEXT", help="kept with the drive")
    operate.add_argument("--participant", default="", metavar="ID")
    operate.add_argument("--trial", default="", metavar="ID")
    operate.add_argument(
        "--url",
        default="ws://127.0.0.1:9090",
        metavar="URL",
        help="the console's rosbridge server (a token of role control, if it asks for one: SIMCONSOLE_TOKEN)",
    )
    operate.add_argument("--namespace", default="", metavar="NS", help="of the console's topics")

    autopilot = _command(commands, "autopilot", "remote:autopilot", "the path tracker, as a ROS-side program")
    autopilot.add_argument("--url", default="ws://127.0.0.1:9090", metavar="URL")
    autopilot.add_argument("--course", default="urban", metavar="WORLD")
    autopilot.add_argument("--vehicle", default="hatchback", metavar="VEHICLE", help="the car that it drives")
    autopilot.add_argument(
        "--delay-ms", type=_number(0.0, _MAX_DELAY_MS, "ms"), default=10.0, metavar="MS", help="from state to effect"
    )
    autopilot.add_argument("--tracker", choices=TRACKERS, default=TRACKERS[0], help="how it steers")
    autopilot.add_argument(
        "--lateral-accel",
        type=_number(0.1, 20.0, "m/s2"),
        default=GATE.lateral_mps2,
        metavar="MPS2",
        help="that the console's gate lets pass",
    )
    autopilot.add_argument(
        "--lateral-jerk",
        type=_number(0.0, 100.0, "m/s3"),
        default=GATE.lateral_jerk_mps3,
        metavar="MPS3",
        help="the same; 0: any",
    )
    autopilot.add_argument("--plan-hz", type=_number(0.0, 20.0, "Hz"), default=0.0, help="how often it tells its plan")
    autopilot.add_argument("--wait", type=float, default=10.0, metavar="S", help="how long to wait for the server")
    autopilot.add_argument("--namespace", default="", metavar="NS", help="of the console's topics")
    autopilot.add_argument("--rename", action="append", default=[], metavar="/TOPIC=/NAME", help="what one is called")
    autopilot.add_argument("--certificate", metavar="PEM", help="of a wss:// server; a token: SIMCONSOLE_TOKEN")
    autopilot.add_argument(ATTACHED, action="store_true", help="end with whoever holds standard input")


def _recordings(commands: Any) -> None:
    replay = _command(commands, "replay", "recordings:replay", "re-simulate a bundle; 0 only if every tick is equal")
    verify = _command(commands, "verify", "recordings:verify", "check every byte of a bundle, and its signature")
    sign = _command(commands, "sign", "recordings:sign", "sign a bundle, so that nobody changes it unnoticed")
    sign.add_argument("bundle", nargs="?", metavar="BUNDLE", help="the folder that a drive has written")
    sign.add_argument("--key", metavar="FILE", help="the private key to sign with, Ed25519 in PEM")
    sign.add_argument("--name", default="", metavar="TEXT", help="who signs, for people to read")
    sign.add_argument("--new-key", metavar="FILE", help="make a key there, and its public half in FILE.pub")
    sign.add_argument("--remove", action="store_true", help="take the signature away, to change the bundle")
    report = _command(commands, "report", "recordings:report", "write the HTML report of a bundle")
    view = _command(commands, "view", "recordings:view", "show a drive in rerun: a bundle's, or the one that goes on")
    for command in (replay, verify, report):
        command.add_argument("bundle", metavar="BUNDLE", help="the folder that a drive has written")
    verify.add_argument("--signer", metavar="FILE.pub", help="the public key that must have signed it")
    view.add_argument("bundle", nargs="?", metavar="BUNDLE", help="a drive's folder (default: the drive that goes on)")
    view.add_argument("--no-open", action="store_true", help="only write scene.rrd, or only serve the drive")
    view.add_argument("--browser", action="store_true", help="open it in the browser, served until Ctrl-C")
    view.add_argument("--port", type=int, default=0, help="serve it to native viewers there")
    view.add_argument("--web-port", type=int, default=0, help="and to browsers there (default: free ports)")
    view.add_argument("--memory", default="1GiB", metavar="SIZE", help="what is kept for viewers who join late")
    pack = _command(commands, "pack", "recordings:pack", "make the logs of bundles small; all commands read both forms")
    unpack = _command(commands, "unpack", "recordings:unpack", "make the logs of packed bundles again, byte for byte")
    for command in (pack, unpack):
        command.add_argument("bundles", nargs="+", metavar="BUNDLE", help="the folder that a drive has written")
    compare = _command(commands, "compare", "recordings:compare", "find every field in which two bundles differ")
    compare.add_argument("bundle", metavar="A")
    compare.add_argument("other", metavar="B")
    replay.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="make the drive with this value changed, as body.mass_kg=1600, into a bundle of its own; several times",
    )
    replay.add_argument("--out", metavar="DIR", help="with --set: the new bundle (default: beside the old one)")
    for command in (replay, compare):
        command.add_argument("--tolerances", metavar="FILE", help="YAML or JSON: field or pattern to what may differ")


def _exchange(commands: Any) -> None:
    export = _command(commands, "export", "exchange:export_bundle", "write a bundle in a format of other tools")
    export.add_argument("bundle", metavar="BUNDLE", help="the folder that a drive has written")
    export.add_argument("--to", required=True, choices=("mcap", "rosbag2", "csv", "parquet"))
    export.add_argument("--out", metavar="PATH", help="the new file or folder (default: beside the bundle)")
    export.add_argument("--columns", nargs="+", metavar="PATTERN", help="csv, parquet: names, * and ? (default: all)")
    export.add_argument(
        "--rate", dest="rate_hz", type=float, metavar="HZ", help="csv, parquet: rows (default: every tick)"
    )
    export.add_argument("--units", choices=("si", "display"), help="csv, parquet: display is deg, km/h, 1/min")
    export.add_argument("--labels", action="store_true", help="csv, parquet: modes and reasons as words")
    export.add_argument("--layout", action="store_true", help="mcap, rosbag2: a layout for Foxglove beside it")

    into = _command(commands, "import", "exchange:import_bag", "make a driver's trace from a bag of any system")
    into.add_argument("bag", metavar="BAG", help="an .mcap, .bag or .db3 file, or a folder of rosbag2")
    into.add_argument("--to", choices=("trace",), default="trace")
    into.add_argument("--out", metavar="FILE", default="trace.csv", help="the trace (default: trace.csv)")
    into.add_argument("--topic", metavar="TOPIC", help="which sensor_msgs/Joy (default: the only one)")
    rates = (50, 100, 125, 200, 250, 500, 1000)
    into.add_argument(
        "--tick-hz", type=int, default=250, choices=rates, metavar="HZ", help="of the session that plays it"
    )
    into.add_argument("--cockpit", default="t500rs_th8rs", metavar="PROFILE", help="whose axes the trace then has")
    into.add_argument("--axes", metavar="MAP", help="such as wheel=-0,throttle=2: place of each axis, - turns it round")
    into.add_argument("--buttons", metavar="MAP", help="such as wheel=0:13,shifter=13:10: first place and number")


def _video(commands: Any) -> None:
    video = _command(commands, "video", "video:video", "a bundle as a video: the road, the instruments, who drives")
    video.add_argument("bundle", metavar="BUNDLE", help="the folder that a drive has written")
    video.add_argument("--out", metavar="FILE", help="the new .mp4 (default: BUNDLE.mp4, beside the bundle)")
    video.add_argument("--camera", choices=("driver", "chase", "bird"), default="driver")
    video.add_argument("--size", default="1280x720", metavar="WxH", help="pixels (default: 1280x720)")
    video.add_argument("--from", dest="from_s", type=float, default=0.0, metavar="S", help="simulated seconds")
    video.add_argument("--to", dest="to_s", type=float, metavar="S", help="simulated seconds (default: the end)")
    video.add_argument("--fps", type=int, default=30, metavar="N", help="frames a second (default: 30)")
    video.add_argument("--night", action="store_true", help="by the light of the headlamps")
    video.add_argument("--language", metavar="L", help="of the display, if not the drive's own")
    video.add_argument("--large-text", action="store_true", help="as outputs.hud.large_text")
    video.add_argument("--rich", action="store_true", help="mirrors and shadows also where the processor draws: slow")
    video.add_argument("--png", nargs=2, metavar=("S", "FILE"), help="no video: one picture, of this simulated second")


def _can(commands: Any) -> None:
    can = _command(commands, "can", "can:can", "the CAN bus: watch it, be an ECU on it, play a log back")
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


def _tools(commands: Any) -> None:
    devices = _command(commands, "devices", "devices:devices", "the cockpit: accept a new one, or one step of it")
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

    world = _command(commands, "world", "world:world", "worlds to drive in: list, show, import or export a map")
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

    bridge = _command(commands, "bridge", "rosbridge:bridge", "rosbridge: serve it alone, check any server")
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

    new = _command(commands, "new", "new.command:new", "a template that runs at once, with a test beside it")
    new.add_argument("kind", choices=("controller", "scenario", "vehicle", "world", "session"))
    new.add_argument("name", metavar="NAME", help="lower-case letters, digits and _")
    new.add_argument("--out", metavar="DIR", default=".", help="where (default: here)")

    _command(commands, "doctor", "doctor:doctor", "what this machine has and lacks")
