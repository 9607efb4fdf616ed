"""The commands that speak to others: rosbridge and the CAN bus."""

from typing import Any

from simconsole.cli.arguments.subparser import actions, command

_SERVER = "ws://127.0.0.1:9090"


def bridge(commands: Any) -> None:
    """Add bridge."""
    group = actions(commands, "bridge", "rosbridge: serve it alone, check any server")
    _serve(group)
    checks = "test any rosbridge server where servers differ; 1 if it deviates"
    check = command(group, "check", "rosbridge:check", checks, "ws://127.0.0.1:9090")
    check.add_argument(
        "url", nargs="?", default=_SERVER, metavar="URL", help=f"{_SERVER} (default); a token: SIMCONSOLE_TOKEN"
    )
    bench = command(
        group, "bench", "rosbridge:bench", "throughput of our server beside a bare broker, and of another", ""
    )
    bench.add_argument("url", nargs="?", metavar="URL", help="another server, measured in turn with ours")
    bench.add_argument("--for", dest="duration_s", type=float, metavar="S", help="each case for S seconds (default: 1)")
    cert = command(
        group,
        "cert",
        "rosbridge:cert",
        "make a certificate for `serve`, its key and a token",
        "--host 192.168.0.7 --out keys",
    )
    cert.add_argument("--host", default="127.0.0.1", metavar="H", help="the address that it is for (127.0.0.1)")
    cert.add_argument("--out", metavar="DIR", default=".", help="where (default: here)")


def _serve(group: Any) -> None:
    serve = command(
        group,
        "serve",
        "rosbridge:serve",
        "serve rosbridge on a standing car, without ROS, until Ctrl-C",
        "--for 3",
        "--ros2",
    )
    serve.add_argument("--host", default="127.0.0.1", metavar="H", help="at this address (127.0.0.1)")
    serve.add_argument("--port", type=int, default=9090, metavar="P", help="at this port (9090; 0: any free one)")
    serve.add_argument("--for", dest="duration_s", type=float, metavar="S", help="end after S seconds")
    serve.add_argument("--tokens", metavar="FILE", help="lines of `ROLE TOKEN`: view, publish or control")
    serve.add_argument("--certificate", metavar="FILE", help="speak TLS only; its key stands beside it as .key")
    serve.add_argument("--messages", metavar="DIR", help="own types: PACKAGE/msg/NAME.msg, .srv, .action")
    serve.add_argument("--ros2", action="store_true", help="join the ROS 2 graph of this machine too (needs rclpy)")
    serve.add_argument(
        "--transport",
        choices=("websockets", "picows"),
        default="websockets",
        metavar="LIBRARY",
        help="what carries clients: websockets, or picows (extra `picows`)",
    )
    serve.add_argument(
        "--origin",
        action="append",
        default=[],
        metavar="ORIGIN",
        help="pages from there too: https://lab.example, file://, null, app://-",
    )
    serve.add_argument(
        "--limit",
        action="append",
        default=[],
        metavar="NAME=NUMBER",
        help="another limit of the profile's outputs.bridge.limits: message_bytes=20000000",
    )
    serve.add_argument("--trust-network", action="store_true", help="other machines need no token and no TLS")


def can(commands: Any) -> None:
    """Add can."""
    group = actions(commands, "can", "the CAN bus: watch it, be an ECU on it, play a log back")
    monitor = command(
        group,
        "monitor",
        "can:can",
        "show every message with its states, decoded and judged",
        "--for 10",
        "--interface socketcan --channel can0 --file drive.blf",
    )
    send = command(
        group, "send", "can:can", "be the ECU that drives, closed loop on the console's motion", "--engage --hold 8"
    )
    replay = command(
        group, "replay", "can:can", "send one node's frames of a log again, as they were", "--file drive.blf --speed 2"
    )
    for one in (monitor, send, replay):
        one.add_argument("--interface", metavar="I", help="a back end of python-can (default: udp_multicast)")
        one.add_argument("--channel", metavar="C", help="what that back end calls its channel")
        one.add_argument("--port", type=int, metavar="P", help="UDP port of udp_multicast")
        one.add_argument("--bitrate", type=int, metavar="BPS", help="of a bus that needs it said")
    for one in (monitor, send):
        one.add_argument("--for", dest="duration_s", type=float, metavar="S", help="end after S seconds")
    monitor.add_argument("--file", metavar="FILE", help="keep a log there (.blf, .log)")
    replay.add_argument("--file", required=True, metavar="FILE", help="the log (.blf, .log)")
    replay.add_argument("--node", choices=("ECU", "CONSOLE"), default="ECU", help="whose messages (default: ECU)")
    replay.add_argument("--speed", type=float, default=1.0, metavar="X", help="times as fast")
    send.add_argument("--road-wheel-deg", type=float, default=0.0, metavar="DEG", help="steer, left-positive")
    send.add_argument("--accel", dest="accel_mps2", type=float, default=0.0, metavar="MPS2", help="accelerate")
    send.add_argument("--hold", dest="speed_mps", type=float, metavar="MPS", help="hold this speed instead")
    send.add_argument("--direction", choices=("drive", "neutral", "reverse"), default="drive", help="the gear")
    send.add_argument("--turn-indicators", choices=("left", "off", "right"), default="off", help="which one blinks")
    send.add_argument("--hazard-lights", action="store_true", help="both")
    send.add_argument("--engage", action="store_true", help="ask for autonomy until it is granted")
    requests = ("REQUEST_MANUAL", "REQUEST_SHARED", "REQUEST_TAKEOVER", "EMERGENCY_STOP", "RESET", "MARK")
    send.add_argument("--request", choices=requests, help="ask for this once")
