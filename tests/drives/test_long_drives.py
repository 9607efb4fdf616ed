"""Long drives in little memory: no command holds a whole one."""

import shutil
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import pytest

from simconsole.recording.bundles.bundle import BundleWriter, open_bundle
from simconsole.recording.bundles.manifest import read_manifest
from simconsole.values.signals import Mode
from tests.drives.private_memory import Watched, watched
from tests.samples import Sample

COMMANDS = (("report",), ("view", "--no-open"), ("replay",), ("verify",), ("compare",))
MB = 1_000_000
BAR_BYTES = 400 * MB
KEPT_BYTES = 100
"""What a command of KEEPING may keep of a tick; a state vector has twenty times as much."""
KEEPING = ("report", "view")
"""A report keeps a few columns of the track. Of each chunk in a scene's file rerun keeps an entry, until it has written
them at the end: 0.12 MB for 2,048 ticks."""
ALLOCATOR_BYTES = 4 * MB
SESSION = """\
schema: 1
title: A long drive
environment: {world: urban}
scenario: {vehicle: hatchback}
features: {autopilot: urban}
outputs: {bridge: {port: 0}, hud: null, scene: null, report: false}
devices:
  cockpit: t500rs_th8rs
  driver: virtual
  person: {title: hands over, sit_s: 0.3, cruise_kmh: 15, top_gear: 3, autonomy: {distance_m: 2}}
mode: {tick_hz: 250, pacing: lockstep, answer_timeout_s: 60}
"""


def begun(bundle: Path, folder: Path, ticks: int) -> Path:
    """Return a bundle of the first ticks of a drive."""
    log = open_bundle(bundle).log
    texts = {"session.json": (bundle / "session.json").read_text("utf-8")}
    with BundleWriter(folder, log.header, texts) as writer:
        for record in islice(log, ticks):
            writer.log.append(record.tick, record.vector)
        writer.finish({})
    return folder


class Whole(NamedTuple):
    """A drive of which a quarter is like the whole: by the autopilot, but for the beginning."""

    seconds: int
    bundle: Path
    found: Watched

    @property
    def ticks(self) -> int:
        return read_manifest(self.bundle).ticks


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory, module_sample: Sample) -> Whole:
    return driven(tmp_path_factory.mktemp("whole"), module_sample.of(48, 260))


def driven(folder: Path, seconds: int) -> Whole:
    """Drive so long by the program, and pack."""
    (folder / "session.yaml").write_text(SESSION)
    words = ("drive", folder / "session.yaml", "--for", seconds, "--out", folder / "bundle")
    found = watched(folder / "said", *words)
    assert found.done.returncode == 0, found.done.stdout + found.done.stderr
    return Whole(seconds, folder / "bundle", found)


@pytest.fixture(scope="module")
def parts(whole: Whole) -> tuple[Path, Path]:
    """The first quarter of that drive, and all of it, neither packed."""
    folder, ticks = whole.bundle.parent, whole.ticks
    modes = open_bundle(whole.bundle).log.table(("arbitration.mode",)).column("arbitration.mode")
    assert (modes[ticks // 8 :] == Mode.AUTONOMOUS).all()
    return begun(whole.bundle, folder / "short", ticks // 4), begun(whole.bundle, folder / "long", ticks)


@pytest.mark.timeout(900)
@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command[0])
def test_four_times_the_drive_takes_no_more_memory(
    command: tuple[str, ...], parts: tuple[Path, Path], tmp_path: Path, record_property: Callable[[str, object], None]
) -> None:
    """But for the little that a report and a scene keep of each tick."""
    short, long = (Path(shutil.copytree(part, tmp_path / part.name)) for part in parts)
    seen = []
    for bundle in (short, long):
        again = (bundle,) if command[0] == "compare" else ()
        found = watched(tmp_path / "said", *command, bundle, *again)
        assert found.done.returncode == 0, found.done.stdout + found.done.stderr
        seen.append(found)
    more = read_manifest(long).ticks - read_manifest(short).ticks
    allowed = ALLOCATOR_BYTES + (KEPT_BYTES * more if command[0] in KEEPING else 0)
    grown = [seen[1].own.written - seen[0].own.written, seen[1].child.written - seen[0].child.written]
    told = ", ".join(f"{size / MB:+.1f} MB" for size in grown)
    record_property(f"{command[0]} of four times the drive", f"{told}, {seen[1].own.all / MB:.0f} MB in all")
    assert max(grown) <= allowed
    assert max(one.all for found in seen for one in (found.own, found.child)) <= BAR_BYTES


@pytest.mark.timeout(4 * 3600)
def test_a_drive_of_two_hours_takes_400_megabytes_in_each_process(
    whole: Whole, tmp_path: Path, sample: Sample, record_property: Callable[[str, object], None]
) -> None:
    """Driven, reported, shown, replayed, verified and compared by the program; 3.6 GB of log.

    The sample is the drive of all tests here, and only driven: the commands are held to the same bar above.
    """
    drive = driven(tmp_path, 7200) if sample.long else whole
    others = [(*command, drive.bundle, *((drive.bundle,) if command[0] == "compare" else ())) for command in COMMANDS]
    seen = [("drive", drive.found)]
    seen += [(words[0], watched(tmp_path / "said", *words)) for words in others[: sample.of(0, len(others))]]
    for name, found in seen:
        assert found.done.returncode == 0, found.done.stdout + found.done.stderr
        told = f"{found.own.all / MB:.0f} MB, its child {found.child.all / MB:.0f} MB"
        record_property(f"{name}, private memory, {drive.seconds} s of drive", told)
        assert max(found.own.all, found.child.all) <= BAR_BYTES
    assert drive.ticks == drive.seconds * 250
    if sample.long:
        shutil.rmtree(drive.bundle)
