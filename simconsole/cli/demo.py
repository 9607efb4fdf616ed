"""`simconsole demo`: the whole way from the wheel to the report, on a machine with nothing but Python."""

import time
from argparse import Namespace
from pathlib import Path

import msgspec

from simconsole.cli.driven import finish
from simconsole.cli.outcome import Outcome
from simconsole.cli.progress import Progress
from simconsole.profiles.link import LinkProfile
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.traffic import SumoProfile, TrafficProfile
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.values.errors import ProfileError
from simconsole.world.kinds.worlds import route_length_m
from simconsole.world.sumo_traffic.engines import missing


def demo(options: Namespace) -> Outcome:
    """Drive the demo session, write report and scene, and print what came of it."""
    resolved = resolve(demo_session(perfect=options.perfect, sumo=options.sumo, realtime=options.realtime))
    folder = Path(options.out) if options.out else Path("out") / time.strftime("demo-%Y%m%d-%H%M%S")
    with Progress("driving", route_length_m(resolved.world), resolved.session.scenario.duration_s) as progress:
        result = drive(resolved, folder, show=progress.show)
    return finish(result, packed=not options.no_pack)


def demo_session(*, perfect: bool = False, sumo: bool = False, realtime: bool = False) -> SessionProfile:
    """Return the shipped demo as it was asked for.

    Args:
        perfect: Exact odometry and no delay on the autopilot's link.
        sumo: SUMO's traffic and signals in place of its own.
        realtime: As fast as the clock, not as fast as it can be computed.

    Raises:
        ProfileError: `sumo`, and what it needs is not installed.
    """
    session = load_session("demo")
    if perfect and session.outputs.bridge is not None:
        bridge = msgspec.structs.replace(session.outputs.bridge, link=LinkProfile())
        session = msgspec.structs.replace(session, outputs=msgspec.structs.replace(session.outputs, bridge=bridge))
    if sumo:
        session = _on_sumo(session)
    return override(session, mode={"pacing": "realtime"}) if realtime else session


def _on_sumo(session: SessionProfile) -> SessionProfile:
    """Return `session` with as many of SUMO's road users as it has of its own; refuse what SUMO is missing for."""
    traffic = session.environment.traffic or TrafficProfile()
    sumo = SumoProfile(vehicles=traffic.vehicles, pedestrians=traffic.pedestrians)
    lacking = missing(sumo)
    if lacking is not None:
        raise ProfileError(f"command line: --sumo: value missing: {lacking}")
    traffic = msgspec.structs.replace(traffic, sumo=sumo)
    environment = msgspec.structs.replace(session.environment, traffic=traffic)
    return msgspec.structs.replace(session, environment=environment)
