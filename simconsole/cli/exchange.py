"""`simconsole export | import`: drives into formats of other tools, recordings of others into a driver's trace."""

from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING

from simconsole.cli.outcome import Outcome, table
from simconsole.cli.progress import Progress
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session

if TYPE_CHECKING:
    from simconsole.recording.exports.column_table import TableChoice


def export_bundle(options: Namespace) -> Outcome:
    """Write a bundle in another format; code 1 where the recording is not the whole drive.

    Raises:
        RecordingError: no bundle, the target exists or cannot be written, or no such column.
        ProfileError: the bundle's session was altered into something that is none.
    """
    from simconsole.recording.exports.export_formats import default_path, export_drive
    from simconsole.session.robots import robot_at_work

    bundle = open_bundle(Path(options.bundle))
    resolved = recorded_session(bundle)
    path = Path(options.out) if options.out else default_path(Path(options.bundle), options.to)
    with Progress(f"exporting to {options.to}") as progress:
        done = export_drive(
            bundle.log,
            resolved.session,
            options.to,
            path,
            _choice(options),
            options.layout,
            lambda tick: progress.count(tick, bundle.manifest.ticks),
            resolved.world,
            robot_at_work(resolved.vehicle, resolved.world),
        )
    problems = bundle.problems()
    rows = [(name, f"{count}") for name, count in done.counts.items()]
    written = [str(one) for one in (done.path, done.layout) if one is not None]
    results = {"path": str(done.path), "counts": done.counts, "layout": written[1:], "problems": problems}
    return Outcome(1 if problems else 0, results, "\n".join((table(rows), *written, *problems)))


def _choice(options: Namespace) -> "TableChoice | None":
    """Return what of the drive becomes a table; None where nothing was said, as for topics."""
    from simconsole.recording.exports.column_table import TableChoice

    said = (options.columns, options.rate_hz, options.units, options.labels)
    if not any(value is not None and value is not False for value in said):
        return None
    return TableChoice(tuple(options.columns or ("*",)), options.rate_hz, options.units == "display", options.labels)


def import_bag(options: Namespace) -> Outcome:
    """Turn a bag's joystick messages into a trace that `--driver trace:FILE` plays.

    Raises:
        RecordingError: no bag, damaged, or without such a topic.
        ProfileError: the cockpit or a mapping cannot be used.
        DeviceError: the trace cannot be written.
    """
    from simconsole.profiles.device import CockpitProfile
    from simconsole.profiles.files.loader import load
    from simconsole.recording.imports.driver_trace import joy_mapping, write_trace

    cockpit = load("devices", options.cockpit, CockpitProfile)
    mapping = joy_mapping(options.axes, options.buttons, cockpit)
    with Progress("importing") as progress:
        ticks = write_trace(
            Path(options.bag),
            Path(options.out),
            mapping,
            topic=options.topic,
            tick_hz=options.tick_hz,
            cockpit=options.cockpit,
            on_tick=progress.count,
        )
    results = {"trace": options.out, "ticks": ticks, "tick_hz": options.tick_hz}
    return Outcome(0, results, f"{options.out}: {ticks} ticks at {options.tick_hz} Hz")
