"""Gone means gone: whatever of a drive is killed, none of its processes drives on, and nothing of it stays.

`pytest --long tests/faults/test_lifetimes.py` kills fifty drives; the bar in seconds is reported, not asserted: what
is asserted is the cause, that the pipe which a child reads is held by its parent alone.
"""

import json
import os
import random
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
import pytest

from simconsole.bridge.client.bridge_client import BridgeClient
from simconsole.processes.lifetimes import DRIVE_VARIABLE
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.values.errors import OtherDriveError
from simconsole.values.signals import Event, Mode
from tests.drives.console import Running, environment, simconsole, words
from tests.faults.lives import (
    Life,
    holders,
    living,
    random_pause,
    standard_input,
    takes_signals,
    wait_for_port,
    with_temporary,
    write_session,
)
from tests.patience import PATIENCE_S, Stopwatch, pause, wait_until
from tests.ports import free_port
from tests.samples import Measured, Sample

PROGRAM = "--course"
"""Stands in the arguments of the autopilot only."""
HELD = (PROGRAM, "simconsole.processes", "simconsole.scene.viewer.export")
"""Stand in the arguments of those that end with their parent, each one's."""


BY_ANOTHER: Final = (Mode.SHARED, Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED)
"""Modes in which not the person alone drives. A machine that is slow may stop a car for a wheel that comes late."""


def modes_of(bundle: Path) -> set[float]:
    return set(open_bundle(bundle).log.table().column("arbitration.mode").tolist())


def next_drive_is_manual(folder: Path, port: int, seconds: float = 3.0, temporary: Path | None = None) -> None:
    """Drive on the same port with nobody but a person who asks for autonomy again and again."""
    wait_for_port(port)
    session = write_session(folder, port, autopilot=False, workers=False, report=False)
    command = ("drive", session, "--for", seconds, "--out", folder / "bundle", "--json", "--no-pack")
    with Running(folder, *command, **({} if temporary is None else with_temporary(temporary))) as running:
        done = running.end()
    assert done.returncode == 0, done.stderr
    assert modes_of(folder / "bundle").isdisjoint(BY_ANOTHER), "nobody may drive here but the person"


@pytest.mark.fault("P02")
def test_the_autopilot_of_a_killed_drive_does_not_drive_the_next_one(tmp_path: Path) -> None:
    port = free_port()
    session = write_session(tmp_path / "first", port, workers=False)
    with living(tmp_path / "first", "first", "drive", session, "--out", tmp_path / "bundle") as life:
        autopilot = life.wait_for(PROGRAM)
        kill_all_but(life, autopilot)
        next_drive_is_manual(tmp_path / "next", port)


def kill_all_but(life: Life, spared: int | None) -> None:
    """Kill every process of a drive at once."""
    for process in life.family():
        if process != spared:
            kill(process)
    life.running.process.wait()


def kill(process: int) -> None:
    try:
        os.kill(process, signal.SIGKILL)
    except ProcessLookupError:
        return  # ended meanwhile


@pytest.mark.fault("P02")
def test_each_child_reads_a_pipe_that_its_parent_alone_holds(tmp_path: Path) -> None:
    session = write_session(tmp_path / "first", free_port())
    with living(tmp_path / "first", "held", "drive", session, "--out", tmp_path / "bundle") as life:
        life.wait_for(PROGRAM)
        wait_until(lambda: len(life.family()) == 7, "core, supervisor, four workers, autopilot")
        children = {process: said for process, said in life.family().items() if process != life.core}
        assert all(any(word in said for word in HELD) for said in children.values())
        for process in children:
            pipe = standard_input(process)
            assert pipe.startswith("pipe:")
            parent = int(Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[1])
            assert holders(pipe) == {parent}, "or somebody keeps it open when its parent is gone"


@pytest.mark.parametrize("of_nobody", [False, True])
def test_each_server_refuses_a_program_that_another_drive_started(edge: Callable[..., Any], of_nobody: bool) -> None:
    server = edge()
    with BridgeClient(server.url, drive=None if of_nobody else "0" * 32, comes_back=False) as client:
        if of_nobody:
            client.connect(60.0)
            return
        with pytest.raises(OtherDriveError, match="belongs to another drive"):
            client.connect(3600.0)  # which it does not wait for
        assert client.connections == 0


@pytest.mark.fault("P02")
def test_an_autopilot_of_another_drive_ends_at_once_and_drives_nobody(tmp_path: Path) -> None:
    port = free_port()
    session = write_session(tmp_path, port, autopilot=False, workers=False, report=False)
    command = ("drive", session, "--for", 8, "--out", tmp_path / "bundle", "--json", "--no-pack")
    with Running(tmp_path, *command) as running:
        wait_for_port_taken(port)
        done = simconsole("autopilot", "--url", f"ws://127.0.0.1:{port}", "--wait", 3600, **{DRIVE_VARIABLE: "0" * 32})
        assert running.process.poll() is None, "the drive goes on"
        assert running.end().returncode == 0
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert "this server belongs to another drive" in done.stderr
    assert modes_of(tmp_path / "bundle").isdisjoint(BY_ANOTHER)


def wait_for_port_taken(port: int) -> None:
    wait_until(lambda: f":{port:04X} " in Path("/proc/net/tcp").read_text(), f"somebody at port {port}")


@pytest.mark.fault("P02")
@pytest.mark.timeout(0)
def test_no_process_of_a_killed_drive_lives_on(tmp_path: Path, sample: Sample, measured: Measured) -> None:
    chance, port, gone = random.Random(sample.seed), free_port(), Stopwatch()
    times = sample.of(1, 50)
    for number in range(times):
        folder, pacing = tmp_path / str(number), ("realtime", "lockstep")[number % 4 in (1, 2)]
        session = write_session(folder, port, pacing=pacing)
        wait_for_port(port)
        with living(folder, f"kill{number}", "drive", session, "--out", folder / "bundle", "--for", 3) as life:
            wait_until(lambda: takes_signals(life.core), "its own code")
            waited_s = random_pause(chance, 8.0)
            spared = next((pid for pid, said in life.family().items() if PROGRAM in said), None)
            if number % 2:
                kill_all_but(life, spared)
            else:
                kill(life.core)
                life.running.process.wait()
            gone.start()
            life.wait_for_nobody()
            gone.lap()
            print(f"{number}: {pacing}, killed after {waited_s:.2f} s")
            next_drive_is_manual(folder / "next", port, temporary=life.temporary)
            assert life.left() == [], "the next start removes what was left"
    measured("P02", f"processes of {times} killed drives", f"all gone within {gone.longest}", "1 s")


@pytest.mark.fault("P02")
def test_a_drive_sweeps_what_killed_ones_left(tmp_path: Path) -> None:
    for name in ("simconsole-999999999-scene", "simconsole-999999999-beat-x"):
        (tmp_path / "tmp" / name).mkdir(parents=True)
    (tmp_path / "tmp" / "simconsole-notes").mkdir()
    next_drive_is_manual(tmp_path / "next", free_port(), 0.1, temporary=tmp_path / "tmp")
    assert [path.name for path in (tmp_path / "tmp").iterdir()] == ["simconsole-notes"]


SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Ended(NamedTuple):
    """How a drive ended that got a signal."""

    code: int
    was_done: bool  # before the first signal: the results were printed


class Ends:
    """Ends drives by signals, and tells how long that took since the last signal of each."""

    def __init__(self) -> None:
        self.whole, self.exit = Stopwatch(), Stopwatch()

    def end_by(self, life: Life, bundle: Path, numbers: list[tuple[float, signal.Signals]]) -> Ended:
        """Send signals, each after a pause, and watch the end."""
        was_done, whole = bool(life.running.out.read_bytes()), False
        for pause_s, number in numbers:
            pause(pause_s)
            life.running.process.send_signal(number)
        self.whole.start()
        self.exit.start()

        def ended() -> bool:
            nonlocal whole
            if not whole and is_finished(bundle):
                whole = True
                self.whole.lap()
            return life.running.process.poll() is not None

        wait_until(ended, "the end")
        self.exit.lap()
        return Ended(int(life.running.process.returncode), was_done)


def has_begun(bundle: Path) -> bool:
    return (bundle / "manifest.json").exists() and len(open_bundle(bundle).log.table().ticks) > 10


def is_finished(bundle: Path) -> bool:
    try:
        return bool(json.loads((bundle / "manifest.json").read_bytes())["finished"])
    except (OSError, ValueError):
        return False


@pytest.mark.fault("P11")
@pytest.mark.timeout(0)
@pytest.mark.parametrize("twice", [False, True])
def test_a_signal_at_any_moment_ends_a_drive_in_order(
    twice: bool, tmp_path: Path, sample: Sample, measured: Measured
) -> None:
    """In the sample one signal comes to a drive that has begun, and two at any moment."""
    chance, times, ends = random.Random(sample.seed), sample.of(1, 50), Ends()
    for turn in range(times):
        folder, number = tmp_path / str(turn), SIGNALS[turn % 3]
        session = write_session(folder, free_port(), pacing=chance.choice(("realtime", "realtime", "lockstep")))
        bundle, options = folder / "bundle", ["--json", *chance.choice(([], ["--for", 2]))]
        with living(folder, f"signal{turn}-{twice}", "drive", session, "--out", bundle, *options) as life:
            wait_until(lambda: takes_signals(life.core), "its own code")
            if not (twice or sample.long):
                wait_until(lambda: has_begun(bundle), "driving")  # noqa: B023  (ends here)
            waited_s = random_pause(chance, sample.of(5 if twice else 2, 9))
            second = [(chance.uniform(0.0, 2.0), number)] if twice else []
            ended = ends.end_by(life, bundle, [(0.0, number), *second])
            print(f"{number.name} after {waited_s:.2f} s, {second}: {ended}, {session.read_text()!r} {options}")
            life.wait_for_nobody()
            wait_until(lambda: not life.left(), f"the end of {life.left()}")
            said = life.running.err.read_text()
            assert "Traceback" not in said, said
            at_end = ended.was_done and ended.code == 0 and is_finished(bundle)
            assert ended.code == 130 or at_end, said
            assert_whole_or_none(bundle, twice)
    if twice:
        measured("P11", f"{times} times two signals", f"exit within {ends.exit.longest} of the second", "at once")
        return
    seen = f"bundle whole within {ends.whole.longest}, exit with report and scene within {ends.exit.longest}"
    measured("P11", f"{times} signals at random moments", seen, "2 s")


def assert_whole_or_none(bundle: Path, twice: bool) -> None:
    """Assert that a bundle is whole, or not there; one that was ended twice may lack its end, or list no exports."""
    if not bundle.exists():
        return
    problems = verify(bundle)
    if twice:
        problems = [problem for problem in problems if "nothing vouches for it" not in problem]
    if twice and not is_finished(bundle):
        problems = [problem for problem in problems if "the drive was not finished" not in problem]
    assert problems == []
    assert not [path for path in bundle.iterdir() if path.suffix in (".part", ".new")]
    events = open_bundle(bundle).log.table().column("events.events").astype(int)
    if is_finished(bundle) and json.loads((bundle / "manifest.json").read_bytes())["summary"]["interrupted"]:
        assert np.flatnonzero(events & int(Event.END)).size == 1
        assert abs(open_bundle(bundle).log.table().column("vehicle.vx_mps")[-1]) <= 0.05


@pytest.mark.fault("P11")
def test_a_closed_terminal_ends_a_drive_in_order(tmp_path: Path) -> None:
    session = write_session(tmp_path, free_port(), workers=False)
    ours, theirs = os.openpty()
    process = subprocess.Popen(
        words("drive", session, "--out", tmp_path / "bundle", "--json", "--no-pack"),
        env=environment(), start_new_session=True, preexec_fn=lambda: os.login_tty(theirs),
    )  # fmt: skip
    os.close(theirs)
    try:
        wait_until(lambda: has_begun(tmp_path / "bundle"), "driving")
    finally:
        os.close(ours)
    assert process.wait(PATIENCE_S) == 130
    assert verify(tmp_path / "bundle") == []
    assert (tmp_path / "bundle" / "report.html").exists()
