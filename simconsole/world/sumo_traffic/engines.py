"""The two ways to SUMO behind one set of words: libsumo in this process, or TraCI to another one.

Both have the same domains (`vehicle`, `trafficlight`, ...) with the same functions, so the adapter is written once.
libsumo is one simulation a process: a second start would silently replace the first, so here it is refused.
"""

import contextlib
import io
import os
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final, NamedTuple

from simconsole.processes.lifetimes import end_with_parent_thread, undone
from simconsole.profiles.traffic import SumoProfile
from simconsole.values.errors import ProfileError

KEY: Final = "environment.traffic.sumo"
CONNECT_S: Final = 60.0
"""A large map takes SUMO so long to load before it listens."""
END_S: Final = 5.0
_LOOK_S: Final = 0.02

_running: list[bool] = []


class Engine(NamedTuple):
    """A SUMO that is loaded and has not stepped yet."""

    sumo: Any  # the module libsumo, or a connection of traci: equal words
    errors: tuple[type[BaseException], ...]  # what its calls raise
    close: Callable[[], None]  # ends it, or this client's part in it; never raises
    process: "subprocess.Popen[bytes] | None" = None
    expect_answers: Callable[[], None] = lambda: None  # from here on, one that takes too long is none


def missing(profile: SumoProfile) -> str | None:
    """Return what of SUMO is not installed, None where nothing is missing."""
    name = "libsumo" if profile.backend == "libsumo" else "traci"
    if not has(name):
        return f"{name}, of the extra `sumo`"
    if profile.backend == "traci" and profile.address is None and sumo_program() is None:
        return "the program sumo: the extra `sumo`, or SUMO itself"
    return None


def has(name: str) -> bool:
    """Return whether a back end is installed: the module `libsumo` or `traci`."""
    return find_spec(name) is not None


def sumo_program() -> str | None:
    """Return the program, of the Python package eclipse-sumo or of the path; None where it is not installed."""
    package = find_spec("sumo")
    for folder in [] if package is None else package.submodule_search_locations or ():
        program = Path(folder) / "bin" / ("sumo.exe" if os.name == "nt" else "sumo")
        if program.is_file():
            return str(program)
    return shutil.which("sumo")


def open_engine(profile: SumoProfile, options: Sequence[str]) -> Engine:
    """Return SUMO, started with these options, or the one that waits at the profile's address.

    On Linux a program that is started here ends with the thread that has started it, however that ends.

    Raises:
        ProfileError: it is not installed, does not start or answer, or this process has one already.
    """
    lacking = missing(profile)
    if lacking is not None:
        raise ProfileError(f"{KEY}: value missing: {lacking}")
    if profile.backend == "libsumo":
        return _inline(options)
    if profile.address is not None:
        host, _, port = profile.address.rpartition(":")
        return _connected(profile, host, int(port), None)
    return _started(profile, options)


def _inline(options: Sequence[str]) -> Engine:
    if _running:
        raise ProfileError(f"{KEY}.backend: value libsumo: traci, where a process has more than one drive at a time")
    with contextlib.redirect_stdout(io.StringIO()):  # it tells of pyarrow's version, which it does not use here
        import libsumo
    _running.append(True)
    errors = _errors_of(libsumo)
    try:
        libsumo.start(["sumo", *options])
    except errors as error:
        _end_inline(libsumo)
        raise _refused(error) from None
    return Engine(libsumo, errors, lambda: _end_inline(libsumo))


def _errors_of(libsumo: Any) -> tuple[type[BaseException], ...]:
    """Return what its calls raise: errors of its own, and some under the names of traci's."""
    return libsumo.TraCIException, libsumo.libsumo.FatalTraCIError, libsumo.exceptions.FatalTraCIError


def _end_inline(libsumo: Any) -> None:
    with contextlib.suppress(*_errors_of(libsumo)):
        libsumo.close()
    _running.clear()


def _started(profile: SumoProfile, options: Sequence[str]) -> Engine:
    program = sumo_program()
    assert program is not None
    port = _free_port()
    words = [program, *options, "--remote-port", str(port)]
    try:
        # In a group of its own: a terminal's Ctrl-C reaches the core, which ends it. SUMO ends with its connection.
        process = subprocess.Popen(
            words,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,  # errors only, and SUMO ends with the first: the pipe never fills
            process_group=0 if os.name == "posix" else None,
            # While it loads there is no connection yet: it would outlive a core that is killed.
            preexec_fn=end_with_parent_thread if sys.platform == "linux" else None,
        )
    except OSError as error:
        raise ProfileError(f"{KEY}: sumo: {error.strerror}: a program that runs") from None
    try:
        with undone(process.kill):
            return _connected(profile, "127.0.0.1", port, process)
    except ProfileError:
        raise  # it has been ended
    except BaseException:
        process.kill()
        _end(process)
        raise


def _connected(profile: SumoProfile, host: str, port: int, process: "subprocess.Popen[bytes] | None") -> Engine:
    import traci

    # libsumo, once imported, puts its own errors into traci.exceptions; traci's modules go on raising theirs.
    names = (traci.exceptions, traci.main, traci.connection)
    errors = (*{error for one in names for error in (one.TraCIException, one.FatalTraCIError)}, OSError)
    deadline_s = time.monotonic() + (CONNECT_S if process is not None else profile.timeout_s)
    while True:
        try:
            connection: Any = traci.connect(port, numRetries=0, host=host, proc=process)
            break
        except errors:
            if process is not None and process.poll() is not None:
                said = b"" if process.stderr is None else process.stderr.read()
                _end(process)
                raise _refused(said.decode(errors="replace")) from None
            if time.monotonic() > deadline_s:
                _end(process)
                raise ProfileError(f"{KEY}.address: value {host}:{port}: a SUMO that listens") from None
            time.sleep(_LOOK_S)
    connection._socket.settimeout(CONNECT_S)

    def expect_answers() -> None:
        # A SUMO that hangs is one that has not answered for so long; traci has no bound of its own.
        connection._socket.settimeout(profile.timeout_s)

    def close() -> None:
        with contextlib.suppress(*errors, AttributeError):
            connection.close(wait=False)
        _end(process)

    return Engine(connection, errors, close, process, expect_answers)


def said_by(process: "subprocess.Popen[bytes] | None") -> str:
    """Return the errors that a program has written which has ended; "" where it runs on or is none of ours."""
    if process is None or process.stderr is None:
        return ""
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(END_S)
        return _first(process.stderr.read().decode(errors="replace"))
    return ""


def _end(process: "subprocess.Popen[bytes] | None") -> None:
    """Wait for the program, whose only client is gone; kill one that hangs."""
    if process is None:
        return
    try:
        process.wait(END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    if process.stderr is not None:
        process.stderr.close()


def _free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port: int = one.getsockname()[1]
        return port


def _refused(said: object) -> ProfileError:
    return ProfileError(f"{KEY}: SUMO: {_first(str(said)) or 'it has ended'}: a simulation that starts")


def _first(said: str) -> str:
    """Return the first error of what SUMO said, in printable characters."""
    lines = [line for line in said.splitlines() if line.strip()]
    errors = [line.removeprefix("Error: ") for line in lines if line.startswith("Error: ")] or lines
    return ascii(errors[0])[1:-1][:200] if errors else ""
