"""The command line: arguments in, one command run, an exit code out.

Exit codes: 0 good, 1 the check failed, 2 bad usage or a bad file, 130 interrupted. `--json` makes the last line on
standard output one JSON object with the results. No heavy library is imported here: each command names the function
that does it, loaded when it is called.
"""

import argparse
import os
import sys
from importlib import import_module
from typing import Any, TextIO

from simconsole.cli.arguments import driving, recorded_drives, tools
from simconsole.cli.terminal.parser import Parser
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
from simconsole.values.version import __version__

_AT_ONCE = ("demo", "drive", "bridge", "report", "view", "pack", "unpack")
"""Commands that Ctrl-C ends at once unless a drive handles it itself: they leave nothing half made. In the others it
raises KeyboardInterrupt, which for some is the normal way to their result."""


def parser() -> Parser:
    """Return the parser of every command."""
    root = Parser(prog="simconsole", description="A hardware-in-the-loop driving-simulator console.")
    root.add_argument("--version", action="version", version=f"simconsole {__version__}")
    commands = root.add_subparsers(dest="command", required=True, metavar="COMMAND")
    driving.driving(commands)
    driving.beside_a_drive(commands)
    recorded_drives.recordings(commands)
    recorded_drives.exchange(commands)
    recorded_drives.video(commands)
    tools.tools(commands)
    tools.can(commands)
    tools.lookup(commands)
    root.commands = commands.choices
    return root


def main(arguments: list[str] | None = None) -> int:
    """Run one command and return its exit code. Errors a user can cause are one line on standard error."""
    options = parser().options_of(sys.argv[1:] if arguments is None else arguments)
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
    module, function = options.does.split(":")
    try:
        outcome = getattr(import_module(f"simconsole.cli.{module}"), function)(options)
    except SimConsoleError as error:
        _print(f"simconsole {options.command}: {error}", sys.stderr)
        if options.json:
            _print_json({"error": str(error)})
        return error.exit_code
    except (MemoryError, OSError, ImportError) as error:  # limits of the machine, files, libraries: no bug here
        _print(f"simconsole {options.command}: {one_line(error)}", sys.stderr)
        if options.json:
            _print_json({"error": one_line(error)})
        return SimConsoleError.exit_code
    except KeyboardInterrupt:
        return INTERRUPTED
    if outcome.text:
        _print(outcome.text)
    if options.json:
        _print_json(outcome.results)
    return int(outcome.code)


def _print_json(results: dict[str, Any]) -> None:
    import orjson

    _print(orjson.dumps(results, option=orjson.OPT_SERIALIZE_NUMPY).decode())


def _print(text: str, file: TextIO | None = None) -> None:
    stream = sys.stdout if file is None else file
    try:
        print(text, file=stream, flush=True)
    except OSError:  # closed terminal, pipe without a reader: drop this, and what Python flushes at its end
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
