"""`simconsole drive`: one session, seated or headless."""

import math
import time
from argparse import Namespace
from pathlib import Path

import msgspec

from simconsole.cli.driven import finish
from simconsole.cli.outcome import Outcome
from simconsole.cli.progress import Progress
from simconsole.profiles.person import ROUTE_DRIVER
from simconsole.profiles.session import SessionProfile
from simconsole.recording.bundles.provenance import Given
from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.lifecycle import drive as drive_session
from simconsole.session.resolution import headless, load_session, override, resolve
from simconsole.session.seat import look_for_devices
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import DeviceNotFound, ProfileError
from simconsole.world.kinds.worlds import route_length_m


def drive(options: Namespace) -> Outcome:
    """Drive the named session with the options of the command line laid over it."""
    given = Given(participant=options.participant, trial=options.trial, notes=tuple(options.note)).checked()
    session = _with_options(load_session(options.session), options)
    resolved = resolve(session, options.cockpit, options.language)
    if options.choose or session.devices.driver == "sdl":
        asks = not (options.json or options.headless)
        resolved = _with_a_cockpit(resolved, choose=options.choose, asks=asks)
    folder = Path(options.out) if options.out else Path("out") / time.strftime("drive-%Y%m%d-%H%M%S")
    with Progress("driving", route_length_m(resolved.world), resolved.session.scenario.duration_s) as progress:
        drives = drive_fleet if resolved.fleet else drive_session
        result = drives(resolved, folder, show=progress.show, given=given)
    outputs = resolved.session.outputs
    return finish(result, report=outputs.report, scene=outputs.scene is not None, packed=not options.no_pack)


def _with_a_cockpit(resolved: ResolvedSession, *, choose: bool, asks: bool) -> ResolvedSession:
    """Return the session with a cockpit that is there: a person is asked where its own is not.

    Raises:
        DeviceNotFound: it is not, and nobody can be asked, or they want no other.
        DeviceError: it is there and cannot drive.
    """
    missing = DeviceNotFound("nothing was chosen")
    try:
        look_for_devices(resolved)
        if not choose:
            return resolved
    except DeviceNotFound as error:
        missing = DeviceNotFound(f"{error}; without it: --driver keyboard, or simconsole demo")
    from simconsole.cli.start import ask, somebody_can_be_asked

    message = "" if choose else str(missing)
    session = ask(resolved.session, message) if asks and somebody_can_be_asked() else None
    if session is None:
        raise missing from None
    return msgspec.structs.replace(resolve(session), language=resolved.language)


def _with_options(session: SessionProfile, options: Namespace) -> SessionProfile:
    if options.duration_s is not None:
        if not math.isfinite(options.duration_s):
            raise ProfileError(f"command line: --for: value {options.duration_s}: a finite number of seconds")
        session = override(session, scenario={"duration_s": options.duration_s})
    if options.driver is not None:
        devices = {"driver": options.driver}
        if options.driver == "keyboard":
            devices["cockpit"] = "keyboard"  # keys are not the axes of the session's wheel
        session = override(session, devices=devices)
    if options.person is not None:
        session = _with_person(session, options.person)
    if options.commands is not None:
        session = override(session, features={"commands": options.commands, "autopilot": None, "controller": None})
        if options.headless and session.mode.pacing == "lockstep":
            session = override(session, mode={"pacing": "free"})  # nobody is left to wait for
    if options.headless:
        session = headless(session)
    return session


def _with_person(session: SessionProfile, seed: int) -> SessionProfile:
    """Return `session` with the simulated person of that seed."""
    if session.devices.driver != "virtual":
        raise ProfileError(f"command line: --person: value {seed}: only with --driver virtual")
    plan = session.devices.person or ROUTE_DRIVER
    return override(session, devices={"person": {**msgspec.to_builtins(plan), "seed": seed}})
