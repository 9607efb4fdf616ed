"""The command for cockpits."""

from typing import Any

from simconsole.cli.arguments.subparser import actions, command


def devices(commands: Any) -> None:
    """Add devices."""
    group = actions(commands, "devices", "the cockpit: accept a new one, or one step of it")
    does = "devices:devices"
    listing = command(group, "list", does, "every joystick and the roles it plays", "", "--virtual")
    check = command(group, "check", does, "live bars; 1 and a line for all that is wrong", "--virtual --for 2")
    calibrate = command(
        group, "calibrate", does, "learn rest, range and direction of each axis, and buttons", "--out cockpit.yaml"
    )
    feel = command(group, "feel", does, "each force once, gently, the sign first", "--cockpit cockpit.yaml")
    identify = command(
        group,
        "identify",
        does,
        "find the motor's delay, inertia and friction, hands off",
        "--weight 1 --out known.yaml",
    )
    accept = command(group, "accept", does, "the guided first test of a whole cockpit", "--weight 1 --out acceptance")
    record = command(group, "record", does, "a trace for `drive --driver trace:FILE`", "--for 30 --out trace.csv")
    speakers = command(group, "speakers", does, "name the sound devices, and a tone from each loudspeaker", "")
    for one in (listing, check, calibrate, feel, identify, accept, record):
        one.add_argument("--cockpit", default="t500rs_th8rs", metavar="PROFILE", help="a name, or a .yaml file")
        one.add_argument("--virtual", action="store_true", help="attach the cockpit's devices as virtual ones first")
    for one in (check, record):
        one.add_argument("--for", dest="duration_s", type=float, default=10.0, metavar="S", help="how long (10)")
    for one, percent in ((feel, 25), (identify, 40)):
        one.add_argument("--strength", type=int, metavar="PERCENT", help=f"of the motor's torque ({percent})")
    for one in (identify, accept):
        one.add_argument("--weight", type=float, metavar="KG", help="on the rim, gives the scale")
        one.add_argument("--radius", type=float, default=0.14, metavar="M", help="... so far from the hub (0.14)")
    speakers.add_argument("--device", metavar="NAME", help="a sound device by name (default: the system's)")
    calibrate.add_argument("--out", metavar="FILE", help="the new profile (default: cockpit.yaml)")
    identify.add_argument("--out", metavar="FILE", help="the profile with what was found (default: only told)")
    accept.add_argument("--out", metavar="DIR", help="report and profile (default: acceptance)")
    record.add_argument("--out", metavar="FILE", help="the trace (default: trace.csv)")
