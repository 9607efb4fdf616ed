"""Long drives in little memory: no command holds a whole one."""

import shutil
from collections.abc import Callable
from itertools import islice
from pathlib import Path

import pytest

from simconsole.recording.bundles.bundle import BundleWriter, open_bundle
from simconsole.recording.bundles.manifest import read_manifest
from tests.drives.console import simconsole
from tests.drives.private_memory import watched
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
  person: {title: hands over, sit_s: 1.0, cruise_kmh: 36, top_gear: 3, autonomy: {distance_m: 110}}
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


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory, module_sample: Sample) -> Path:
    """A drive of which a quarter is like the whole: by the autopilot, but for the beginning."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "session.yaml").write_text(SESSION)
    words = ("--for", module_sample.of(100, 260), "--out", folder / "bundle", "--no-pack")
    done = simconsole("drive", folder / "session.yaml", *words)
    assert done.returncode == 0, done.stderr
    return folder / "bundle"


@pytest.fixture(scope="module")
def parts(whole: Path) -> tuple[Path, Path]:
    """The first quarter of that drive, and all of it."""
    ticks = read_manifest(whole).ticks
    return begun(whole, whole.parent / "short", ticks // 4), begun(whole, whole.parent / "long", ticks)


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
    tmp_path: Path, sample: Sample, record_property: Callable[[str, object], None]
) -> None:
    """Driven, reported, shown, replayed, verified and compared by the program; 3.6 GB of log.

    The sample only drives: the commands are held to the same bar above, with longer drives than this one.
    """
    seconds = sample.of(5, 7200)
    (tmp_path / "session.yaml").write_text(SESSION)
    bundle = tmp_path / "bundle"
    drive = ("drive", tmp_path / "session.yaml", "--for", seconds, "--out", bundle)
    others = [(*command, bundle, *((bundle,) if command[0] == "compare" else ())) for command in COMMANDS]
    for words in (drive, *others)[: sample.of(1, 1 + len(others))]:
        found = watched(tmp_path / "said", *words)
        assert found.done.returncode == 0, found.done.stdout + found.done.stderr
        told = f"{found.own.all / MB:.0f} MB, its child {found.child.all / MB:.0f} MB"
        record_property(f"{words[0]}, private memory, {seconds} s of drive", told)
        assert max(found.own.all, found.child.all) <= BAR_BYTES
    assert read_manifest(bundle).ticks == seconds * 250
    shutil.rmtree(bundle)
