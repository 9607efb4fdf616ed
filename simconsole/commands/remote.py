"""`simconsole autopilot` and `simconsole bridge serve`: the programs of the ROS side, and a server to try them on."""

import tempfile
from argparse import Namespace
from pathlib import Path

from simconsole.commands.outcome import INTERRUPTED, Outcome, table


def autopilot(words: Namespace) -> Outcome:
    """Follow a course over rosbridge until the console closes the connection."""
    from simconsole.autonomy.autopilot import run

    results = run(words.url, words.course, patience_s=words.wait)
    return Outcome(0, results, table([(name, str(value)) for name, value in results.items()]))


def bridge(words: Namespace) -> Outcome:
    """Serve rosbridge on a standing car that nobody sits in, in real time, until interrupted; nothing is kept."""
    from simconsole.session import drive
    from simconsole.session_files import load_session, override, resolve

    session = override(load_session("bridge"), outputs={"bridge": {"port": words.port}})
    if words.duration_s is not None:
        session = override(session, scenario={"duration_s": words.duration_s})
    print(f"rosbridge at ws://127.0.0.1:{words.port}", flush=True)
    with tempfile.TemporaryDirectory(prefix="simconsole-bridge-") as folder:
        result = drive(resolve(session), Path(folder))
    code = INTERRUPTED if result.interrupted else 0
    return Outcome(code, result.summary, f"served {result.ticks} ticks, lateness {result.summary['lateness']}")
