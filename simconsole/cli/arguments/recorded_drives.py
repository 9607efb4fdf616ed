"""The commands that take recorded drives."""

from typing import Any

from simconsole.cli.arguments.subparser import command


def recordings(commands: Any) -> None:
    """Add what reads, signs, packs and compares bundles."""
    replay = command(
        commands,
        "replay",
        "lookup.bundles:replay",
        "re-simulate bundles; 0 only if every tick is equal",
        "",
        "out/demo-*",
        "out/demo-1 --set body.mass_kg=1600",
    )
    verify = command(
        commands,
        "verify",
        "recordings:verify",
        "check every byte of a bundle, and its signature",
        "out/demo-1",
        "out/demo-1 --signer lab.pub",
    )
    sign = command(
        commands,
        "sign",
        "recordings:sign",
        "sign a bundle, so that nobody changes it unnoticed",
        "--new-key lab.pem",
        "out/demo-1 --key lab.pem",
        "out/demo-1 --remove",
    )
    sign.add_argument("bundle", nargs="?", metavar="BUNDLE", help="the folder that a drive has written")
    sign.add_argument("--key", metavar="FILE", help="the private key to sign with, Ed25519 in PEM")
    sign.add_argument("--name", default="", metavar="TEXT", help="who signs, for people to read")
    sign.add_argument("--new-key", metavar="FILE", help="make a key there, and its public half in FILE.pub")
    sign.add_argument("--remove", action="store_true", help="take the signature away, to change the bundle")
    report = command(
        commands,
        "report",
        "recordings:report",
        "the HTML report of a bundle, or of two side by side",
        "out/demo-1",
        "out/demo-1 out/demo-2 --out both.html",
    )
    view = command(
        commands,
        "view",
        "recordings:view",
        "show a drive in rerun: a bundle's, or the one that goes on",
        "",
        "out/demo-1 --browser",
    )
    replay.add_argument(
        "bundles", nargs="*", metavar="BUNDLE", help="folders that drives have written (default: the newest in out)"
    )
    for one in (verify, report):
        one.add_argument("bundle", metavar="BUNDLE", help="the folder that a drive has written")
    report.add_argument("other", nargs="?", metavar="OTHER", help="another one: both side by side on one page")
    report.add_argument("--out", metavar="FILE", help="with OTHER: the page (default: beside the first bundle)")
    verify.add_argument("--signer", metavar="FILE.pub", help="the public key that must have signed it")
    view.add_argument("bundle", nargs="?", metavar="BUNDLE", help="a drive's folder (default: the drive that goes on)")
    view.add_argument("--no-open", action="store_true", help="only write scene.rrd, or only serve the drive")
    view.add_argument("--browser", action="store_true", help="open it in the browser, served until Ctrl-C")
    view.add_argument("--port", type=int, default=0, help="serve it to native viewers there")
    view.add_argument("--web-port", type=int, default=0, help="and to browsers there (default: free ports)")
    view.add_argument("--memory", default="1GiB", metavar="SIZE", help="what is kept for viewers who join late")
    pack = command(
        commands, "pack", "recordings:pack", "make the logs of bundles small; all commands read both forms", "out/*"
    )
    unpack = command(
        commands, "unpack", "recordings:unpack", "make the logs of packed bundles again, byte for byte", "out/demo-1"
    )
    for one in (pack, unpack):
        one.add_argument("bundles", nargs="+", metavar="BUNDLE", help="the folder that a drive has written")
    compare = command(
        commands,
        "compare",
        "recordings:compare",
        "find every field in which two bundles differ",
        "out/demo-1 out/demo-2",
        "out/demo-1 out/demo-2 --tolerances small.yaml",
    )
    compare.add_argument("bundle", metavar="A", help="the folder that a drive has written")
    compare.add_argument("other", metavar="B", help="that of another drive")
    replay.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="make the drive with this value changed, as body.mass_kg=1600, into a bundle of its own; several times",
    )
    replay.add_argument("--out", metavar="DIR", help="with --set: the new bundle (default: beside the old one)")
    for one in (replay, compare):
        one.add_argument("--tolerances", metavar="FILE", help="YAML or JSON: field or pattern to what may differ")


def exchange(commands: Any) -> None:
    """Add export and import."""
    export = command(
        commands,
        "export",
        "exchange:export_bundle",
        "write a bundle in a format of other tools",
        "out/demo-1 --to csv --columns vehicle.* --rate 50",
        "out/demo-1 --to mcap --layout",
    )
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

    into = command(
        commands,
        "import",
        "exchange:import_bag",
        "make a driver's trace from a bag of any system",
        "lab.bag --topic /joy --out trace.csv",
    )
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


def video(commands: Any) -> None:
    """Add video."""
    video = command(
        commands,
        "video",
        "video:video",
        "a bundle as a video: the road, the instruments, who drives",
        "out/demo-1",
        "out/demo-1 --from 140 --to 150 --camera chase",
        "out/demo-1 --png 140 hand_over.png",
    )
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
