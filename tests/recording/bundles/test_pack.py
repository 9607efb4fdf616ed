"""Packing and the way back: equal bytes, one whole form at any moment, and no drive packed that is not whole."""

import errno
import random
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np
import pytest

from simconsole.recording.bundles.bundle import LOG, PACKED_LOG, Bundle, BundleWriter, add_export, open_bundle
from simconsole.recording.bundles.manifest import MANIFEST, read_manifest
from simconsole.recording.bundles.pack import pack, unpack
from simconsole.recording.bundles.packed_log import PackedLog
from simconsole.recording.bundles.verification import verify
from simconsole.recording.log_header import LogHeader, vector_stream
from simconsole.recording.reading import BLOCK_TICKS
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import draft_of
from tests.recording.conftest import TEXTS, with_messages
from tests.samples import Measured, Sample

KILLED = """
import os, signal, sys
from pathlib import Path
from simconsole.recording.bundles.pack import pack, unpack
warm = Path(sys.argv[1])
pack(warm)  # all that is imported late, once for all
unpack(warm)
calls = last = 0
def count(frame, event, argument):
    global calls
    calls += 1
    if calls == last:
        os.kill(os.getpid(), signal.SIGKILL)
for line in sys.stdin:
    work, last, place = line.split()
    last = int(last)
    if os.fork() == 0:
        sys.setprofile(count)
        (pack if work == "pack" else unpack)(Path(place))
        sys.setprofile(None)
        print(calls, flush=True)
        os._exit(0)
    os.wait()
    print("ended", flush=True)
"""


INTERRUPTED = """
import os, signal, sys
from simconsole.cli.main import main
from simconsole.cli.progress import Progress
moment = sys.argv.pop()
def part(self, what, share):
    if what == moment:
        os.kill(os.getpid(), signal.SIGINT)
Progress.done = part
sys.exit(main())
"""


PEAK = """
import sys
from pathlib import Path
from simconsole.recording.bundles.pack import pack, unpack
pack(Path(sys.argv[1]))
unpack(Path(sys.argv[1]))
print(next(line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM")))
"""


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def content(bundle: Bundle) -> bytes:
    log = bundle.log
    return b"".join(log.log_bytes()) if isinstance(log, PackedLog) else log.path.read_bytes()


def test_a_bundle_is_packed_and_unpacked_byte_for_byte(bundle: Path) -> None:
    before = {path.name: path.read_bytes() for path in bundle.iterdir()}
    heard: list[tuple[str, float]] = []
    sizes = pack(bundle, lambda what, share: heard.append((what, share)))
    assert names(bundle) == [PACKED_LOG, MANIFEST, *sorted(TEXTS)]
    assert verify(bundle) == []
    assert sizes == (len(before[LOG]), (bundle / PACKED_LOG).stat().st_size)
    assert isinstance(open_bundle(bundle).log, PackedLog)
    assert {what for what, _ in heard} == {"looking at the columns", "packing", "unpacking"}
    assert all(0.0 <= share <= 1.0 for _, share in heard)
    assert unpack(bundle) == sizes
    assert {path.name: path.read_bytes() for path in bundle.iterdir()} == before


def test_messages_come_back_too(tmp_path: Path, header: LogHeader, rows: list[np.ndarray]) -> None:
    with BundleWriter(tmp_path / "b", with_messages(header), TEXTS) as writer:
        for tick, row in enumerate(rows, start=1):
            writer.log.append(tick, row, [("acts", b'{"tick":%d}' % tick)] * (tick % 3))
        writer.finish({})
    before = (tmp_path / "b" / LOG).read_bytes()
    pack(tmp_path / "b")
    assert verify(tmp_path / "b") == []
    assert sum(1 for _ in open_bundle(tmp_path / "b").log.messages("acts")) == 40
    unpack(tmp_path / "b")
    assert (tmp_path / "b" / LOG).read_bytes() == before


def test_packing_twice_and_unpacking_twice_change_nothing(bundle: Path) -> None:
    sizes = pack(bundle)
    packed = (bundle / PACKED_LOG).read_bytes()
    assert pack(bundle) == sizes
    assert (bundle / PACKED_LOG).read_bytes() == packed
    unpack(bundle)
    unpack(bundle)
    assert verify(bundle) == []


def test_exports_are_added_to_a_packed_bundle(bundle: Path) -> None:
    pack(bundle)
    (bundle / "report.html").write_text("<html>")
    add_export(bundle, "report.html")
    assert verify(bundle) == []
    unpack(bundle)
    assert read_manifest(bundle).files["report.html"].export


def test_an_unfinished_drive_keeps_its_log(tmp_path: Path, header: LogHeader) -> None:
    with BundleWriter(tmp_path / "drive", header, TEXTS) as writer:
        writer.log.append(1, np.zeros(4))
    before = {path.name: path.read_bytes() for path in (tmp_path / "drive").iterdir()}
    for change in (pack, unpack):
        with pytest.raises(RecordingError, match="the drive was not finished"):
            change(tmp_path / "drive")
    assert {path.name: path.read_bytes() for path in (tmp_path / "drive").iterdir()} == before


def test_a_failed_recording_keeps_its_log(tmp_path: Path, header: LogHeader, monkeypatch: pytest.MonkeyPatch) -> None:
    with BundleWriter(tmp_path / "drive", header, {}) as writer:
        writer.log.append(1, np.zeros(4))
        with monkeypatch.context() as patch:
            patch.setattr("os.write", lambda fd, frame: 0)
            writer.log.append(2, np.zeros(4))
        writer.finish({})
    with pytest.raises(RecordingError, match=r"not packed: .*recording stopped at tick 2"):
        pack(tmp_path / "drive")
    assert names(tmp_path / "drive") == [LOG, MANIFEST]


def test_a_damaged_log_is_not_packed_and_stays(bundle: Path, rewrite_checksums: Callable[[Path], None]) -> None:
    spoilt = bytearray((bundle / LOG).read_bytes())
    spoilt[-100] ^= 1
    (bundle / LOG).write_bytes(spoilt)
    with pytest.raises(RecordingError, match=rf"not packed: {bundle / LOG}: 56 bytes from byte \d+: damaged"):
        pack(bundle)
    rewrite_checksums(bundle)
    with pytest.raises(RecordingError, match="damaged, wrong checksum"):
        pack(bundle)
    assert (bundle / LOG).read_bytes() == spoilt
    assert PACKED_LOG not in names(bundle)


def test_a_log_that_was_written_anew_is_not_packed(bundle: Path, rewrite_log: Callable[..., None]) -> None:
    """All in it is in order, but it is not the one that was recorded."""
    digest = read_manifest(bundle).digest
    rewrite_log(bundle / LOG, 12, "driver.brake", 0.25)
    with pytest.raises(RecordingError, match=rf"manifest\.json says 40 ticks, hash {digest}"):
        pack(bundle)
    assert LOG in names(bundle)


def test_a_damaged_packed_log_is_not_unpacked_and_stays(bundle: Path) -> None:
    pack(bundle)
    spoilt = bytearray((bundle / PACKED_LOG).read_bytes())
    spoilt[100] ^= 1
    (bundle / PACKED_LOG).write_bytes(spoilt)
    assert any("altered, sha256" in problem for problem in verify(bundle))
    with pytest.raises(RecordingError, match=rf"{bundle / PACKED_LOG}: "):
        unpack(bundle)
    assert names(bundle) == [PACKED_LOG, MANIFEST, *sorted(TEXTS)]


def test_a_packed_log_of_another_drive_is_named(bundle: Path, tmp_path: Path, header: LogHeader) -> None:
    with BundleWriter(tmp_path / "other", header, TEXTS) as writer:
        writer.log.append(1, np.ones(4))
        writer.finish({})
    for folder in (bundle, tmp_path / "other"):
        pack(folder)
    shutil.copy(tmp_path / "other" / PACKED_LOG, bundle / PACKED_LOG)
    found = verify(bundle)
    assert any("does not give back the drive.log" in problem for problem in found)
    assert any("1 ticks, hash" in problem for problem in found)


@pytest.mark.parametrize("change", [pack, unpack])
def test_a_full_disk_leaves_the_bundle_as_it_was(
    bundle: Path, monkeypatch: pytest.MonkeyPatch, change: Callable[[Path], object]
) -> None:
    if change is unpack:
        pack(bundle)
    before = {path.name: path.read_bytes() for path in bundle.iterdir()}

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("simconsole.recording.bundles.pack.os.fsync", full)
        with pytest.raises(RecordingError, match="cannot be written: No space left on device"):
            change(bundle)
    assert {path.name: path.read_bytes() for path in bundle.iterdir()} == before


@pytest.mark.parametrize("change", [pack, unpack])
@pytest.mark.parametrize("left", ["the other form", "drafts"])
def test_what_a_kill_left_is_removed_by_the_next_call(
    bundle: Path, change: Callable[[Path], object], left: str
) -> None:
    """Even where the call has nothing else to do."""
    wanted, other = (PACKED_LOG, LOG) if change is pack else (LOG, PACKED_LOG)
    change(bundle)
    for path in (
        [bundle / other] if left == "the other form" else [draft_of(bundle / LOG), draft_of(bundle / PACKED_LOG)]
    ):
        path.write_bytes(b"part")
    assert len(list(open_bundle(bundle).log)) == 40
    change(bundle)
    assert names(bundle) == sorted([wanted, MANIFEST, *TEXTS])
    assert verify(bundle) == []


@pytest.mark.parametrize("moment", ["looking at the columns", "packing", "unpacking"])
def test_ctrl_c_leaves_the_log_and_nothing_half_made(bundle: Path, moment: str) -> None:
    before = {path.name: path.read_bytes() for path in bundle.iterdir()}
    words = [sys.executable, "-c", INTERRUPTED, "pack", str(bundle), moment]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (130, "")
    assert {path.name: path.read_bytes() for path in bundle.iterdir()} == before


def test_memory_does_not_grow_with_the_drive(
    tmp_path: Path, header: LogHeader, sample: Sample, record_property: Callable[[str, object], None]
) -> None:
    """Of a drive, and of one four times as long: nearly all columns vary, and none is a copy.

    One that held the longer drive whole would take 16 MB more in the sample.
    """
    columns, blocks = tuple(f"platform.{index}_m" for index in range(40)), sample.of(2, 40)
    stream = (vector_stream(columns, 2),)
    peaks = []
    for times in (1, 4):
        folder, generator = tmp_path / str(times), np.random.default_rng(sample.seed)
        row = np.zeros(len(columns))
        with BundleWriter(folder, msgspec.structs.replace(header, streams=stream), {}) as writer:
            for tick in range(1, times * blocks * BLOCK_TICKS + 1):
                row += generator.normal(size=len(columns))
                writer.log.append(tick, row)
            writer.finish({})
        done = subprocess.run([sys.executable, "-c", PEAK, str(folder)], capture_output=True, text=True, check=True)
        peaks.append(int(done.stdout) / 1e3)
    record_property("memory", f"packing and unpacking: {peaks[0]:.0f} MB, a drive four times as long {peaks[1]:.0f} MB")
    assert peaks[1] <= peaks[0] + 10.0


def test_kill_9_at_any_moment_leaves_a_whole_bundle(
    short: Path, tmp_path: Path, sample: Sample, measured: Measured
) -> None:
    """At random calls of a function, half of them among the last ones, where the forms are exchanged.

    The bundle opens, verifies and holds every byte; the next call ends what was begun.
    """
    generator, kills, forms = random.Random(sample.seed), sample.of(8, 50), set[str]()
    whole = (short / LOG).read_bytes()
    packed = Path(shutil.copytree(short, tmp_path / "packed"))
    pack(packed)
    warm, folder = Path(shutil.copytree(short, tmp_path / "warm")), tmp_path / "killed"
    words = [sys.executable, "-c", KILLED, str(warm)]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdin is not None
        assert server.stdout is not None

        def done(work: str, last_call: int, folder: Path) -> list[str]:
            assert server.stdin is not None
            assert server.stdout is not None
            server.stdin.write(f"{work} {last_call} {folder}\n")
            server.stdin.flush()
            return list(iter(server.stdout.readline, "ended\n"))

        calls = {work: int(done(work, 0, warm)[0]) for work in ("pack", "unpack")}
        for turn in range(kills):
            work, change, before, after = (
                ("unpack", unpack, packed, short) if turn % 4 == 3 else ("pack", pack, short, packed)
            )
            shutil.copytree(before, folder)
            first = calls[work] - 150 if turn % 2 else 1
            assert done(work, generator.randrange(first, calls[work]), folder) == [], "killed"
            bundle = open_bundle(folder)
            forms.add(f"{work}: {type(bundle.log).__name__}")
            assert content(bundle) == whole
            assert verify(folder) == []
            change(folder)
            assert names(folder) == names(after)
            assert content(open_bundle(folder)) == whole
            shutil.rmtree(folder)
    assert {"pack: LogReader", "pack: PackedLog"} <= forms, "killed before and after the exchange"
    measured("P02", "kill -9 while packing and unpacking", f"{kills} of {kills} whole, no byte lost", "all")
