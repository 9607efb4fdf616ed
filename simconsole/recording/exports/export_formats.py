"""The formats that a drive is exported to: one registry, and what holds for all of them.

An export never touches its bundle and lies beside it. It appears under its name only when it is complete.
"""

import shutil
import tempfile
from importlib import import_module
from pathlib import Path
from typing import Final, NamedTuple

from simconsole.bridge.console.published_tick import RobotTable
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.world import WorldProfile
from simconsole.recording.exports.column_table import ColumnTable, TableChoice
from simconsole.recording.exports.drive_topics import DriveTopics, OnTick
from simconsole.recording.exports.foxglove import foxglove_layout
from simconsole.recording.own_signals import with_own_signals
from simconsole.recording.reading import Recording
from simconsole.values.errors import RecordingError
from simconsole.world.kinds.worlds import road_signals, route_points, running_signals, shown_map

TOPIC_FORMATS: Final = {"mcap": "mcap_file", "rosbag2": "rosbag2_folder"}
TABLE_FORMATS: Final = {"csv": "csv_file", "parquet": "parquet_file"}
FORMATS: Final = {**TOPIC_FORMATS, **TABLE_FORMATS}
"""Modules of this folder by format: those of topics have `write_topics`, those of tables `write_table`."""
LAYOUT_SUFFIX: Final = ".layout.json"


class Exported(NamedTuple):
    """What was written: `counts` are messages by topic, or the rows of a table; `layout` is Foxglove's, if wanted."""

    path: Path
    counts: dict[str, int]
    layout: Path | None = None


def export_drive(
    recording: Recording,
    session: SessionProfile,
    format_name: str,
    path: Path,
    choice: TableChoice | None = None,
    layout: bool = False,
    on_tick: OnTick = lambda tick: None,
    world: WorldProfile | None = None,
    robot: RobotTable | None = None,
) -> Exported:
    """Write a recorded drive to the new file or folder `path`.

    Args:
        recording: the drive, which is read once, block by block.
        session: the session it was driven with: names and rates of its topics.
        format_name: one of FORMATS.
        path: where; must not exist.
        choice: what of it, for a table; None for all columns in every tick.
        layout: write a layout of Foxglove beside the topics.
        on_tick: told now and then how far it is.
        world: where it was driven: the route and the traffic lights.
        robot: makes the topics of what was driven, where it was a robot.

    Raises:
        RecordingError: `path` exists or cannot be written, or the choice does not fit the format or the recording.
        ProfileError: the session's bridge names or rates topics that do not exist.
    """
    of_topics = format_name in TOPIC_FORMATS
    if of_topics and choice is not None:
        raise RecordingError(f"--to {format_name}: columns, rate, units, labels: only {', '.join(TABLE_FORMATS)}")
    if layout and not of_topics:
        raise RecordingError(f"--to {format_name}: layout: only {', '.join(TOPIC_FORMATS)}")
    layout_path = path.with_name(path.name.removesuffix(".mcap") + LAYOUT_SUFFIX) if layout else None
    for taken in filter(None, (path, layout_path)):
        if taken.exists():
            raise RecordingError(f"{taken}: cannot be exported to: it exists already")
    module = import_module(f"simconsole.recording.exports.{FORMATS[format_name]}")
    topics = None
    if of_topics:
        traffic = session.environment.traffic
        elsewhere = traffic is not None and traffic.sumo is not None
        signals = (running_signals if elsewhere else road_signals)(world, session.mode.tick_hz)
        topics = DriveTopics(session, route_points(world), signals, shown_map(world), robot)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        # A folder of its own to write in, because rosbag2 names its files after its folder.
        with tempfile.TemporaryDirectory(prefix=f".{path.name}.", dir=path.parent) as workshop:
            draft = Path(workshop) / path.name
            if topics is not None:
                counts = module.write_topics(topics.registry, topics.messages(recording, on_tick), draft)
            else:
                counts = module.write_table(
                    ColumnTable(with_own_signals(recording), choice or TableChoice()), draft, on_tick
                )
            if layout_path is not None and topics is not None:
                layout_path.write_bytes(foxglove_layout(topics.names))
            shutil.move(draft, path)
    except OSError as error:
        raise RecordingError(f"{path}: cannot be exported to: {error.strerror or error}") from None
    return Exported(path, counts, layout_path)


def default_path(bundle: Path, format_name: str) -> Path:
    """Return where an export goes unless told otherwise: beside the bundle, under its name."""
    module = import_module(f"simconsole.recording.exports.{FORMATS[format_name]}")
    folder = bundle.resolve()
    return folder.with_name(folder.name + (module.SUFFIX or f"-{format_name}"))
