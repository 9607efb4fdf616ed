"""The command line: arguments in, one command run, an exit code out.

Exit codes: 0 good, 1 the check failed, 2 bad usage or a bad file, 130 interrupted. With `--json` standard output gets
one JSON object with the results, or with the error, and nothing else; what a person reads goes to standard error. No
heavy library is imported here: each command names the function that does it, loaded when it is called.
"""

import argparse
import os
import sys
import traceback
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, redirect_stdout
from pathlib import Path
from typing import Any, TextIO

from simconsole.cli.arguments import buses, cockpits, driving, recorded_drives, tools
from simconsole.cli.outcome import Outcome
from simconsole.cli.terminal.parser import BadUsage, Parser
from simconsole.cli.terminal.talk import RED, Talk, coloured, level, painted, shows_colours, talking
from simconsole.processes.lifetimes import (
    INTERRUPTED,
    SIGNALS,
    act_promptly,
    end_at_once,
    handle,
    handled,
    ignore_signals,
    interrupted,
)
from simconsole.values.errors import SimConsoleError, one_line
from simconsole.values.host.loading import loaded
from simconsole.values.version import __version__

_AT_ONCE = ("demo", "drive", "bridge", "report", "view", "pack", "unpack")
"""Commands that Ctrl-C ends at once unless a drive handles it itself: they leave nothing half made. In the others it
raises KeyboardInterrupt, which for some is the normal way to their result."""


def parser() -> Parser:
    """Return the parser of every command."""
    root = Parser(
        prog="simconsole",
        description="A hardware-in-the-loop driving-simulator console.",
        epilog="simconsole COMMAND --help: one command, with examples. First of all: simconsole demo",
    )
    root.add_argument("--version", action="version", version=f"simconsole {__version__}")
    commands = root.add_subparsers(dest="command", required=True, metavar="COMMAND")
    driving.driving(commands)
    driving.beside_a_drive(commands)
    recorded_drives.recordings(commands)
    recorded_drives.exchange(commands)
    recorded_drives.video(commands)
    cockpits.devices(commands)
    buses.bridge(commands)
    buses.can(commands)
    tools.tools(commands)
    return root


def main(arguments: list[str] | None = None) -> int:
    """Run one command and return its exit code. Errors a user can cause are one line on standard error."""
    words = sys.argv[1:] if arguments is None else arguments
    try:
        options = parser().options_of(words)
    except BadUsage as refusal:
        if "--json" in words:
            _print_json({"error": refusal.said})
        raise
    signals = SIGNALS if options.command in _AT_ONCE else SIGNALS[1:]
    if arguments is None:
        act_promptly()
        handle(interrupted, signals)
        code = _run(options)
        ignore_signals()  # all is done: a signal must not change the exit code while Python shuts down
        if code == INTERRUPTED:
            end_at_once(code)  # whoever interrupted waits for the end
        return code
    with handled(interrupted, signals):
        return _run(options)


def _run(options: argparse.Namespace) -> int:
    with talking(Talk.QUIET if options.quiet else Talk.VERBOSE if options.verbose else Talk.USUAL):
        outcome = _outcome(options)
        if outcome.text and (level() is not Talk.QUIET or outcome.code == 1):
            _print(outcome.text, sys.stderr if options.json else sys.stdout)
    if options.json:
        _print_json(outcome.results)
    return int(outcome.code)


def _outcome(options: argparse.Namespace) -> Outcome:
    """Do what is asked; an error is told here, and has no text left to print."""
    module, function = options.does.split(":")
    try:
        with _out_of_the_results(options):
            outcome: Outcome = getattr(loaded(f"simconsole.cli.{module}"), function)(options)
            return outcome
    except SimConsoleError as error:
        said, code, trace = str(error), error.exit_code, traceback.format_exc()
    except (MemoryError, OSError, ImportError) as error:  # limits of the machine, files, libraries: no bug here
        said, code, trace = one_line(error), SimConsoleError.exit_code, traceback.format_exc()
    except KeyboardInterrupt:
        return Outcome(INTERRUPTED, {"error": "interrupted"})
    if level() is Talk.VERBOSE:
        _print(trace, sys.stderr)
    name = f"simconsole {options.command}:"
    _print(f"{painted(name, RED) if shows_colours(sys.stderr) else name} {said}", sys.stderr)
    return Outcome(code, {"error": said})


@contextmanager
def _out_of_the_results(options: argparse.Namespace) -> Iterator[None]:
    """Let what a command prints while it works go to standard error where its results shall stand alone; or nowhere."""
    with ExitStack() as around:
        if options.quiet:
            around.enter_context(redirect_stdout(around.enter_context(Path(os.devnull).open("w"))))
        elif options.json:
            around.enter_context(redirect_stdout(sys.stderr))
        yield


def _print_json(results: dict[str, Any]) -> None:
    import orjson

    _print(orjson.dumps(results, option=orjson.OPT_SERIALIZE_NUMPY).decode(), sys.stdout)


def _print(text: str, stream: TextIO) -> None:
    try:
        print(coloured(text, stream), file=stream, flush=True)
    except OSError:  # closed terminal, pipe without a reader: drop this, and what Python flushes at its end
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
