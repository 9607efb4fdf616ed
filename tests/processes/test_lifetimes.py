"""A child ends with its parent, a process that is ended at once leaves nothing, and nobody waits for either."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path

import pytest

from simconsole.processes import lifetimes
from simconsole.processes.lifetimes import ORPHAN_S, close_pipe, end, end_with_parent, handled, spawn
from simconsole.processes.shared_memory import temporary_folder
from simconsole.processes.supervisor import SUPERVISOR_END_S
from tests.faults.lives import holders, marked, standard_input
from tests.patience import PATIENCE_S, wait_until

CHILD = """
import sys, time
from pathlib import Path
from simconsole.processes.lifetimes import follow_parent, read_told
line = read_told()
parent = follow_parent(None if sys.argv[2] == "None" else float(sys.argv[2]), 0.0 if sys.argv[3] == "soon" else 3600.0)
Path(sys.argv[1]).write_bytes(line)
while not (parent.wants_end() and sys.argv[3] == "obeys"):
    time.sleep(0.01)
sys.exit(7)
"""


@contextmanager
def child(folder: Path, patience: str, how: str, told: bytes = b"a line\n") -> Iterator["subprocess.Popen[bytes]"]:
    process = spawn(["-c", CHILD, str(folder / "told"), patience, how], told=told)
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        close_pipe(process)


def wait_for_file(path: Path) -> None:
    wait_until(lambda: path.exists() and path.read_bytes(), str(path))


def test_the_bar_of_a_second_has_room_for_all_who_end_one_after_the_other() -> None:
    assert ORPHAN_S < SUPERVISOR_END_S < 1.0


def test_a_child_ends_at_the_end_of_the_pipe_whatever_it_does(tmp_path: Path) -> None:
    with child(tmp_path, "None", "soon") as process:
        wait_for_file(tmp_path / "told")
        assert (tmp_path / "told").read_bytes() == b"a line\n"
        assert holders(standard_input(process.pid)) == {os.getpid()}
        close_pipe(process)
        assert process.wait(PATIENCE_S) == 1


def test_a_pipe_that_closed_while_the_child_was_being_loaded_ends_it(tmp_path: Path) -> None:
    with child(tmp_path, "None", "soon") as process:
        close_pipe(process)
        assert process.wait(PATIENCE_S) == 1


def test_a_child_that_was_told_half_a_line_has_been_told_nothing(tmp_path: Path) -> None:
    with child(tmp_path, "None", "soon", told=b"half a li") as process:
        close_pipe(process)
        assert process.wait(PATIENCE_S) == 1
    assert not (tmp_path / "told").exists() or (tmp_path / "told").read_bytes() == b""


def test_a_child_that_is_told_to_end_ends_in_its_own_way(tmp_path: Path) -> None:
    with child(tmp_path, "3600", "obeys") as process:
        end([process], PATIENCE_S)
        assert process.returncode == 7


def test_a_child_that_does_not_obey_has_its_patience_only(tmp_path: Path) -> None:
    with child(tmp_path, "0.1", "late") as process:
        wait_for_file(tmp_path / "told")
        end([process], PATIENCE_S)
        assert process.returncode == 1


def test_a_child_that_has_not_ended_is_killed(tmp_path: Path) -> None:
    with child(tmp_path, "3600", "late") as process:
        wait_for_file(tmp_path / "told")
        end([process], 0.1)
        assert process.returncode == -signal.SIGKILL


def test_in_a_hurry_pipes_are_closed_and_patience_ends(tmp_path: Path) -> None:
    with child(tmp_path, "3600", "soon") as obedient:
        wait_for_file(tmp_path / "told")
        end([obedient], 3600.0, lambda: True)
        assert obedient.returncode == 1
    (tmp_path / "told").unlink()
    with child(tmp_path, "3600", "late") as stuck:
        wait_for_file(tmp_path / "told")
        end([stuck], 3600.0, lambda: True, orphan_s=0.1)
        assert stuck.returncode == -signal.SIGKILL


def test_siblings_do_not_keep_each_other_alive(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    with child(tmp_path / "a", "None", "soon") as first, child(tmp_path / "b", "None", "soon") as second:
        wait_for_file(tmp_path / "a" / "told")
        wait_for_file(tmp_path / "b" / "told")
        close_pipe(first)
        assert first.wait(PATIENCE_S) == 1
        assert second.poll() is None


POOL = """
import os, time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from simconsole.processes.lifetimes import end_with_parent
if __name__ == "__main__":
    with ProcessPoolExecutor(2, get_context("spawn"), end_with_parent) as pool:
        list(pool.map(os.getpid().__add__, [0, 0]))
        print("ready", flush=True)
        time.sleep(3600.0)
"""


def test_workers_of_a_pool_end_with_their_parent(tmp_path: Path) -> None:
    (tmp_path / "pool.py").write_text(POOL)
    mark = f"pool-{os.getpid()}"
    words = [sys.executable, str(tmp_path / "pool.py")]
    with subprocess.Popen(words, stdout=subprocess.PIPE, env={**os.environ, "SIMCONSOLE_TEST_MARK": mark}) as parent:
        assert parent.stdout is not None
        assert parent.stdout.readline() == b"ready\n"
        assert len(marked(mark)) >= 2, "the parent, and its worker"
        parent.kill()
        parent.wait()
        wait_until(lambda: not marked(mark), "the end of every worker")


def test_only_what_multiprocessing_started_has_such_a_parent() -> None:
    end_with_parent()
    with ProcessPoolExecutor(1, get_context("spawn"), end_with_parent) as pool:
        assert pool.submit(os.getpid).result() != os.getpid()


HELD = """
import os, signal, sys, time
from pathlib import Path
from simconsole.processes.lifetimes import Interrupt, handled, interrupted, undone
from simconsole.processes.shared_memory import temporary_folder
def broken(): raise RuntimeError
def hold():  # not signal.pause(): a signal that comes just before it would be seen by nobody
    while True: time.sleep(0.01)
with handled(interrupted), temporary_folder() as folder, undone(broken):
    (folder / "file").write_text("half made")
    print(folder, flush=True)
    if sys.argv[1] == "drive":
        with Interrupt() as interrupt:
            os.kill(os.getpid(), signal.SIGTERM)
            while not interrupt.raised: pass
            print("noted", flush=True)
            hold()
    hold()
"""


@pytest.mark.fault("P11")
@pytest.mark.parametrize("number", lifetimes.SIGNALS)
@pytest.mark.parametrize("where", ["drive", "export"])
def test_what_is_ended_at_once_leaves_nothing(number: signal.Signals, where: str) -> None:
    with subprocess.Popen([sys.executable, "-c", HELD, where], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        folder = Path(process.stdout.readline().decode().strip())
        assert (folder / "file").exists()
        if where == "drive":
            assert process.stdout.readline() == b"noted\n"
        process.send_signal(number)
        assert process.wait(PATIENCE_S) == 130
    assert not folder.exists()


TWO_THREADS = """
import sys, threading, time
from simconsole.processes import lifetimes
def another_thread_ends_it():
    thread = threading.Thread(target=lifetimes.end_at_once, args=(130,))
    thread.start()
    thread.join(0.3)  # the other one has this long to spoil it
def undo():
    if threading.current_thread() is not threading.main_thread():
        print("undone by the other", flush=True)
        return
    print("begins", flush=True)
    another_thread_ends_it()
    print("undone", flush=True)
with lifetimes.undone(undo):
    if sys.argv[1] == "undoing":
        lifetimes.end_at_once(130)
    with lifetimes.unbroken():
        another_thread_ends_it()
        print("whole", flush=True)
    time.sleep(3600.0)
"""


@pytest.mark.fault("P11")
@pytest.mark.parametrize(("what", "said"), [("undoing", "begins undone"), ("making", "whole undone by the other")])
def test_a_second_thread_that_ends_the_process_cuts_nothing_short(what: str, said: str) -> None:
    """At a second signal the main thread and that of the signals both end the process."""
    done = subprocess.run([sys.executable, "-c", TWO_THREADS, what], capture_output=True, text=True, check=False)
    assert (done.stdout.split(), done.returncode) == (said.split(), 130), done.stderr


def test_a_temporary_folder_ends_with_its_block() -> None:
    with temporary_folder() as folder:
        assert folder.stat().st_mode & 0o777 == 0o700
    assert not folder.exists()
    assert lifetimes._undo == []


def test_an_ignored_hang_up_stays_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with handled(lambda number, frame: None):
            assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
            assert signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    finally:
        signal.signal(signal.SIGHUP, before)


IN_C_CODE = """
import hashlib, sys
from pathlib import Path
from simconsole.processes.lifetimes import SIGNALS, Interrupt, act_promptly, handle, interrupted
act_promptly()
handle(interrupted, SIGNALS)
def work(name):
    Path(sys.argv[1], name).write_bytes(b"now")
    hashlib.pbkdf2_hmac("sha256", b"word", b"salt", 10**9)  # minutes, in which Python handles no signal
if sys.argv[2] == "drive":
    with Interrupt():
        work("begun")
work("begun")
"""


@pytest.mark.fault("P11")
@pytest.mark.parametrize(
    ("where", "signals"), [("exports", [signal.SIGTERM]), ("drive", [signal.SIGTERM, signal.SIGINT])]
)
def test_a_signal_ends_a_process_that_is_in_c_code(where: str, signals: list[signal.Signals], tmp_path: Path) -> None:
    """At once where one does; where a drive is open the first one is the drive's, the second ends it.

    Of two kinds: a signal that waits to be delivered takes in another one of its kind.
    """
    process = subprocess.Popen([sys.executable, "-c", IN_C_CODE, str(tmp_path), where])
    try:
        wait_for_file(tmp_path / "begun")
        for number in signals:
            assert process.poll() is None
            process.send_signal(number)
        assert process.wait(PATIENCE_S) == lifetimes.INTERRUPTED
    finally:
        process.kill()
        process.wait()
