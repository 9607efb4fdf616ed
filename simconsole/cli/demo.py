"""`simconsole demo`: the whole way from the wheel to the report, on a machine with nothing but Python."""

import time
from argparse import Namespace
from pathlib import Path

import msgspec

from simconsole.cli.driven import finish
from simconsole.cli.outcome import Outcome
from simconsole.cli.progress import Progress
from simconsole.profiles.link import LinkProfile
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.world.kinds.worlds import route_length_m


def demo(options: Namespace) -> Outcome:
    """Drive the demo session, write report and scene, and print what came of it."""
    session = load_session("demo")
    if options.perfect and session.outputs.bridge is not None:
        bridge = msgspec.structs.replace(session.outputs.bridge, link=LinkProfile())
        session = msgspec.structs.replace(session, outputs=msgspec.structs.replace(session.outputs, bridge=bridge))
    if options.realtime:
        session = override(session, mode={"pacing": "realtime"})
    resolved = resolve(session)
    folder = Path(options.out) if options.out else Path("out") / time.strftime("demo-%Y%m%d-%H%M%S")
    with Progress("driving", route_length_m(resolved.world)) as progress:
        result = drive(resolved, folder, show=progress.show)
    return finish(result, packed=not options.no_pack)
