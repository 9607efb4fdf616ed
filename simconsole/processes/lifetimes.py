"""Child processes, folders and unfinished files end with the process that made them.

A child's standard input is a pipe of which its parent alone holds the other end. Data in it tells the child to end in
order; its end says that the parent is gone, however it ended: the child then has ORPHAN_S left. So there is no orphan,
not even of a parent that was killed while its child was still being loaded: the end of a pipe can be read later, too.

What this process has made and must not leave behind when a signal ends it at once is undone by `end_at_once`.
"""

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Any, Final, NoReturn, Self

from simconsole.values.host.files import DRAFT

if TYPE_CHECKING:
    import subprocess

ORPHAN_S: Final = 0.2
"""How long a child may take to close its connections after its parent is gone."""
INTERRUPTED: Final = 130
"""Exit code of what a signal ended, as a shell reports a Ctrl-C."""
ATTACHED: Final = "--attached"
"""The option of a program that it ends with whoever holds its standard input, as `spawn` does."""
DRIVE_VARIABLE: Final = "SIMCONSOLE_DRIVE"
"""The environment's variable with the nonce of the drive that started a program."""

SIGNALS: Final = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)  # SIGHUP: the terminal was closed; Windows has none
_PR_SET_PDEATHSIG: Final = 1  # linux/prctl.h
_LOOK_S: Final = 0.01
_GRACE_S: Final = 0.1

Handler = Callable[[int, FrameType | None], object]

_undo: list[Callable[[], object]] = []
_ending = threading.RLock()
"""Whoever ends this process at once takes it and never gives it back."""


def spawn(
    arguments: Sequence[str],
    *,
    told: bytes = b"",
    environment: Mapping[str, str] | None = None,
    stdout: int | None = None,
    stderr: int | None = None,
    pass_fds: Sequence[int] = (),
) -> "subprocess.Popen[bytes]":
    """Start a Python program that ends with this process; it calls `follow_parent`.

    Args:
        arguments: what follows the interpreter's name.
        told: written to its standard input at once.
        environment: in place of this process's own.
        stdout: where it may write, as subprocess takes it; None: nowhere.
        stderr: where it may complain, as subprocess takes it.
        pass_fds: file descriptors that it inherits; none on Windows.

    Raises:
        OSError: it cannot be started.
    """
    import subprocess  # not above: whoever only handles signals needs none

    # It imports what its parent imports, and nothing that happens to lie in the working directory.
    path = os.pathsep.join(entry for entry in sys.path if entry)
    process = subprocess.Popen(
        [sys.executable, "-P", *arguments],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL if stdout is None else stdout,
        stderr=stderr,
        env={**(os.environ if environment is None else environment), "PYTHONPATH": path},
        # A terminal's Ctrl-C reaches the core only, which then ends what it started in order.
        process_group=0,
        pass_fds=pass_fds,
        creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
    )
    _write(process, told)
    return process


def tell_to_end(processes: "Sequence[subprocess.Popen[bytes]]") -> None:
    """Tell children to end in order, without waiting. Twice is harmless."""
    for process in processes:
        _write(process, b"\n")


def end(
    processes: "Sequence[subprocess.Popen[bytes]]",
    patience_s: float,
    hurry: Callable[[], bool] = lambda: False,
    orphan_s: float = ORPHAN_S,
) -> None:
    """Tell children to end in order, wait for all of them, and kill what has not ended within `patience_s`.

    Once `hurry()` says so, their pipes are closed, after which they end by themselves within `orphan_s`.
    """
    tell_to_end(processes)
    deadline_s, hurried = time.monotonic() + patience_s, False
    while any(process.poll() is None for process in processes) and time.monotonic() < deadline_s:
        if not hurried and hurry():
            hurried, deadline_s = True, min(deadline_s, time.monotonic() + orphan_s + _GRACE_S)
            for process in processes:
                close_pipe(process)
        time.sleep(_LOOK_S)
    for process in processes:
        if process.poll() is None:
            process.kill()
        process.wait()
        close_pipe(process)


def close_pipe(process: "subprocess.Popen[bytes]") -> None:
    """Close a child's pipe, after which it ends by itself."""
    if process.stdin is not None:
        with contextlib.suppress(OSError):
            process.stdin.close()


def _write(process: "subprocess.Popen[bytes]", text: bytes) -> None:
    assert process.stdin is not None
    with contextlib.suppress(OSError, ValueError):  # it has died already; whoever looks next sees that
        process.stdin.write(text)
        process.stdin.flush()


class Parent:
    """A child's view of its parent: whether it asked the child to end, and whether it is gone."""

    def __init__(self) -> None:
        self._end, self._gone = threading.Event(), threading.Event()

    def wants_end(self) -> bool:
        """Return whether this process shall end: it was told to, or the parent is gone."""
        return self._end.is_set()

    def is_gone(self) -> bool:
        """Return whether the parent is gone."""
        return self._gone.is_set()

    def watch(self, patience_s: float | None, orphan_s: float) -> None:
        """Read the pipe to its end, then end this process. For a thread."""
        # Not through sys.stdin: a thread that holds its lock would abort the interpreter's end.
        told = os.read(0, 4096)
        self._end.set()
        if told and patience_s is not None:
            timer = threading.Timer(patience_s, end_at_once, (1,))
            timer.daemon = True
            timer.start()
        while told:
            told = os.read(0, 4096)
        self._gone.set()
        time.sleep(orphan_s)
        end_at_once(1)


def read_told() -> bytes:
    """Return the first line of what the parent told, empty if the parent was gone before it had told all."""
    with open(0, "rb", buffering=0, closefd=False) as pipe:  # not a byte more: the rest is `follow_parent`'s
        line = pipe.readline()
    return line if line.endswith(b"\n") else b""


def follow_parent(patience_s: float | None, orphan_s: float = ORPHAN_S) -> Parent:
    """Watch standard input, the pipe that `spawn` made, and end this process with its parent.

    Args:
        patience_s: how long it may take to end in order once it was told to; None: as long as it likes.
        orphan_s: how long it may take once the parent is gone.
    """
    parent = Parent()
    threading.Thread(target=parent.watch, args=(patience_s, orphan_s), name="parent", daemon=True).start()
    return parent


def end_with_parent() -> None:
    """Make a process that `multiprocessing` started end when its parent is gone: its executors do not see that."""
    from multiprocessing import parent_process
    from multiprocessing.connection import wait

    parent = parent_process()
    if parent is None:
        return
    sentinel = parent.sentinel

    def watch() -> None:
        wait([sentinel])
        end_at_once(1)

    threading.Thread(target=watch, name="parent", daemon=True).start()


def end_with_parent_thread() -> None:
    """Let the kernel kill this process when the thread that has started it ends. Linux; between fork and exec.

    For programs that are not ours, and so know nothing of `follow_parent`.
    """
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def attached(program: Callable[..., object], *arguments: object) -> None:
    """Call `program` in a process that `multiprocessing` has just started and that ends with its parent."""
    end_with_parent()
    program(*arguments)


@contextlib.contextmanager
def undone(undo: Callable[[], object]) -> Iterator[None]:
    """Within the block, `undo` is called if the process ends at once. It must bear to be called at any moment."""
    _undo.append(undo)
    try:
        yield
    finally:
        _undo.remove(undo)


@contextlib.contextmanager
def unbroken() -> Iterator[None]:
    """Within the block no other thread ends this process at once: for a few short steps of which none is good alone.

    A signal's handler that comes in between, in this very thread, does: nothing follows it.
    """
    with _ending:
        yield


def remove_half_made(folder: Path) -> None:
    """Remove drafts: files that were not yet renamed to their final names."""
    for path in folder.glob(f"*{DRAFT}"):
        path.unlink(missing_ok=True)


def end_at_once(code: int) -> NoReturn:
    """End this process now and leave nothing behind; children end by their pipes.

    A second thread that ends it, too, waits here, or it would cut short what the first one undoes.
    """
    _ending.acquire()
    for undo in reversed(_undo):
        with contextlib.suppress(Exception):
            undo()
    os._exit(code)


def handle(handler: Handler, numbers: Sequence[signal.Signals] = SIGNALS) -> dict[signal.Signals, Any]:
    """Give the signals to `handler` and return who had them; a hang-up that is ignored (nohup) stays ignored.

    Outside of the main thread, where Python lets nobody handle signals, nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        return {}
    taken = [number for number in numbers if number.name != "SIGHUP" or signal.getsignal(number) is not signal.SIG_IGN]
    return {number: signal.signal(number, handler) for number in taken}


@contextlib.contextmanager
def handled(handler: Handler, numbers: Sequence[signal.Signals] = SIGNALS) -> Iterator[None]:
    """Within the block, `handler` gets the signals as by `handle`."""
    before = handle(handler, numbers)
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)


class Interrupt:
    """A signal as a flag, while a drive is open: the loop ends between two ticks, never inside one.

    A second one ends the process at once.
    """

    def __init__(self) -> None:
        self.raised = False
        self._received = 0
        self._stack = contextlib.ExitStack()

    def __enter__(self) -> Self:
        """Take the signals over."""
        self._stack.enter_context(handled(self._note))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give them back."""
        self._stack.close()

    def check(self) -> None:
        """Raise KeyboardInterrupt if a signal has come: for places where ending is safe, while things are opened."""
        if self.raised:
            raise KeyboardInterrupt

    def received(self) -> None:
        """Count a signal that the process has got, whether Python has handled it yet or not. For another thread."""
        self._received += 1
        if self._received > 1:
            end_at_once(INTERRUPTED)

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self.raised:
            end_at_once(INTERRUPTED)
        self.raised = True


def ignore_signals() -> None:
    """Let signals change nothing any more: this process is ending."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def interrupted(number: int, frame: FrameType | None) -> NoReturn:
    """End the process at once with code 130: a handler of signals."""
    end_at_once(INTERRUPTED)


def act_promptly() -> None:
    """Let a signal end the process also while its main thread is in C code, where Python calls no handler.

    A compiler or an encoder may be there for seconds. A thread is told of every signal at once and does what its
    handler is going to do, if that is to end the process.
    """
    read, write = os.pipe()
    if hasattr(os, "set_blocking"):  # Windows: from Python 3.12 on; a pipe that is never full blocks nobody
        os.set_blocking(write, False)
    signal.set_wakeup_fd(write, warn_on_full_buffer=False)
    threading.Thread(target=_act_promptly, args=(read,), name="signals", daemon=True).start()


def _act_promptly(read: int) -> None:
    while numbers := os.read(read, 64):
        for number in numbers:
            handler = signal.getsignal(number)
            if handler is interrupted:
                end_at_once(INTERRUPTED)
            owner = getattr(handler, "__self__", None)
            if isinstance(owner, Interrupt):
                owner.received()
